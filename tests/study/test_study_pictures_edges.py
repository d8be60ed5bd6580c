"""Pictures of a study without onset, with nothing in it, with one point, or with runs that failed."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from small_study import GROWTH, study

from gyrify import Config, plot, read_results, run_study
from gyrify.cli import main
from gyrify.errors import HistoryError
from gyrify.report import onset_curve as onset_module
from gyrify.report.html.page_of_study import study_page
from gyrify.report.onset_curve import OnsetCurve, onset_curve
from gyrify.report.phase_diagram import phase_figure
from gyrify.report.sensitivity import sensitivity_figure
from gyrify.report.study_data import Cell, Row, cells, varied
from gyrify.report.study_pictures import write_study_pictures
from gyrify.study.results import write_results

KEYS = ("growth.ratio", "material.stiffness_ratio")
PLACES: dict[str, list[tuple[float, float]]] = {
    "empty": [],
    "one point": [(1.0, 2.0)],
    "one row": [(1.0, 2.0), (2.0, 2.0)],
    "grid": [(x, y) for x in (1.0, 3.0) for y in (0.5, 2.0)],
    "grid of equal ratios": [(x, y) for x in (0.1, 1.0, 10.0) for y in (1.0, 2.0)],
    "scattered": [(1.0, 2.0), (2.0, 3.0), (4.0, 1.0), (5.0, 9.0)],
}
ENDS = ("all stable", "all folded", "all failed", "one failed")
FAILED: Row = {"status": "failed", "gi_closing": None, "n_gyri": None, "phenotype": None}
FAILING = {"max_newton": 1, "min_increment": 0.1}


def runs(places: list[tuple[float, float]], end: str) -> list[Cell]:
    """Cells at these places whose runs ended so."""
    found = []
    for number, at in enumerate(places):
        has_failed = end == "all failed" or (end == "one failed" and number == 0)
        gi, gyri, phenotype = (1.0, 0.0, "smooth") if end == "all stable" else (1.4, 12.0, "normal")
        found.append(Cell(at, (), (), "", 1) if has_failed else Cell(at, (gi,), (gyri,), phenotype, 0))
    return found


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("end", ENDS)
@pytest.mark.parametrize("places", PLACES.values(), ids=list(PLACES))
def test_every_picture_is_drawn(places: list[tuple[float, float]], end: str) -> None:
    found = runs(places, end)
    phase = phase_figure(found, KEYS, OnsetCurve((), "no curve"))
    drag = sensitivity_figure(found, ["dissipation.number", "growth.ratio"])
    for figure in (phase, drag):
        figure.canvas.draw()
    marks = [mark for axes in phase.axes[:2] for mark in (*axes.patches, *axes.lines)]
    assert len(marks) == 2 * len(places)


@pytest.mark.parametrize(
    ("keys", "spans", "n_lines", "note"),
    [
        (KEYS, ((3.0, 4.0), (1.0, 2.0)), 0, "does not change stability in this range"),
        (KEYS, ((1.0, 1.2), (1.0, 2.0)), 0, "does not change stability in this range"),
        (KEYS, ((2.0, 2.0), (1.0, 1.0)), 0, "does not change stability in this range"),
        (
            ("geometry.cortical_thickness", "material.stiffness_ratio"),
            ((1.0, 2.0), (1.0, 2.0)),
            0,
            "does not change stability in this range",
        ),
        (KEYS, ((1.0, 4.0), (1.0, 2.0)), 1, "Onset: exact"),
        (
            ("growth.ratio", "geometry.cortical_thickness"),
            ((3.0, 4.0), (30.0, 40.0)),
            0,
            "without a smooth state throughout",
        ),
        (
            ("growth.ratio", "geometry.cortical_thickness"),
            ((1.0, 3.0), (1.0, 30.0)),
            1,
            "without a smooth state",
        ),
    ],
)
def test_an_onset_that_is_not_crossed_has_no_curve(
    keys: tuple[str, str],
    spans: tuple[tuple[float, float], tuple[float, float]],
    n_lines: int,
    note: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(onset_module, "_SECTIONS", 4)
    found = onset_curve(Config.preset("reference-slice"), keys, spans)
    assert len(found.lines) == n_lines
    assert note in found.note


@pytest.mark.parametrize(
    ("sections", "sizes", "note"),
    [
        ([[], [], [], []], [], "does not change stability in this range"),
        ([None, None, None, None], [], "in this range: without a smooth state throughout"),
        ([None, [], [], []], [], "no onset in 4 of 4 sections (1 without a smooth state, 3 stable)"),
        ([[2.0], [], [], []], [], "only at an edge of this range"),
        ([[2.0], [2.1], [], []], [2], "Onset: exact"),
        ([[2.0], [2.1], [2.2, 3.0], [2.3, 3.1]], [4, 2], "Onset: exact"),
        # Where two sections in the middle have none, no line is drawn through them.
        ([[2.0], [2.1], [], [], [2.5], [2.6]], [2, 2], "Onset: exact"),
    ],
)
def test_curves_go_through_neighbouring_sections_only(
    sections: list[list[float] | None], sizes: list[int], note: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(onset_module, "_SECTIONS", len(sections))
    answers = iter(sections)

    def section(*_: object) -> onset_module._Section:
        values = next(answers)
        return onset_module._Section(values or [], "without a smooth state" if values is None else "stable")

    monkeypatch.setattr(onset_module, "_section", section)
    found = onset_curve(Config.preset("reference-slice"), KEYS, ((1.0, 4.0), (10.0, 9.0 + len(sections))))
    assert [round(float(np.ptp(line[:, 1]))) + 1 for line in found.lines] == sizes
    assert note in found.note


def test_nothing_varies_in_no_rows() -> None:
    assert varied([]) == []
    assert cells([], KEYS) == []


def test_an_index_that_is_not_finite_counts_as_not_completed() -> None:
    row = {"growth.ratio": 2.0, "status": "completed", "n_gyri": 3, "phenotype": "normal"}
    rows = [{**row, "gi_closing": value} for value in (1.5, float("inf"), float("nan"))]
    (cell,) = cells(rows, ["growth.ratio"])
    assert (cell.gi, cell.n_failed) == ((1.5,), 2)


def text_of(parameter: str, values: str, **solver: float) -> str:
    """A study over the growth ratio and one parameter more."""
    settings = "".join(f"solver.{key} = {value}\n" for key, value in solver.items())
    return f"""
[base]
preset = "reference-slice"
mesh.n_around = 48
mesh.n_layers = 6
mesh.n_cortex_layers = 2
solver.increments = 4
{settings}
[design]
kind = "grid"

[[design.parameter]]
key = "growth.ratio"
values = [3, 4]

[[design.parameter]]
key = "{parameter}"
values = {values}
"""


@pytest.mark.parametrize(
    ("parameter", "values", "solver", "code"),
    [
        ("material.stiffness_ratio", "[1, 2]", {}, 0),
        ("dissipation.number", "[1, 2]", {}, 0),
        ("material.stiffness_ratio", "[1, 2]", FAILING, 1),
    ],
)
def test_a_study_that_never_crosses_onset_ends_with_its_json(
    parameter: str,
    values: str,
    solver: dict[str, float],
    code: int,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    file, out = tmp_path / "study.toml", tmp_path / "out"
    file.write_text(text_of(parameter, values, **solver), encoding="utf-8")
    command = ["study", str(file), "--out", str(out), "--workers", "1", "--json", "--quiet"]
    for _ in range(2):
        assert main(command) == code
        said = json.loads(capsys.readouterr().out)
        assert said["total"] == 4
        assert str(out / "phase-diagram.png") in said["pictures"]
    assert "phase-diagram" not in study_page(out, "s")  # it draws its own, and does not fail either
    assert len(plot(out).axes) >= 4


def test_results_without_a_row_are_read_and_shown(tmp_path: Path) -> None:
    write_results(tmp_path, [], {})
    assert read_results(tmp_path).num_rows == 0
    assert write_study_pictures(tmp_path) == []
    assert '"runs":[]' in study_page(tmp_path, "s")
    with pytest.raises(HistoryError, match="No run of the study"):
        plot(tmp_path)


def test_a_picture_that_cannot_be_written_does_not_take_the_results_with_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    file, out = tmp_path / "study.toml", tmp_path / "out"
    file.write_text(text_of("seed", "[0, 1]"), encoding="utf-8")

    def refuse(_: Path) -> list[Path]:
        raise HistoryError("phase-diagram.png cannot be written: no space.", "Free space.")

    monkeypatch.setattr("gyrify.report.study_pictures.write_study_pictures", refuse)
    assert main(["study", str(file), "--out", str(out), "--workers", "1", "--json", "--quiet"]) == 1
    told = capsys.readouterr()
    assert json.loads(told.out)["pictures"] == []
    assert json.loads(told.out)["completed"] == 4
    assert "cannot be written: no space. Free space." in told.err


def test_a_random_design_is_drawn_without_onset(tmp_path: Path) -> None:
    random = {"n": 3, "seed": 1}
    ranged = [{"key": key, "range": [3.0, 4.0]} for key in KEYS]
    run_study(study(*ranged, kind="random", **random), tmp_path)
    assert [path.name for path in write_study_pictures(tmp_path)] == ["phase-diagram.png"]
    run_study(study(GROWTH), tmp_path)
    assert write_study_pictures(tmp_path) == []
