"""Each point is run once, in processes or here, and the loss of stability is looked for once."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from gyrify.config import Config
from gyrify.errors import SolveError
from gyrify.paper import Case
from gyrify.paper.cases import EQUAL, SOFT
from gyrify.paper.index import Index
from gyrify.paper.loss_of_stability import FILE, stability_thresholds
from gyrify.paper.reading import Mechanics, Reading, point_of
from gyrify.paper.reproduce import known_rows
from gyrify.paper.simulations import Simulations
from gyrify.study import StudyProgress, read_results

BASE = Config().with_overrides(
    {
        "mesh.n_around": 24,
        "mesh.n_layers": 4,
        "mesh.n_cortex_layers": 2,
        "solver.increments": 2,
        "growth.rate": 0.0005,
        "metrics.samples": 100,
    }
)
POINTS = [point_of(BASE, Mechanics(), case, 0) for case in (Case(EQUAL), Case(SOFT), Case(EQUAL, 1.0))]


def test_points_are_run_once_and_remembered(tmp_path: Path) -> None:
    seen: list[StudyProgress] = []
    with Simulations(tmp_path, 2, seen.append) as simulations:
        simulations.run(POINTS[:2])
        simulations.run([*POINTS, POINTS[0]])
        assert simulations.computed == len(simulations.records) == 3
        simulations.write()
    assert read_results(tmp_path)["growth.ratio"].to_pylist() == [3.6, 3.6, 1.0]
    assert seen[-1].done == 1
    with Simulations(tmp_path) as again:
        assert again.row(POINTS[0], Index()) is None
        again.run(POINTS)
        assert again.computed == 0
        rows = known_rows(again, BASE, Reading(), (Case(EQUAL), Case(SOFT), Case(2.0)), 0)
        assert list(rows) == [Case(EQUAL), Case(SOFT)]
        assert rows[Case(EQUAL)].gi == pytest.approx(1.0, abs=0.01)
        stored = again.stored(rows[Case(EQUAL)].key)
        assert stored.points.shape == stored.mesh.points.shape


def test_a_run_that_fails_is_a_row(tmp_path: Path) -> None:
    stalls = BASE.with_overrides({"solver.max_newton": 1, "growth.rate": 0.01, "solver.min_increment": 0.4})
    with Simulations(tmp_path) as simulations:
        simulations.run([point_of(stalls, Mechanics(), Case(), 0)])
        (row,) = known_rows(simulations, stalls, Reading(), (Case(),), 0).values()
    assert row.status == "failed"
    assert row.reason


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (SimpleNamespace(critical_value=1.80961, mode_number=16), "1.810 (mode 16)"),
        (SimpleNamespace(critical_value=None, mode_number=None, at_edge=False), "not up to 2.5"),
        (SimpleNamespace(critical_value=None, mode_number=None, at_edge=True), "below 1"),
        (SolveError("Lost."), "not found (Lost.)"),
        (ValueError("min() arg is an empty sequence"), "not found (no smooth state)"),
    ],
)
def test_loss_of_stability_is_told_and_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, answer: Any, words: str
) -> None:
    calls: list[tuple[float, float]] = []

    def critical(*arguments: Any, **_: object) -> Any:
        calls.append(arguments[3])
        if isinstance(answer, Exception):
            raise answer
        return answer

    monkeypatch.setattr("gyrify.paper.loss_of_stability.critical_growth", critical)
    with Simulations(tmp_path) as simulations:
        for _ in range(2):
            assert stability_thresholds(simulations, [POINTS[0].config], [2.5]) == [words]
    assert calls == [(1.0, 2.5)]
    assert (tmp_path / FILE).is_file()
