"""Increments of growth on problems small enough to solve by hand."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest
from test_newton import DIAGONAL, NONE, Well, system

from gyrify.energy.term import Evaluation, Hessian
from gyrify.energy.total import TotalEnergy
from gyrify.errors import SolveError
from gyrify.solve.newton import Criterion
from gyrify.solve.problem import TICKS, State, Stepping
from gyrify.solve.quasistatic import grow
from gyrify.solve.system import System


@dataclass
class Pull:
    """A problem whose solution is x = 10 x growth; paths longer than ``longest`` count as crossing.

    At the k-th of twelve increments the solution is off by ``wobble`` sin k. The spring ``stiffens`` with its
    length.
    """

    longest: float = np.inf
    refuses_after: float = np.inf
    shift_mass: np.ndarray | None = None
    old_steps: int = 0
    is_path_kept: bool = False
    may_jump: bool = False
    wobble: float = 0.0
    stiffens: float = 0.0

    def evolved(self, before: State, after: State) -> State:  # noqa: ARG002
        return after

    def energy(self, fraction: float, start: State, start_fraction: float) -> TotalEnergy:  # noqa: ARG002
        goal = 10.0 * fraction + self.wobble * np.sin(12.0 * fraction)
        dead, k = fraction > self.refuses_after, self.stiffens

        class Spring(Well):
            def evaluate(self, u, order, project_psd=False):  # noqa: ARG002
                if dead:
                    return Evaluation(np.inf)
                arm = u - [goal, 0.0]
                square = float(np.sum(arm**2))
                force = (1.0 + k * square) * arm
                stiffness = 1.0 + k * square * np.array([3.0, 1.0])
                return Evaluation(0.5 * square + 0.25 * k * square**2, force, Hessian(DIAGONAL, stiffness))

        return TotalEnergy([Spring(0.0)])

    def increment_system(self, couplings: np.ndarray) -> System:
        return self.system(couplings)

    def system(self, couplings: np.ndarray) -> System:  # noqa: ARG002
        return system()

    def candidates(self, u: np.ndarray) -> np.ndarray:  # noqa: ARG002
        return NONE

    def is_path_admissible(self, u: np.ndarray, u_end: np.ndarray) -> bool:
        return bool(np.abs(u_end - u).max() <= self.longest)


def states(problem: Pull, increments: int = 4, smallest: float = 1e-6) -> list[State]:
    stepping = Stepping(increments, smallest, Criterion(1e-9, 20))
    return list(grow(problem, stepping, State.reference(1, 2)))


def test_growth_reaches_its_end_in_the_nominal_increments() -> None:
    found = states(Pull())
    assert [state.position for state in found] == [k * TICKS for k in (1, 2, 3, 4)]
    assert [state.u[0, 0] for state in found] == pytest.approx([2.5, 5.0, 7.5, 10.0])
    assert found[-1].stats.rejected == 0


def test_increments_whose_path_crosses_are_halved_until_it_does_not() -> None:
    """An increment moves 10 / 4 = 2.5; paths longer than 0.7 cross: it takes 2.5 / 4 = 0.625."""
    found = states(Pull(longest=0.7))
    steps = np.diff([0.0, *(state.u[0, 0] for state in found)])
    assert steps == pytest.approx(np.full(16, 0.625))
    assert found[-1].stats.rejected > 0
    assert all(after.position - before.position == after.span for before, after in pairwise(found))


def test_spans_double_again_only_on_the_grid_of_nominal_increments() -> None:
    for state in states(Pull(longest=0.7)):
        assert state.position % state.next_span == 0
        assert state.next_span <= TICKS


def test_growth_that_cannot_go_on_stops_with_its_reason() -> None:
    with pytest.raises(SolveError, match="inverted") as failure:
        states(Pull(refuses_after=0.6), smallest=1e-3)
    # 0.6 of the duration is approached to within the smallest increment
    assert "59.9" in failure.value.message or "60.0" in failure.value.message
    assert failure.value.advice
