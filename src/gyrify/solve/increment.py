"""One increment: from the better of the last state and an extrapolation of the path to a minimum."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from gyrify.energy.total import TotalEnergy
from gyrify.solve.definite import DefiniteHessian
from gyrify.solve.equilibrium import find_equilibrium
from gyrify.solve.newton import Iterate, minimise
from gyrify.solve.path import Path
from gyrify.solve.problem import Problem, State, Stepping
from gyrify.solve.quasi_newton import QuasiNewton
from gyrify.solve.result import Result, Solution, Stats
from gyrify.solve.system import System

# Newton's method on the residual stays on a branch where it converges at once, or not at all.
_CONTINUATION_ITERATIONS: Final = 8


@dataclass
class Increments:
    """Solves increments one after the other, and carries from each to the next what saves work.

    Attributes
    ----------
    problem : Problem
        The tissue.
    stepping : Stepping
        How growth is divided.
    system : System
        Linear system of the free degrees of freedom.
    path : Path
        The last accepted states.
    watch : callable
        Called at each Newton iteration; may raise to stop.
    model : QuasiNewton
        The latest factor.
    """

    problem: Problem
    stepping: Stepping
    system: System
    path: Path
    watch: Callable[[], None] = lambda: None
    model: QuasiNewton = field(init=False)

    def __post_init__(self) -> None:
        self.model = QuasiNewton(self.problem.old_steps)

    def attempt(self, state: State, span: int) -> Solution:
        """Solve the increment of a span [ticks] after a state."""
        problem = self.problem
        total = self._energy(state, span)
        solution = self._continued(total, state, span)
        if solution is None:
            guess = self._predict(total, state, span)
            criterion, mass = self.stepping.criterion, problem.shift_mass
            solution = minimise(
                total, guess, self.system, criterion, problem.candidates, self.watch, mass, self.model
            )
        if solution.result is Result.CONVERGED and not problem.is_path_admissible(state.u, solution.u):
            return replace(solution, result=Result.CROSSING_PATH)
        return solution

    def accept(self, state: State, work: Stats) -> None:
        """Go on from a state that took so much work."""
        self.path.append(state)
        if is_factor_kept(work):
            self.model.carry()
        else:
            self.model.renew(None)

    def rebuild_factor(self, before: State, span: int) -> None:
        """Make the factor that the increment after a state made at its guess."""
        total = self._energy(before, span)
        guess = self._predict(total, before, span)
        candidates, mass = self.problem.candidates, self.problem.shift_mass
        self.model.renew(DefiniteHessian(total, self.system, candidates, mass).factor(guess.u))
        self.model.carry()

    def _energy(self, state: State, span: int) -> TotalEnergy:
        end = self.stepping.end
        return self.problem.energy((state.position + span) / end, state, state.position / end)

    def _continued(self, total: TotalEnergy, state: State, span: int) -> Solution | None:
        """Equilibrium on the extrapolated path, stable or not; None where that is not plainly its branch."""
        step = (state.u - state.u_before) * (span / state.span)
        size = float(np.abs(step).max())
        if size == 0.0 or not self.problem.is_path_kept:
            return None
        guess = state.u + total.max_step(state.u, step) * step
        criterion = replace(self.stepping.criterion, max_iterations=_CONTINUATION_ITERATIONS)
        solution = find_equilibrium(total, guess, self.system, criterion, self.problem.candidates, self.watch)
        if solution.result is Result.CONVERGED and float(np.abs(solution.u - guess).max()) <= size:
            return solution
        return None

    def _predict(self, total: TotalEnergy, state: State, span: int) -> Iterate:
        """Extrapolation as far as it is admissible, if it lowers the energy."""
        step = self.path.extrapolated(state.position + span) - state.u
        guess = Iterate.at(total, state.u + total.max_step(state.u, step) * step, self.system)
        return guess if guess.value < total.value(state.u) else Iterate.at(total, state.u, self.system)


def is_factor_kept(work: Stats) -> bool:
    """Whether the factor with which an increment ended is one made at its guess, or before it.

    Such a factor can be made again from the accepted states alone.
    """
    return work.newton_iterations <= 1 and work.rejected == 0
