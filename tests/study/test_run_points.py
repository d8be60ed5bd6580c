"""Points are run once, stored whole, found again, and redone when they are broken or the solver changes."""

from __future__ import annotations

import json
import shutil
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from small_study import FAILING, GROWTH, STIFFNESS, rows, study

from gyrify import History, read_results, run_study, simulate, summarise
from gyrify.errors import ConfigError, GyrifyError, HistoryError
from gyrify.study import Point, Study, StudyProgress, final_state, known_points, run_points

SMALL = study(GROWTH, STIFFNESS)


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished study; copy it before changing it."""
    folder = tmp_path_factory.mktemp("study")
    assert run_study(SMALL, folder).status == "completed"
    return folder


@pytest.fixture
def copy(done: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(done, tmp_path / "copy"))


def point_of(study_: Study, **overrides: Any) -> Point:
    return Point(dict(overrides), study_.base.with_overrides(overrides))


def test_a_row_is_what_the_run_itself_comes_to(done: Path) -> None:
    table = read_results(done).to_pylist()
    assert [row["key"] for row in table] == [point.key for point in SMALL.points()]
    for row, point in zip(table, SMALL.points(), strict=True):
        summary = summarise(simulate(point.config))
        assert row["result_hash"] == summary["result_hash"]
        assert row["config_hash"] == point.config.config_hash
        assert row["gi_closing"] == summary["gi"]["closing"]
        assert row["sulcal_depth_mm_max"] == summary["sulcal_depth_mm"]["max"]
        assert row["solver_newton_iterations"] == summary["solver"]["newton_iterations"]
        assert row["growth.ratio"] == point.config.growth.ratio
        assert row["phenotype"] == "smooth" or row["gi_hull"] > 1.005
        assert row["wall_s"] > 0.0


def test_warnings_are_a_column_that_older_tables_do_not_have(copy: Path, capsys: Any) -> None:
    import pyarrow.parquet as pq

    from gyrify.cli import main

    table = read_results(copy)
    for row in table.to_pylist():
        assert row["warnings"] == "\n".join(read_record(copy, row["key"])["warnings"])
        assert row["expected_mode_number"] in (None, 19, 20)
    assert main(["table", str(copy)]) == 0
    assert "with warnings" in capsys.readouterr().out
    later = ["warnings", "expected_growth_time", "expected_mode_number", "expected_wavelength_mm"]
    pq.write_table(pq.read_table(copy / "results.parquet").drop_columns(later), copy / "results.parquet")
    assert "warnings" not in read_results(copy).column_names
    assert main(["table", str(copy)]) == 0
    assert "with warnings" not in capsys.readouterr().out


def read_record(folder: Path, key: str) -> dict[str, Any]:
    summary: dict[str, Any] = final_state(folder, key).summary
    return summary


def test_every_quantity_of_a_summary_has_its_column(folded: History) -> None:
    from gyrify.metrics.quantities import flat
    from gyrify.study.results import column_types

    summary = summarise(folded)
    known = {"status", "reason", "advice", "config_hash", "result_hash", "seed", "solver_wall_s"}
    known |= {"stability_changes", "expected_theory", "expected_not_covered"}
    known |= {f"converged_{name}" for name in ("known", "converged", "limit", "sentence", "command")}
    told = ("versions_", "parameters_", "units_")
    found = {name for name in flat(summary) if not name.startswith(told)} - known
    assert found == set(column_types()) - {"phenotype", "phenotype_rule"}


def test_the_same_study_has_the_same_bytes_whoever_computes(done: Path, tmp_path: Path) -> None:
    run_study(SMALL, tmp_path / "processes", workers=2)
    with ThreadPoolExecutor(1) as executor:
        run_study(SMALL, tmp_path / "executor", executor=executor)
    for other in ("processes", "executor"):
        assert (tmp_path / other / "results.parquet").read_bytes() == (done / "results.parquet").read_bytes()
        for point in SMALL.points():
            paths = [folder / "runs" / point.key / "final.npz" for folder in (done, tmp_path / other)]
            assert paths[0].read_bytes() == paths[1].read_bytes()


def test_tables_and_pictures_rebuild_from_what_is_stored(done: Path) -> None:
    point = SMALL.points()[3]
    stored, history = final_state(done, point.key), simulate(point.config)
    assert stored.config == point.config
    np.testing.assert_array_equal(stored.contour, history.contour())
    np.testing.assert_array_equal(stored.final.growth_time, history.growth_times)
    assert stored.final.gi_closing[-1] == stored.summary["gi"]["closing"]
    assert stored.final.gi_hull.shape == stored.final.growth_time.shape
    assert (history.onset is None) == (stored.final.onset_vector.size == 0)
    with pytest.raises(HistoryError, match="no complete run"):
        final_state(done, "0" * 12)


def test_what_is_known_is_not_run_again(copy: Path) -> None:
    told: list[StudyProgress] = []
    before = (copy / "results.parquet").read_bytes()
    assert run_study(SMALL, copy, observer=told.append).computed == 0
    assert [(progress.done, progress.total) for progress in told] == [(4, 4)]
    assert (copy / "results.parquet").read_bytes() == before
    larger = study({**GROWTH, "values": [1.0, 2.0, 3.6]}, STIFFNESS)
    assert run_study(larger, copy).computed == 2
    assert read_results(copy).num_rows == 6


@pytest.mark.parametrize("damage", ["torn", "gone", "empty", "other"])
def test_a_broken_point_is_redone(done: Path, copy: Path, damage: str) -> None:
    target = copy / "runs" / SMALL.points()[1].key
    if damage == "torn":
        whole = (target / "final.npz").read_bytes()
        (target / "final.npz").write_bytes(whole[:-7] + b"\0" * 7)
    elif damage == "gone":
        (target / "final.npz").unlink()
    elif damage == "empty":
        (target / "point.json").write_text("")
    else:
        (target / "point.json").write_text('{"format": 1, "status": []}')
    assert run_study(SMALL, copy).computed == 1
    assert rows(read_results(copy)) == rows(read_results(done))


def test_another_solver_invalidates_every_point(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ("known_points", "solve"):
        monkeypatch.setattr(f"gyrify.study.{module}.solver_version", lambda: "f" * 12)
    assert run_study(SMALL, copy).computed == 4
    assert set(read_results(copy)["solver_version"].to_pylist()) == {"f" * 12}


def test_a_worker_with_another_solver_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gyrify.study.solve.solver_version", lambda: "0" * 12)
    with pytest.raises(GyrifyError, match="solver version 000000000000"):
        run_study(SMALL, tmp_path)


def test_a_failed_point_keeps_its_reason_and_stops_nothing(tmp_path: Path) -> None:
    points = [point_of(SMALL, **FAILING), point_of(SMALL, seed=3)]
    found = run_points(points, tmp_path)
    assert found.status == "failed"
    assert list(found.failures) == [points[0].key]
    assert "Buckling instability" in found.failures[points[0].key]
    first, second = read_results(tmp_path).to_pylist()
    assert (first["status"], second["status"]) == ("failed", "completed")
    assert first["gi_closing"] is None
    assert 0.0 < first["growth_time"] < 500.0
    assert first["seed"] == 0  # of its configuration, where a point does not set it
    assert final_state(tmp_path, points[0].key).final.gi_closing.size > 1
    assert run_points(points, tmp_path).computed == 0
    assert run_points(points, tmp_path, retry_failed=True).computed == 1


def test_a_limit_stops_a_point_and_raising_it_with_a_retry_completes_it(tmp_path: Path) -> None:
    short = point_of(SMALL, **{"limits.wall_time": 1e-6})
    assert run_points([short], tmp_path).status == "stopped"
    longer = Point({}, SMALL.base)
    assert run_points([longer], tmp_path).computed == 0
    found = run_points([longer], tmp_path, retry_failed=True)
    assert (found.status, found.failures) == ("completed", {})


def test_a_whole_run_folder_is_that_of_a_run(tmp_path: Path) -> None:
    point = SMALL.points()[3]
    found = run_points([point], tmp_path, keep="all")
    target = tmp_path / "runs" / point.key
    assert found.status == "completed"
    assert {"journal.sqlite", "history.vtkhdf", "metrics.csv", "folded.png", "config.toml"} <= {
        file.name for file in target.iterdir()
    }
    assert History.load(target).result_hash == read_results(tmp_path)["result_hash"][0].as_py()
    assert json.loads((target / "summary.json").read_text()) == found.point(point.key).summary
    assert run_points([point], tmp_path, keep="all").computed == 0
    (target / "journal.sqlite").unlink()
    assert run_points([point], tmp_path).computed == 0
    assert run_points([point], tmp_path, keep="all").computed == 1


@pytest.mark.parametrize(
    "wrong",
    [{"workers": 0}, {"workers": 1000}, {"keep": "some"}, {"executor": Executor(), "scheduler": "tcp://a:1"}],
)
def test_bad_arguments_are_refused(tmp_path: Path, wrong: dict[str, Any]) -> None:
    with pytest.raises(ConfigError):
        run_study(SMALL, tmp_path, **wrong)
    points = SMALL.points()
    with pytest.raises(ConfigError, match="given twice"):
        run_points([points[0], points[0]], tmp_path)
    with pytest.raises(ConfigError, match="No points"):
        run_points([], tmp_path)


class Broken(Executor):
    """An executor whose futures fail with an error of its own."""

    def __init__(self, error: Exception) -> None:
        self.error = error

    def submit(self, *_: Any, **__: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_exception(self.error)
        return future


def test_a_point_whose_worker_is_lost_fails_by_name(tmp_path: Path) -> None:
    found = run_study(SMALL, tmp_path, executor=Broken(RuntimeError("the node went away")))
    assert all("the node went away" in reason for reason in found.failures.values())
    assert len(found.failures) == 4


def test_one_process_at_a_time_works_on_a_study(tmp_path: Path) -> None:
    def again(progress: StudyProgress) -> None:
        if progress.done == 1:
            with pytest.raises(HistoryError, match=r"study folder .* is in use"):
                run_study(SMALL, tmp_path)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_study(SMALL, tmp_path, observer=again)
    assert read_results(tmp_path).num_rows == 1
    assert run_study(SMALL, tmp_path).computed == 3


def test_results_are_written_while_points_go_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(known_points, "_PAUSE", 0.0)
    seen = []
    run_study(
        SMALL,
        tmp_path,
        observer=lambda p: seen.append(read_results(tmp_path).num_rows if p.done else 0),
    )
    assert seen == [0, 1, 2, 3, 4]
    (tmp_path / "results.parquet").write_bytes(b"PAR1")
    with pytest.raises(HistoryError, match="damaged"):
        read_results(tmp_path)
    with pytest.raises(HistoryError, match="no results"):
        read_results(tmp_path / "nowhere")
