"""Lengths of measuring that follow the size of the body, and one brain in several units of length."""

from __future__ import annotations

import json
import math
import tomllib
from pathlib import Path

import pytest

from gyrify.cli import main
from gyrify.config import Config, preset_names
from gyrify.config.rows import rows
from gyrify.config.schema import json_schema
from gyrify.config.words import decimals
from gyrify.convergence import METRICS, Family
from gyrify.convergence.levels import Level
from gyrify.errors import ConfigError
from gyrify.metrics import Measures
from gyrify.run.simulation import simulate
from gyrify.run.summary import measure_state

Capture = pytest.CaptureFixture[str]
RADIUS, PROMINENCE = "metrics.closing_radius", "metrics.gyrus_prominence"
COARSE: dict[str, object] = {
    "mesh.n_around": 120,
    "mesh.n_layers": 10,
    "mesh.n_cortex_layers": 4,
    "solver.increments": 40,
    "stability.detect": False,
}


def lengths(config: Config) -> tuple[float, float]:
    return config.metrics.closing_radius, config.metrics.gyrus_prominence


@pytest.mark.parametrize("name", preset_names())
def test_presets_keep_their_lengths(name: str) -> None:
    """Those of slices; a body in space has those of its own size."""
    preset = Config.preset(name)
    radius = preset.geometry.mean_radius
    of_size = (0.2779 * radius, 0.3 / 10.0 * 0.2779 * radius)
    expected = (10.0, 0.3) if preset.geometry.n_dim == 2 else pytest.approx(of_size, rel=1e-3)
    assert lengths(preset) == expected


@pytest.mark.parametrize("shape", ["ellipse", "circle"])
@pytest.mark.parametrize("scale", [1e-3, 1 / 36, 0.1, 2.0, 1e3])
def test_lengths_scale_with_the_mean_radius(shape: str, scale: float) -> None:
    geometry = {"shape": shape, "area": 4069.0 * scale**2, "cortical_thickness": 1.5 * scale}
    assert lengths(Config(geometry=geometry)) == pytest.approx((10.0 * scale, 0.3 * scale), rel=1e-14)


def test_lengths_of_a_strip_scale_with_its_cortex_alone() -> None:
    strip = Config(geometry={"shape": "strip"})
    assert lengths(strip) == (10.0, 0.3)
    assert lengths(strip.replace(**{"geometry.depth": 65.0, "geometry.length": 90.0})) == (10.0, 0.3)
    assert lengths(strip.replace(**{"geometry.cortical_thickness": 0.75})) == (5.0, 0.15)


def test_the_papers_thicknesses_keep_the_lengths() -> None:
    for thickness in (0.75, 3.0, 7.5, 8.0):
        assert lengths(Config().replace(**{"geometry.cortical_thickness": thickness})) == (10.0, 0.3)


def test_a_length_that_is_not_given_follows_later_overrides() -> None:
    small = Config().replace(**{"geometry.area": 1000.0})
    assert small.replace(**{"geometry.area": 4069.0}) == Config()
    assert Config(metrics=small.metrics) == Config()
    own = small.replace(**{RADIUS: 4.0})
    assert own.replace(**{"geometry.area": 4069.0}).metrics.closing_radius == 4.0
    assert own.replace(**{"geometry.area": 4069.0}).metrics.gyrus_prominence == 0.3
    assert own.replace(**{RADIUS: None}) == small
    assert Config.from_toml('preset = "wang2019"\n[geometry]\narea = 1000.0').metrics == small.metrics


def test_a_stored_configuration_keeps_its_numbers() -> None:
    old = Config.from_toml(
        "[geometry]\narea = 1000.0\n[metrics]\nclosing_radius = 10.0\ngyrus_prominence = 0.3"
    )
    assert lengths(old) == (10.0, 0.3)
    small = Config().replace(**{"geometry.area": 1000.0})
    stated = tomllib.loads(small.to_toml())["metrics"]
    assert (stated["closing_radius"], stated["gyrus_prominence"]) == lengths(small)
    assert Config.from_toml(small.to_toml()).config_hash == small.config_hash


@pytest.mark.parametrize("geometry", [{"area": 1e10}, {"area": 4e-300, "cortical_thickness": 1e-160}])
def test_the_largest_and_the_smallest_body_can_be_stored(geometry: dict[str, float]) -> None:
    config = Config(geometry=geometry)
    assert Config.from_toml(config.to_toml()) == config


def test_show_and_schema_say_what_is_followed(capsys: Capture) -> None:
    assert main(["config", "show", "--set", "geometry.area=1000"]) == 0
    shown = {line.split()[0]: line for line in capsys.readouterr().out.splitlines()}
    assert shown[RADIUS].endswith("10 mm × scale of the body")
    assert str(10 * math.sqrt(1000.0) / math.sqrt(4069.0)) in shown[RADIUS]
    radius = json_schema()["$defs"]["Metrics"]["properties"]["closing_radius"]
    assert (radius["default"], radius["follows"]) == (None, "10 mm × scale of the body")
    with pytest.raises(ConfigError, match="Leave it out to take 10 mm × scale of the body"):
        Config().replace(**{RADIUS: -1.0})


def test_a_row_is_changed_only_if_it_differs_from_what_it_follows() -> None:
    small = Config().replace(**{"geometry.area": 1000.0})
    for config, changed in ((small, False), (small.replace(**{RADIUS: 10.0}), True)):
        (row,) = [row for row in rows(Config.from_toml(config.to_toml())) if row.key == RADIUS]
        assert row.is_changed is changed


@pytest.fixture(scope="module")
def standard() -> Measures:
    return measure_state(simulate(Config().replace(**COARSE)))


@pytest.mark.parametrize("scale", [1e-3, 1e3, 1 / 36], ids=["in metres", "in micrometres", "2 mm"])
def test_one_brain_in_several_units_has_the_same_indices(standard: Measures, scale: float) -> None:
    body = {"geometry.area": 4069.0 * scale**2, "geometry.cortical_thickness": 1.5 * scale}
    ours = measure_state(simulate(Config().replace(**COARSE, **body))).flat()
    assert standard.n_gyri == 16
    for name, value in standard.flat().items():
        unit = scale if "_mm" in name else 1.0
        assert ours[name] == pytest.approx(unit * value, rel=1e-5), name
    assert 1.0 < ours["gi_closing"] <= ours["gi_hull"]


def test_lengths_below_a_millimetre_keep_their_digits(tmp_path: Path, capsys: Capture) -> None:
    assert [decimals([x], 2) for x in (9.61, 0.1, 0.0, 0.00683, -0.02)] == [2, 2, 2, 5, 4]
    assert decimals([None, math.inf, 0.003], 1) == 4
    body = {"geometry.area": 4069e-6, "geometry.cortical_thickness": 1.5e-3}
    path = tmp_path / "metres.toml"
    path.write_text(Config().replace(**COARSE, **body).to_toml())
    assert main(["run", str(path), "--out", str(tmp_path / "run"), "--quiet"]) == 0
    said = capsys.readouterr().out.splitlines()[0]
    depth = json.loads((tmp_path / "run" / "summary.json").read_text())["sulcal_depth_mm"]["max"]
    assert f"sulci up to {depth:.5f} mm deep" in said
    assert main(["verify", str(tmp_path / "run")]) == 0


def test_a_depth_is_judged_to_the_size_of_the_body() -> None:
    """Depths of 0.03 and 0.0305 mm agree in a slice of 36 mm, and differ by 2 % in one of 2 mm."""
    for area, converged in ((4069.0, True), (4069.0 / 36**2, False)):
        config = Config().replace(
            **{"geometry.area": area, "geometry.cortical_thickness": 1.5 * math.sqrt(area / 4069.0)}
        )
        metrics = [
            dict.fromkeys((m.key for m in METRICS), 1.0) | {"sulcal_depth_mm_max": d} for d in (0.03, 0.0305)
        ]
        levels = tuple(Level(config, Path(), "completed", "", found, 1.0) for found in metrics)
        verdict = Family("mesh", levels, 0.02).verdicts["sulcal_depth_mm_max"]
        assert verdict.converged is converged
