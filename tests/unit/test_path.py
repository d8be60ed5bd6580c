"""Extrapolation of the path, and the factor that is carried from increment to increment."""

from __future__ import annotations

import numpy as np
import pytest
from test_growth import Pull
from test_newton import NONE

from gyrify.solve.newton import Criterion
from gyrify.solve.path import Path
from gyrify.solve.problem import TICKS, State, Stepping
from gyrify.solve.quasistatic import grow
from gyrify.solve.result import Stats

STEPPING = Stepping(12, 1e-6, Criterion(1e-3, 20))


def states(positions, u) -> list[State]:
    made, before = [], np.zeros((1, 2))
    for index, position in enumerate(positions):
        now = np.array([[u(position / TICKS), 1.0]])
        made.append(State(index, position, now, TICKS, before, TICKS, NONE, 0.0, Stats()))
        before = now
    return made


@pytest.mark.parametrize("degree", [0, 1, 2, 3])
@pytest.mark.parametrize("positions", [[0, 1, 2, 3, 4], [0, 2, 3, 5, 9]])
def test_polynomials_to_the_third_degree_are_continued_exactly(degree: int, positions: list[int]) -> None:
    def u(t: float) -> float:
        return 3.0 + (t - 1.3) ** degree

    known = states([p * TICKS for p in positions], u)
    path = Path(known[-1], known.__getitem__)
    assert path.extrapolated(11 * TICKS)[0] == pytest.approx([u(11.0), 1.0], rel=1e-11)


def test_hindsight_prefers_a_line_where_the_path_has_a_kink() -> None:
    """Flat until 4 and steep after it: what was flat for long misleads, the last two states do not."""
    known = states([p * TICKS for p in range(7)], lambda t: 10.0 * max(t - 4.0, 0.0))
    path = Path(known[-1], known.__getitem__)
    assert path.extrapolated(7 * TICKS)[0, 0] == pytest.approx(30.0, rel=1e-12)


def test_a_path_that_grew_is_one_that_was_recalled() -> None:
    known = states([p * TICKS for p in range(8)], lambda t: t**3 - 4.0 * t)
    grown = Path(known[0], known.__getitem__)
    for state in known[1:]:
        grown.append(state)
        recalled = Path(state, known.__getitem__)
        at = state.position + TICKS // 2
        assert np.array_equal(grown.extrapolated(at), recalled.extrapolated(at))


def test_one_factor_serves_all_increments_of_a_constant_stiffness() -> None:
    found = list(grow(Pull(old_steps=8, wobble=0.1), STEPPING, State.reference(1, 2)))
    goals = [10.0 * k / 12 + 0.1 * np.sin(k) for k in range(1, 13)]
    assert [state.u[0, 0] for state in found] == pytest.approx(goals, abs=1e-9)
    assert found[-1].stats.newton_iterations == 12
    assert found[-1].stats.factorizations == 1


@pytest.mark.parametrize("number", range(1, 12))
@pytest.mark.parametrize("stiffens", [0.0, 5.0, 50.0])
def test_growth_taken_up_goes_on_as_if_it_had_never_stopped(number: int, stiffens: float) -> None:
    """With the carried factor: a second problem makes it again from the accepted states, if it can be."""
    reference, problem = State.reference(1, 2), Pull(old_steps=8, wobble=0.1, stiffens=stiffens)
    whole = [reference, *grow(problem, STEPPING, reference)]
    again = [whole[number], *grow(problem, STEPPING, whole[number], recall=whole.__getitem__)]
    for known, found in zip(whole[number:], again, strict=True):
        assert np.array_equal(known.u, found.u)
        assert known.stats == found.stats


def test_growth_cannot_be_taken_up_without_what_came_before() -> None:
    *_, last = grow(Pull(), STEPPING, State.reference(1, 2))
    with pytest.raises(ValueError, match="give `recall`"):
        next(grow(Pull(), Stepping(24, 1e-6, STEPPING.criterion), last))
