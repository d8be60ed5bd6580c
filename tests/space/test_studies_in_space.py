"""Studies of bodies in space: rows, units, labels, what is kept, and the phase diagram."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from solids import BALL, PATCH, config

from gyrify import read_results, simulate, summarise
from gyrify.cli import main
from gyrify.config import Config
from gyrify.errors import ConfigError
from gyrify.phenotype import classify
from gyrify.report.onset_curve import onset_curve
from gyrify.report.study_data import cells, index_name
from gyrify.report.study_pictures import write_study_pictures
from gyrify.study import Point, Study, StudyResult, final_state, run_points
from gyrify.study.results import dimensions

# Equilibria, measured with a large ball: quick.
QUICK = {"dissipation.kind": "none", "mesh.node_jitter": 0.0, "metrics.closing_radius": 25.0}
SMALL = config(BALL, **{"mesh.edge_length": 24.0, "mesh.n_layers": 4, "solver.increments": 2, **QUICK})
GRID = {"growth.ratio": (1.5, 3.6), "material.stiffness_ratio": (0.5, 1.0)}
KEYS = list(GRID)


def points(base: Config, *overrides: dict[str, Any]) -> list[Point]:
    return [Point(values, base.with_overrides(values)) for values in overrides]


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> StudyResult:
    parameters = [{"key": key, "values": list(values)} for key, values in GRID.items()]
    study = Study(SMALL, Study.from_mapping({"design": {"kind": "grid", "parameter": parameters}}).design)
    with ThreadPoolExecutor(1) as executor:
        return run_points(study.points(), tmp_path_factory.mktemp("study"), executor=executor)


def test_rows_are_what_the_runs_come_to(done: StudyResult) -> None:
    assert done.status == "completed"
    rows = done.table.to_pylist()
    assert [(row["growth.ratio"], row["material.stiffness_ratio"]) for row in rows] == [
        (a, b) for a in GRID["growth.ratio"] for b in GRID["material.stiffness_ratio"]
    ]
    summary = summarise(simulate(done.points[2].config))
    row = rows[2]
    assert row["result_hash"] == summary["result_hash"]
    assert row["gi_area_closing"] == summary["gi"]["area"]["closing"]
    assert row["surface_area_mm2"] == summary["surface_area_mm2"]
    assert row["volume_mm3"] == summary["volume_mm3"]
    # what belongs to a contour is empty
    assert {row[name] for name in ("gi_closing", "gi_hull", "contour_length_mm", "gyrus_width_mm")} == {None}
    # more of a stiffer cortex makes a larger body of the same growth
    assert rows[3]["volume_mm3"] > rows[2]["volume_mm3"]


def test_columns_have_the_units_of_space(done: StudyResult, tmp_path: Path) -> None:
    def units(table: Any) -> dict[str, str]:
        return {
            f.name: f.metadata[b"unit"].decode() for f in table.schema if f.metadata and b"unit" in f.metadata
        }

    found = units(done.table)
    assert found["solver_residual"] == found["solver_tolerance"] == "Pa mm²"
    assert (found["surface_area_mm2"], found["volume_mm3"], found["gi_area_hull"]) == ("mm²", "mm³", "1")
    assert dimensions(done.table) == (3,)
    flat = Config().with_overrides(
        {"mesh.n_around": 48, "mesh.n_layers": 6, "mesh.n_cortex_layers": 2, "solver.increments": 2}
    )
    both = run_points([*points(SMALL, {}), *points(flat, {})], tmp_path)
    assert units(both.table)["solver_residual"] == "Pa mm or Pa mm²"
    assert dimensions(both.table) == (2, 3)


def test_what_is_kept_is_read_back_whole_and_not_run_again(done: StudyResult) -> None:
    point = final_state(done.folder, done.points[2].key)
    history = simulate(point.config)
    assert np.array_equal(point.points, history.points())
    assert point.final.gi_hull.shape == point.final.gi_closing.shape == (3,)
    assert point.final.gi_hull[0] == pytest.approx(1.0)
    assert point.final.gi_closing[-1] == summarise(history)["gi"]["area"]["closing"]
    again = run_points(done.points, done.folder)
    assert again.computed == 0
    assert again.table.equals(done.table)
    assert "gi_area_closing" in again._repr_html_()


def test_points_that_fail_are_rows_with_reasons(tmp_path: Path) -> None:
    hopeless = SMALL.with_overrides({"limits.wall_time": 1e-3})
    result = run_points(points(hopeless, {}), tmp_path)
    assert result.status == "stopped"
    (row,) = result.table.to_pylist()
    assert (row["status"], row["growth_time"], row["n_gyri"]) == ("stopped", 0.0, None)
    (reason,) = result.failures.values()
    assert "wall-time limit" in reason
    assert "1 of 1" not in result._repr_html_()


@pytest.fixture
def few_sections(monkeypatch: pytest.MonkeyPatch) -> None:
    """A curve of theory through few points."""
    monkeypatch.setattr("gyrify.report.onset_curve._SECTIONS", 2)
    monkeypatch.setattr("gyrify.report.onset_curve._SCAN", 3)


@pytest.mark.usefixtures("few_sections")
def test_pictures_and_tables_show_the_index_of_areas(
    done: StudyResult, capsys: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "400")
    rows = read_results(done.folder).to_pylist()
    assert [len(cell.gi) for cell in cells(rows, KEYS)] == [1, 1, 1, 1]
    assert cells(rows, KEYS)[0].gi[0] == rows[0]["gi_area_closing"]
    assert index_name(rows) == "gyrification index (closing, by area)"
    assert [path.name for path in write_study_pictures(done.folder)] == ["phase-diagram.png"]
    assert main(["table", str(done.folder)]) == 0
    printed = capsys.readouterr().out
    assert "gi_area_closing" in printed
    assert "gi_closing" not in printed.replace("gi_area_closing", "")


@pytest.mark.usefixtures("few_sections")
def test_the_curve_of_a_phase_diagram_is_that_of_the_sphere() -> None:
    keys, spans = ("growth.duration", "material.stiffness_ratio"), ((50.0, 500.0), (2.5, 3.0))
    thick = {"geometry.cortical_thickness": 12.0, "growth.law": "tangential", "growth.ratio": 1e4}
    found = onset_curve(config(BALL, **thick), keys, spans)
    assert "a sphere" in found.note
    assert "annulus" not in found.note
    (line,) = found.lines
    at = {ratio: time for time, ratio in (line[0], line[-1])}
    # the same body as that of the thresholds, three times as large
    assert at[3.0] == pytest.approx(164.0, rel=2e-3)
    assert at[2.5] > at[3.0]
    assert "patches" in onset_curve(config(PATCH), keys, spans).note


def test_labels_are_those_that_mean_the_same_in_space(done: StudyResult) -> None:
    assert {row["phenotype"] for row in done.table.to_pylist()} == {"smooth"}
    row = {"gi_area_hull": 1.2, "thickness_mm_crown": 2.0, "thickness_mm_fundus": 1.5}
    shallow = classify({**row, "sulcal_depth_mm_mean": 0.4}, 1.0)
    assert (shallow.label, shallow.because) == ("lissencephaly", "depth = 0.4 < 0.5")
    assert set(shallow.numbers) == {"hull", "depth", "crown_fundus"}
    assert classify({**row, "gi_area_hull": 1.004, "sulcal_depth_mm_mean": 0.4}, 1.0).label == "smooth"
    with pytest.raises(ConfigError, match=r"asks for gyri .* no meaning in space"):
        classify({**row, "sulcal_depth_mm_mean": 0.6}, 1.0)
