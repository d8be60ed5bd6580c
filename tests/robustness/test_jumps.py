"""Without dissipation tissue snaps: a jump's straight path may cross the contour, its descent never does."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from gyrify import Config, simulate
from gyrify.errors import SolveError
from gyrify.run.reevaluation import Increment
from gyrify.solve.increment import Increments
from gyrify.solve.problem import State
from gyrify.solve.result import Result, Solution
from gyrify.verify import verify
from gyrify.verify.recheck import _check_path

FINE = Increment(0.0, 0.0, 0.0, 1.0, 1.0, 0, 0, True, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def path_check(increments: list[Increment], jumps: set[int]) -> tuple[bool, str]:
    found = _check_path(increments, jumps)
    return found.passed, found.sentence


def test_only_the_straight_path_of_a_jump_may_cross() -> None:
    crossing = [FINE, replace(FINE, is_path_free=False)]
    assert path_check([FINE, FINE], set()) == (
        True,
        "0 of 2 straight paths between states cross the contour.",
    )
    assert not path_check(crossing, set())[0]
    assert not path_check(crossing, {1})[0]
    passed, sentence = path_check(crossing, {2})
    assert passed
    assert "1 jumps" in sentence


@pytest.fixture
def crossing_from_three(monkeypatch: pytest.MonkeyPatch) -> None:
    """From the third state on, however small the increment, its straight path crosses; once."""
    attempt, crossed = Increments.attempt, []

    def cross(increments: Increments, state: State, span: int) -> Solution:
        solution = attempt(increments, state, span)
        if state.index == 3 and solution.result is Result.CONVERGED:
            crossed.append(span)
            return replace(solution, result=Result.CROSSING_PATH)
        return solution

    monkeypatch.setattr(Increments, "attempt", cross)


@pytest.mark.usefixtures("crossing_from_three")
def test_a_jump_is_accepted_at_the_smallest_increment_without_dissipation(
    tiny: Config, tmp_path: Path
) -> None:
    coarse = tiny.with_overrides({"solver.min_increment": 0.01})
    with pytest.raises(SolveError, match="straight path"):
        simulate(coarse)
    history = simulate(coarse.with_overrides({"dissipation.kind": "none"}), tmp_path)
    assert history.status == "completed"
    spans = history.journal.column("span")
    assert history.slice.stepping.is_smallest(spans[4])
    assert not history.slice.stepping.is_smallest(spans[3])
    history.journal.close()
    assert verify(tmp_path).passed
