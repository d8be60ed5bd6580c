"""Pictures of a study: chosen by the design, true to the numbers, equal bytes, and theory's curve on top."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from small_study import GROWTH, study

from gyrify import Config, run_study
from gyrify.report.onset_curve import OnsetCurve, onset_curve
from gyrify.report.phase_diagram import phase_figure
from gyrify.report.sensitivity import sensitivity_figure
from gyrify.report.study_data import Cell, axis_label, cells, is_logarithmic
from gyrify.report.study_pictures import write_study_pictures
from gyrify.theory import Annulus, critical_growth_ratio

NO_CURVE = OnsetCurve((), "none")


def grid(n_failed: int = 0) -> list[Cell]:
    """Two by two cells; the last one failed where asked."""
    places = [(1.0, 0.5), (1.0, 2.0), (3.0, 0.5), (3.0, 2.0)]
    found = [Cell(at, (1.0 + i / 10,), (float(i),), "normal", 0) for i, at in enumerate(places)]
    return [*found[:3], Cell(places[3], (), (), "", n_failed)] if n_failed else found


def test_the_curve_is_the_exact_onset_of_the_annulus(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gyrify.report.onset_curve._SECTIONS", 4)
    config = Config.preset("reference-slice")
    keys = ("growth.ratio", "material.stiffness_ratio")
    found = onset_curve(config, keys, ((1.0, 4.0), (0.7, 1.5)))
    (line,) = found.lines
    for ratio in (0.7, 1.1):
        (exact,) = critical_growth_ratio(
            Annulus(stiffness_ratio=ratio, outer_radius=35.9889, inner_radius=17.9944)
        )
        assert np.interp(ratio, line[:, 1], line[:, 0]) == pytest.approx(exact.value, rel=2e-3)
    assert "circle of the same area" in found.note


@pytest.mark.parametrize(
    ("overrides", "keys", "note"),
    [
        ({}, ("growth.ratio", "dissipation.number"), "does not cover dissipation.number"),
        (
            {},
            ("material.poisson_ratio", "growth.rate"),
            "does not cover material.poisson_ratio and growth.rate",
        ),
        ({"geometry.shape": "strip"}, ("growth.ratio", "material.stiffness_ratio"), "does not cover strips"),
    ],
)
def test_without_theory_there_is_a_note(overrides: dict[str, Any], keys: tuple[str, str], note: str) -> None:
    config = Config.preset("reference-slice").with_overrides(overrides)
    found = onset_curve(config, keys, ((0.1, 0.4), (0.1, 1.0)))
    assert not found.lines
    assert note in found.note


def test_a_grid_is_drawn_as_cells_with_their_values() -> None:
    line = np.array([[1.5, 0.5], [2.0, 2.0]])
    figure = phase_figure(grid(), ("growth.ratio", "material.stiffness_ratio"), OnsetCurve((line,), "exact"))
    left, right, *_ = figure.axes
    assert sorted(text.get_text() for text in left.texts) == ["1.00", "1.10", "1.20", "1.30"]
    assert [text.get_text() for text in right.texts] == ["N"] * 4
    np.testing.assert_array_equal(left.lines[0].get_xdata(), line[:, 0])
    assert left.get_xlabel() == "growth ratio"
    assert left.get_ylabel() == "stiffness ratio"
    assert left.get_xlim() == (0.0, 4.0)  # half a step beyond the outermost values


def test_runs_that_did_not_complete_are_crossed_out() -> None:
    figure = phase_figure(grid(1), ("growth.ratio", "material.stiffness_ratio"), NO_CURVE)
    assert [text.get_text() for text in figure.axes[1].texts] == ["N", "N", "N", "×"]
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels == ["N  normal", "×  not completed"]


def test_points_that_make_no_grid_are_drawn_as_points() -> None:
    figure = phase_figure(grid()[:3], ("growth.ratio", "material.stiffness_ratio"), NO_CURVE)
    assert len(figure.axes[0].lines) == 3
    assert not figure.axes[0].patches


def test_sensitivity_shows_means_and_the_spread_of_seeds() -> None:
    found = [
        Cell((0.1, "linear"), (1.2, 1.4), (10.0, 14.0), "normal", 0),
        Cell((1.0, "linear"), (1.5,), (20.0,), "normal", 1),
        Cell((1.0, "quadratic"), (1.1,), (9.0,), "normal", 0),
    ]
    figure = sensitivity_figure(found, ["dissipation.number", "mesh.element"])
    left, right = figure.axes
    np.testing.assert_allclose(left.containers[0].lines[0].get_ydata(), [1.3, 1.5])
    np.testing.assert_allclose(right.containers[0].lines[0].get_ydata(), [12.0, 20.0])
    (bars,) = left.containers[0].lines[2]
    np.testing.assert_allclose(bars.get_segments()[0][:, 1], [1.2, 1.4])
    assert [text.get_text() for text in figure.legends[0].get_texts()] == [
        "mesh element linear",
        "mesh element quadratic",
    ]


def test_runs_that_differ_in_seed_alone_are_one_cell() -> None:
    row = {"growth.ratio": 2.0, "status": "completed", "gi_closing": 1.2, "n_gyri": 4, "phenotype": "smooth"}
    failed = {**row, "status": "failed", "gi_closing": None, "phenotype": None}
    (cell,) = cells([row, {**row, "gi_closing": 1.4, "phenotype": "normal"}, row, failed], ["growth.ratio"])
    assert cell == Cell((2.0,), (1.2, 1.4, 1.2), (4.0, 4.0, 4.0), "smooth", 1)


def test_axes_follow_the_values() -> None:
    assert is_logarithmic(np.array([0.1, 1.0, 10.0]))
    assert not is_logarithmic(np.array([1.0, 2.0, 3.0, 4.0, 5.0]))
    assert not is_logarithmic(np.array([0.0, 1.0, 10.0]))
    assert axis_label("geometry.cortical_thickness") == "cortical thickness [mm]"


def test_pictures_follow_the_design_and_repeat_to_the_byte(tmp_path: Path) -> None:
    drag = {"key": "dissipation.number", "values": [0.1, 1.3]}
    run_study(study(GROWTH, drag), tmp_path)
    files = write_study_pictures(tmp_path)
    assert [file.name for file in files] == ["phase-diagram.png", "dissipation.png"]
    before = [file.read_bytes() for file in files]
    assert [file.read_bytes() for file in write_study_pictures(tmp_path)] == before
    run_study(study(drag, {"key": "seed", "values": [0, 1]}), tmp_path)
    assert [path.name for path in write_study_pictures(tmp_path)] == ["dissipation.png"]
    assert not files[0].exists()  # it was of another design
