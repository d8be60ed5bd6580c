"""A variable that a test makes up is part of the state: stored, resumed, hashed, and its energy is booked."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import numpy as np
import pytest
from forging import write_outputs

import gyrify
from gyrify.config import Config
from gyrify.energy.term import Evaluation, Hessian, Pattern
from gyrify.errors import HistoryError
from gyrify.model import internal, terms
from gyrify.model.internal import InternalVariable
from gyrify.model.slice import Slice
from gyrify.model.terms import TERMS, GrowthStep, TermKind
from gyrify.run.reevaluation import reevaluated
from gyrify.solve.problem import State
from gyrify.verify import verify

STIFFNESS = 100.0  # Pa
# Part of the way that an anchor goes towards its point in each increment.
CREEP = 0.25


class Anchors:
    """Springs from each point of the contour to an anchor that creeps after it."""

    is_barrier = False

    def __init__(self, step: GrowthStep) -> None:
        self._points, self._anchors = step.problem.mesh.contour, step.internal["anchors"]
        dofs = np.sort((2 * self._points[:, None] + np.arange(2)).ravel())
        self._pattern = Pattern(dofs, dofs)

    def evaluate(self, u: np.ndarray, order: int, project_psd: bool = False) -> Evaluation:  # noqa: ARG002
        moved, gradient = u[self._points] - self._anchors, np.zeros_like(u)
        gradient[self._points] = STIFFNESS * moved
        hessian = Hessian(self._pattern, np.full(self._pattern.rows.size, STIFFNESS))
        value = 0.5 * STIFFNESS * float(np.sum(moved * moved))
        return Evaluation(value, gradient if order > 0 else None, hessian if order > 1 else None)

    def max_step(self, u: np.ndarray, du: np.ndarray) -> float:  # noqa: ARG002
        return 1.0


def at_start(problem: Slice) -> np.ndarray:
    return np.zeros((problem.mesh.contour.size, 2))


def after(problem: Slice, before: State, now: State) -> np.ndarray:
    anchors = before.internal["anchors"]
    return anchors + CREEP * (now.u[problem.mesh.contour] - anchors)


@pytest.fixture(autouse=True)
def registered(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(internal, "INTERNAL", [InternalVariable("anchors", at_start, after)])
    monkeypatch.setattr("gyrify.model.slice.INTERNAL", internal.INTERNAL)
    monkeypatch.setattr(terms, "TERMS", [*TERMS, TermKind("anchors", "stored", Anchors)])


def cut(config: Config, folder: Path, after_increment: int) -> None:
    def stop(progress: gyrify.Progress) -> None:
        if progress.state.index == after_increment:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        gyrify.simulate(config, folder, observers=[stop])


def test_it_is_stored_and_resumed_to_the_same_bytes(tiny: Config, tmp_path: Path) -> None:
    whole = gyrify.simulate(tiny, tmp_path / "whole")
    cut(tiny, tmp_path / "cut", 4)
    resumed = gyrify.resume(tmp_path / "cut")
    assert resumed.result_hash == whole.result_hash
    anchors, expected = [np.zeros((whole.mesh.contour.size, 2))], np.zeros((whole.mesh.contour.size, 2))
    for number in range(1, len(whole)):
        expected = expected + CREEP * (whole.displacement(number)[whole.mesh.contour] - expected)
        anchors.append(whole.journal.state(number).internal["anchors"])
        np.testing.assert_array_equal(anchors[-1], expected)
    assert np.abs(anchors[-1]).max() > 0.1


def test_the_hash_covers_it(tiny: Config, tmp_path: Path) -> None:
    history = gyrify.simulate(tiny, tmp_path / "run")
    before = history.result_hash
    history.journal.close()
    edit(tmp_path / "run", "DELETE FROM internal")
    assert gyrify.History.load(tmp_path / "run").result_hash != before


@pytest.mark.parametrize(
    ("statement", "what"),
    [
        ("UPDATE internal SET data = zeroblob(length(data)) WHERE number = 3", "variable anchors is damaged"),
        ("DELETE FROM internal WHERE number = 3", "values that no run can have"),
    ],
)
def test_damage_to_it_is_found(tiny: Config, tmp_path: Path, statement: str, what: str) -> None:
    gyrify.simulate(tiny, tmp_path / "run").journal.close()
    edit(tmp_path / "run", statement)
    with pytest.raises(HistoryError, match=f"Increment 3 .*{what}"):
        gyrify.History.load(tmp_path / "run")


def edit(folder: Path, statement: str) -> None:
    with sqlite3.connect(folder / "journal.sqlite") as database:
        database.execute(statement)
    database.close()


def test_what_it_lets_go_is_dissipated_and_the_balance_is_closed(folding: Config, tmp_path: Path) -> None:
    config = folding.with_overrides({"growth.duration": 450.0, "solver.increments": 50})
    history = gyrify.simulate(config, tmp_path / "run")
    write_outputs(history, tmp_path / "run")
    increments = list(reevaluated(history))
    work = sum(i.work for i in increments)
    assert sum(abs(i.defect) for i in increments) < 0.02 * work
    last = history.journal.state(len(history) - 1)
    springs = 0.5 * STIFFNESS * np.sum((last.u[history.mesh.contour] - last.internal["anchors"]) ** 2)
    elastic = history.slice.elastic_energy(history.slice.kinematics(450.0)).evaluate(last.u, 0).value
    assert sum(i.stored for i in increments) == pytest.approx(springs + elastic, rel=1e-9)
    assert verify(tmp_path / "run").passed


def test_a_run_without_one_has_no_table_for_it(
    tiny: Config, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.undo()
    gyrify.simulate(tiny, tmp_path / "run")
    with sqlite3.connect(tmp_path / "run" / "journal.sqlite") as database:
        tables = {row[0] for row in database.execute("SELECT name FROM sqlite_master WHERE type = 'table'")}
    database.close()
    assert "internal" not in tables
    assert "increments" in tables
