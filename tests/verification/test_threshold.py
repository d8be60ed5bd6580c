"""Thresholds on the smooth branch against exact theory, and what else `critical_growth` must answer."""

from __future__ import annotations

import json

import numpy as np
import pytest

from gyrify.cli import main
from gyrify.config import Config
from gyrify.errors import ConfigError
from gyrify.theory import Annulus, critical_growth_ratio, critical_growth_time
from gyrify.theory import crossings as exact_crossings
from gyrify.threshold import Threshold, critical_growth

CIRCLE = {"geometry.shape": "circle"}
COARSE = {"mesh.n_around": 96, "mesh.n_layers": 8, "mesh.n_cortex_layers": 3}
FINE = {"mesh.n_around": 432, "mesh.n_layers": 34, "mesh.n_cortex_layers": 12}
FINEST = {"mesh.n_around": 648, "mesh.n_layers": 51, "mesh.n_cortex_layers": 18}


def configured(*values: dict[str, object]) -> Config:
    """The reference slice with some values."""
    merged = {key: value for group in values for key, value in group.items()}
    return Config.preset("reference-slice").with_overrides(merged)


def relative_error(threshold: Threshold, exact: float) -> float:
    """Of the critical value."""
    assert threshold.critical_value is not None
    return threshold.critical_value / exact - 1.0


@pytest.mark.parametrize(("stiffness_ratio", "target"), [(1.0, 1.794), (1 / 1.36, 2.086)])
def test_standard_ellipse(stiffness_ratio: float, target: float) -> None:
    config = configured({"material.stiffness_ratio": stiffness_ratio})
    found = critical_growth(config, range=(1.6, 2.3), points=8)
    assert abs(relative_error(found, target)) < 0.015
    assert [crossing.becomes for crossing in found.crossings] == ["unstable"]
    assert found.bracket is not None
    assert found.bracket[0] < found.critical_value < found.bracket[1]  # type: ignore[operator]
    assert found.growth_time == 500.0
    assert found.mode_number in range(14, 20)


@pytest.mark.slow
@pytest.mark.parametrize(("stiffness_ratio", "target"), [(1.0, 1.729), (1 / 1.36, 1.984)])
def test_standard_ellipse_on_a_fine_mesh(stiffness_ratio: float, target: float) -> None:
    config = configured(FINE, {"material.stiffness_ratio": stiffness_ratio})
    assert abs(relative_error(critical_growth(config, range=(1.5, 2.3), points=8), target)) < 0.015


@pytest.mark.slow
@pytest.mark.parametrize("stiffness_ratio", [1 / 1.36, 1.0, 1.54, 2.0, 3.0])
def test_circle_against_the_exact_annulus(stiffness_ratio: float) -> None:
    exact = critical_growth_ratio(Annulus(stiffness_ratio=stiffness_ratio))[0]
    config = configured(CIRCLE, FINEST, {"material.stiffness_ratio": stiffness_ratio})
    found = critical_growth(config, range=(0.97 * exact.value, 1.05 * exact.value), points=4, tolerance=1e-4)
    assert 0.0 < relative_error(found, exact.value) < 0.01
    assert found.mode_number == pytest.approx(exact.mode_number, abs=1)


def test_circle_converges_to_the_exact_annulus_with_the_square_of_the_mesh() -> None:
    exact = critical_growth_ratio(Annulus(stiffness_ratio=3.0))[0]
    errors = []
    for k in (2, 3):
        mesh = {"mesh.n_around": 72 * k, "mesh.n_layers": 6 * k, "mesh.n_cortex_layers": 2 * k}
        config = configured(CIRCLE, mesh, {"material.stiffness_ratio": 3.0})
        errors.append(relative_error(critical_growth(config, range=(1.1, 1.5), points=5), exact.value))
    assert errors[0] > errors[1] > 0.0
    order = np.log(errors[0] / errors[1]) / np.log(3 / 2)
    assert order == pytest.approx(2.0, abs=0.35)


@pytest.mark.slow
def test_the_surface_limit_depends_on_the_mesh() -> None:
    """For a soft cortex the critical wavelength is zero: every mesh delays onset, a finer one less."""
    exact = critical_growth_ratio(Annulus(stiffness_ratio=1 / 3))[0]
    assert exact.mode_number is None
    found = []
    for k in (2, 3, 4):
        mesh = {"mesh.n_around": 108 * k, "mesh.n_layers": 8 * k + 1, "mesh.n_cortex_layers": 3 * k}
        config = configured(CIRCLE, mesh, {"material.stiffness_ratio": "1/3"})
        found.append(critical_growth(config, range=(2.4, 3.6), points=5))
    values, modes = [t.critical_value for t in found], [t.mode_number for t in found]
    assert values[0] > values[1] > values[2] > 1.1 * exact.value  # type: ignore[operator]
    assert modes[0] < modes[1] < modes[2]  # type: ignore[operator]


def test_growth_time_against_the_exact_annulus() -> None:
    exact = critical_growth_time(Annulus(stiffness_ratio=3.0))[0]
    mesh = {"mesh.n_around": 216, "mesh.n_layers": 17, "mesh.n_cortex_layers": 6}
    config = configured(CIRCLE, mesh, {"material.stiffness_ratio": 3.0})
    found = critical_growth(config, "growth.time", points=6)
    # The growth ratio is within 2 %; growth time is the more sensitive measure.
    assert 0.0 < relative_error(found, exact.value) < 0.11
    assert found.growth_time == found.critical_value


def test_stability_need_not_be_monotone_in_the_parameter() -> None:
    """A thin cortex is smooth on a coarse mesh, a thick one for good; between them it folds."""
    config = configured(CIRCLE, COARSE, {"material.stiffness_ratio": 2.0, "growth.ratio": 1.6})
    found = critical_growth(config, "geometry.cortical_thickness", range=(1.0, 9.2), points=12)
    assert [crossing.becomes for crossing in found.crossings] == ["unstable", "stable"]
    assert found.critical_value == found.crossings[0].value
    annulus = Annulus(stiffness_ratio=2.0, growth_ratio=1.6)
    exact = exact_crossings(annulus, "cortical_thickness", [6.0, 10.0])[0]
    assert exact.becomes == "stable"
    # 5 % of the growth ratio, on this mesh, are 15 % of the thickness.
    assert found.crossings[1].value == pytest.approx(exact.value, rel=0.2)


@pytest.mark.parametrize(("ratio", "is_stable"), [(1.4, True), (2.02, True)])
def test_reference_energy_below_its_threshold(ratio: float, is_stable: bool) -> None:
    """Per reference volume the exact threshold at stiffness ratio 1 is the surface limit, 2.52."""
    config = configured(CIRCLE, {"growth.energy_per": "reference"})
    found = critical_growth(config, range=(ratio, ratio + 0.01), points=2)
    assert (found.scan[0].n_negative == 0) is is_stable


def test_stiffness_ratio() -> None:
    config = configured(CIRCLE, COARSE, {"growth.ratio": 1.7})
    found = critical_growth(config, "material.stiffness_ratio", range=(0.8, 3.0), points=5)
    at_that = configured(CIRCLE, COARSE, {"material.stiffness_ratio": found.critical_value})
    again = critical_growth(at_that, range=(1.4, 2.0), points=4)
    assert again.critical_value == pytest.approx(1.7, rel=1e-4)


def test_nothing_is_critical() -> None:
    found = critical_growth(configured(CIRCLE, COARSE), range=(1.0, 1.2), points=3)
    assert found.critical_value is None
    assert found.crossings == ()
    assert "stable at all 3 values of growth.ratio from 1 to 1.2" in found.reason
    assert found.mode_number is None


def test_visible_folds() -> None:
    config = configured(
        COARSE, {"material.stiffness_ratio": 3.0, "solver.increments": 12, "dissipation.number": 0.1}
    )
    found = critical_growth(config, definition="visible", range=(1.0, 2.5), points=4, tolerance=0.05)
    assert found.critical_value is not None
    assert found.bracket is not None
    assert found.bracket[1] - found.bracket[0] <= 0.05 * found.bracket[1]
    assert found.crossings[0].becomes == "folded"
    stability = critical_growth(config, range=(1.0, 2.5), points=6).critical_value
    assert stability is not None
    assert 0.95 * stability < found.critical_value < 1.5 * stability


def test_visible_growth_time_takes_one_run() -> None:
    config = configured(COARSE, {"material.stiffness_ratio": 3.0, "solver.increments": 12})
    found = critical_growth(config, "growth.time", "visible", level=1.01)
    assert found.evaluations == 1
    assert found.critical_value is not None
    assert 0.0 < found.critical_value < 500.0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"parameter": "growth.rate"}, "growth.ratio"),
        ({"definition": "by_eye"}, "stability or visible"),
        ({"range": (2.0, 1.0)}, "not increasing"),
        ({"range": (1.0, 1e9)}, "growth.ratio"),
        ({"points": 1}, "points = 1"),
        ({"level": 0.5}, "above 1"),
        ({"tolerance": -1.0}, "tolerance"),
    ],
)
def test_bad_arguments(arguments: dict[str, object], words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        critical_growth(configured(COARSE), **arguments)  # type: ignore[arg-type]


def test_command_line(capsys: pytest.CaptureFixture[str]) -> None:
    settings = [f"--set={key}={value}" for key, value in (CIRCLE | COARSE).items()]
    arguments = ["threshold", *settings, "--stiffness-ratio", "3", "--range", "1", "1.6", "--points", "4"]
    assert main([*arguments, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    wanted = {
        "parameter", "critical_value", "crossings", "bracket", "mode_number", "wavelength_mm", "growth_time",
        "definition", "evaluations", "wall_s", "reason",
    }  # fmt: skip
    assert wanted <= set(document)
    assert 1.2 < document["critical_value"] < 1.5
    assert main(arguments) == 0
    assert "becomes unstable above" in capsys.readouterr().out
    assert main([*arguments, "--range", "b", "2"]) == 2


def test_a_mesh_too_coarse_for_folds_has_a_smooth_state_all_the_same() -> None:
    """Cells of 24 points stand out of the ellipse by more than a fifth of the cortex: that is no fold."""
    coarse = {"mesh.n_around": 24, "mesh.n_layers": 4, "mesh.n_cortex_layers": 2}
    found = critical_growth(configured(coarse), range=(1.5, 2.3), points=4)
    assert [point.n_negative for point in found.scan] == [0] * 4
    assert found.critical_value is None
