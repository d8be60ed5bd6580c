"""Warnings of values far outside tissue and brains, and of lengths that cannot fit the body."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from gyrify.cli import main
from gyrify.config import Config, preset_names
from gyrify.metrics.contour import edge_lengths
from gyrify.model.meshing import build_mesh
from gyrify.paper.cases import all_cases
from gyrify.run.summary import summarise
from gyrify.run.validity import config_warnings, run_warnings
from gyrify.run.validity.lengths import check_lengths
from gyrify.run.validity.ranges import RANGES, check_ranges, contour_spacing, table
from gyrify.store import History

PAGE = Path(__file__).parents[2] / "docs" / "limits.md"
Capture = pytest.CaptureFixture[str]
OUTSIDE = [
    ({"geometry.area": 40.69}, "geometry.area = 40.69 mm²", "If 40.69 cm² is meant, write 4069."),
    ({"geometry.area": 4069e6}, "geometry.area", "If 4.069e+09 µm² is meant, write 4069."),
    ({"geometry.cortical_thickness": 0.15}, "geometry.cortical_thickness", "If 0.15 cm is meant, write 1.5."),
    ({"geometry.cortical_thickness": 30.0, "geometry.area": 20000.0}, "geometry.cortical_thickness", "in mm"),
    (
        {"material.young_modulus": 9.21087},
        "material.young_modulus",
        "If 9.21087 kPa is meant, write 9210.87.",
    ),
    ({"material.young_modulus": 2e9}, "material.young_modulus", "in Pa"),
    ({"material.stiffness_ratio": 20.0}, "material.stiffness_ratio", "1/3 to 3"),
    ({"material.poisson_ratio": 0.2}, "material.poisson_ratio = 0.2", "0.458"),
    ({"material.poisson_ratio_white": -0.5}, "material.poisson_ratio_white = -0.5", "Leave it out"),
    ({"growth.duration": 2000.0}, "growth strain of the cortex = 4", "lower one"),
    (
        {"growth.duration": 800.0, "growth.stretch": "exponential"},
        "growth strain of the cortex = 3.95",
        "exp",
    ),
    ({"growth.ratio": 0.2}, "growth.ratio = 0.2", "white matter grows faster"),
    ({"growth.ratio": 900.0}, "growth.ratio = 900", "1 to 360"),
    ({"dissipation.number": 300.0}, "dissipation.number = 300", "Lower it"),
    (
        {"geometry.cortical_thickness": 0.5, "mesh.n_around": 72},
        "spacing of the contour's points",
        "n_around",
    ),
    (
        {"geometry.shape": "sphere", "mesh.edge_length": 5.0},
        "edge of the outer surface over the thickness of the cortex = 3.33",
        "mesh.edge_length",
    ),
]


@pytest.mark.parametrize(("overrides", "name", "advice"), OUTSIDE)
def test_a_value_outside_is_told_with_range_source_and_advice(
    overrides: dict[str, object], name: str, advice: str
) -> None:
    told = [text for text in config_warnings(Config().replace(**overrides)) if text.startswith(name)]
    assert len(told) == 1
    assert advice in told[0]
    assert "is outside the range of" in told[0]


def test_every_range_is_left_by_some_case() -> None:
    for known in RANGES:
        assert any(name.startswith(known.name) or known.name.startswith(name) for _, name, _ in OUTSIDE), (
            known.name
        )
        assert known.low < known.high
        assert known.source


@pytest.mark.parametrize("name", preset_names())
def test_presets_and_the_scans_of_the_paper_are_not_warned_of(name: str) -> None:
    base = Config.preset(name)
    assert _unusual(base) == []
    for case in all_cases() if base.geometry.n_dim == 2 else ():  # its cases are slices
        assert _unusual(base.with_overrides(case.overrides)) == [], str(case)


def _unusual(config: Config) -> list[str]:
    """What is said of values alone, not of the mesh."""
    return [*check_ranges(config), *check_lengths(config)]


def test_the_default_of_every_shape_is_not_warned_of() -> None:
    for shape in ("ellipse", "circle", "strip"):
        assert config_warnings(Config(geometry={"shape": shape})) == []


def test_what_the_advice_says_to_write_is_not_warned_of() -> None:
    for overrides, name, advice in OUTSIDE:
        if "meant, write" in advice:
            value = float(advice.rpartition("write ")[2].rstrip("."))
            assert config_warnings(Config().replace(**{**overrides, name.split(" ")[0]: value})) == []


@pytest.mark.parametrize(
    "overrides", [{}, {"mesh.refine": 1}, {"geometry.aspect_ratio": 3.0}, {"geometry.shape": "strip"}]
)
def test_the_spacing_is_that_of_the_mesh(overrides: dict[str, object]) -> None:
    config = Config().replace(**{"mesh.node_jitter": 0.0, **overrides})
    mesh = build_mesh(config)
    edges = edge_lengths(mesh.points[mesh.contour])
    found = float(np.sort(edges)[:-1].mean() if mesh.period else edges.mean())
    assert contour_spacing(config) == pytest.approx(found, rel=1e-3)


LENGTHS = [
    ({"metrics.closing_radius": 40.0}, "larger than the mean radius of the body, 35.99 mm"),
    ({"metrics.closing_radius": 2.0}, "less than 2 spacings of the contour's points, 2.107 mm"),
    (
        {"geometry.shape": "strip", "metrics.closing_radius": 41.0},
        "larger than the period of the body, 40 mm",
    ),
    ({"metrics.gyrus_prominence": 2.0}, "more than the thickness of the cortex, 1.5 mm"),
    ({"metrics.gyrus_prominence": 0.01}, "node jitter counts as gyri"),
]


@pytest.mark.parametrize(("overrides", "says"), LENGTHS)
def test_a_length_that_cannot_fit_is_told(overrides: dict[str, object], says: str) -> None:
    (told,) = config_warnings(Config().replace(**overrides))
    assert says in told
    key, value = (
        told.split(" ", 1)[0],
        None if "Leave" in told else float(told.rpartition("Try ")[2].rstrip(".")),
    )
    assert config_warnings(Config().replace(**overrides).replace(**{key: value})) == []


def test_old_lengths_of_a_body_in_metres_are_told() -> None:
    body = {"geometry.area": 4069e-6, "geometry.cortical_thickness": 1.5e-3}
    told = config_warnings(
        Config().replace(**body, **{"metrics.closing_radius": 10.0, "metrics.gyrus_prominence": 0.3})
    )
    assert any(
        "closing_radius = 10 mm is larger than the mean radius of the body, 0.03599 mm" in text
        for text in told
    )
    assert any("gyrus_prominence = 0.3 mm is more than the thickness" in text for text in told)


def test_config_check_and_run_say_the_same(tiny: Config, tmp_path: Path, capsys: Capture) -> None:
    path = tmp_path / "small.toml"
    path.write_text(tiny.replace(**{"geometry.area": 40.69, "geometry.cortical_thickness": 0.15}).to_toml())
    assert main(["config", "check", str(path), "--json"]) == 0
    checked = json.loads(capsys.readouterr().out)["warnings"]
    assert main(["run", str(path), "--out", str(tmp_path / "run"), "--json", "--quiet"]) == 0
    captured = capsys.readouterr()
    stored = json.loads(captured.out)["warnings"]
    assert len(checked) >= 2
    assert checked == stored[: len(checked)]
    assert all(f"Warning: {text}" in captured.err for text in checked)


def test_dents_that_the_disc_enters_are_told(folded: History) -> None:
    summary = summarise(folded)
    says = f"{summary['n_gyri']} gyri are counted, but the deepest sulcus measures 0.01 mm"
    shallow = summary | {"sulcal_depth_mm": {"max": 0.01, "mean": 0.005}}
    assert summary["n_gyri"] > 0
    assert not any(says[:20] in text for text in run_warnings(folded, summary))
    (told,) = [text for text in run_warnings(folded, shallow) if text.startswith(says)]
    assert "so wide that the disc of 10 mm enters them" in told
    assert not any("are counted" in text for text in run_warnings(folded, shallow | {"n_gyri": 0}))


def test_the_page_lists_the_table() -> None:
    assert table() in PAGE.read_text("utf-8")
