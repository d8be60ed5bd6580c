"""Quasi-static growth: increments that are accepted, or rejected and halved."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Final, Protocol

import numpy as np

from gyrify.energy.total import TotalEnergy
from gyrify.errors import SolveError
from gyrify.solve.equilibrium import find_equilibrium
from gyrify.solve.newton import Criterion, Iterate, minimise
from gyrify.solve.result import Result, Solution, Stats
from gyrify.solve.system import System
from gyrify.solve.types import FloatArray, IntArray

# A nominal increment is this many ticks: growth time is an integer, so halving and resuming are exact.
TICKS: Final = 2**20
# Newton's method on the residual stays on a branch where it converges at once, or not at all.
_CONTINUATION_ITERATIONS: Final = 8


@dataclass(frozen=True, eq=False)
class State:
    """An accepted increment, with all that the next one depends on.

    Attributes
    ----------
    index : int
        Number of the increment; 0 is the reference state.
    position : int
        Growth time in ticks.
    u : (n_points, n_dim) float array
        Displacement [mm].
    span : int
        Ticks of the increment that led here.
    u_before : (n_points, n_dim) float array
        Displacement at its start [mm].
    next_span : int
        Ticks of the increment to try next.
    couplings : (n_pairs, 2) int array
        Point pairs in the sparsity pattern because of contact.
    residual : float
        Largest nodal force [Pa mm].
    stats : Stats
        Work since the start of the run.
    """

    index: int
    position: int
    u: FloatArray
    span: int
    u_before: FloatArray
    next_span: int
    couplings: IntArray
    residual: float
    stats: Stats

    @staticmethod
    def reference(n_points: int, n_dim: int) -> State:
        """Undeformed state at growth time zero."""
        zero = np.zeros((n_points, n_dim))
        return State(0, 0, zero, TICKS, zero, TICKS, np.empty((0, 2), dtype=np.int64), 0.0, Stats())


class Problem(Protocol):
    """What the driver needs to know of the tissue."""

    @property
    def shift_mass(self) -> FloatArray | None:
        """Diagonal of the mass that indefinite Hessians are shifted by; None to project them."""
        ...

    @property
    def old_steps(self) -> int:
        """How many steps with an old Hessian are worth trying; see `gyrify.solve.newton.minimise`."""
        ...

    @property
    def is_path_kept(self) -> bool:
        """Whether to stay on a branch of equilibria where it turns unstable, for `inspect` to see that."""
        ...

    @property
    def may_jump(self) -> bool:
        """Whether the path of states may have jumps, which no increment is small enough to resolve."""
        ...

    def energy(self, fraction: float, start: State, start_fraction: float) -> TotalEnergy:
        """Total energy at a fraction of the growth duration, for an increment from a state."""
        ...

    def system(self, couplings: IntArray) -> System:
        """Linear system with couplings in its pattern."""
        ...

    def candidates(self, u: FloatArray) -> IntArray:
        """Point pairs that contact may couple soon."""
        ...

    def is_path_admissible(self, u: FloatArray, u_end: FloatArray) -> bool:
        """Whether the contour crosses itself nowhere on the straight path between two states."""
        ...


@dataclass(frozen=True)
class Stepping:
    """How growth is divided into increments.

    Attributes
    ----------
    increments : int
        Nominal number of increments.
    min_increment : float
        Smallest increment, as a fraction of the duration.
    criterion : Criterion
        When an increment has converged.
    """

    increments: int
    min_increment: float
    criterion: Criterion

    @property
    def end(self) -> int:
        """Final growth time in ticks."""
        return self.increments * TICKS

    @property
    def smallest_span(self) -> float:
        """Smallest increment in ticks, a whole number of them at least."""
        return max(1.0, self.min_increment * self.end)

    def is_smallest(self, span: int) -> bool:
        """Whether half of an increment would be too small."""
        return span // 2 < self.smallest_span


def grow(
    problem: Problem,
    stepping: Stepping,
    state: State,
    watch: Callable[[], None] = lambda: None,
    inspect: Callable[[State, State], State] = lambda _, accepted: accepted,
) -> Iterator[State]:
    """Accepted states after ``state``, up to the end of growth.

    Parameters
    ----------
    problem : Problem
        The tissue.
    stepping : Stepping
        How growth is divided.
    state : State
        Where to start: the reference state, or a stored one.
    watch : callable
        Called at each Newton iteration; may raise to stop.
    inspect : callable
        Called with the last and the new state of each increment; gives the state to go on from.

    Yields
    ------
    State

    Raises
    ------
    SolveError
        If an increment fails at the smallest size; the message names the reason.
    """
    system = problem.system(state.couplings)
    if state.index == 0:
        state = replace(state, stats=state.stats + Stats(analyses=system.analyses))
    while state.position < stepping.end:
        state = inspect(state, _advance(problem, stepping, state, system, watch))
        yield state


def _advance(
    problem: Problem, stepping: Stepping, state: State, system: System, watch: Callable[[], None]
) -> State:
    """Next accepted state: try the planned span, halve it until it is accepted."""
    span, work = min(state.next_span, stepping.end - state.position), state.stats
    while True:
        solution = _attempt(problem, stepping, state, span, system, watch)
        work = work + solution.stats
        if solution.result is Result.CONVERGED:
            break
        if solution.result is Result.CROSSING_PATH and problem.may_jump and stepping.is_smallest(span):
            break  # each step of the descent was free of collisions
        work = replace(work, rejected=work.rejected + 1)
        if stepping.is_smallest(span):
            time = state.position / stepping.end
            raise SolveError(
                f"Growth stopped at {time:.4%} of the duration: {solution.result.message} "
                f"(residual {solution.residual:.3g} Pa mm, wanted {stepping.criterion.force:.3g}).",
                solution.result.advice,
            )
        span //= 2
    position = state.position + span
    return State(
        index=state.index + 1,
        position=position,
        u=solution.u,
        span=span,
        u_before=state.u,
        next_span=_next_span(position, span),
        couplings=system.couplings,
        residual=solution.residual,
        stats=work,
    )


def _next_span(position: int, span: int) -> int:
    """Twice the span where that keeps to the grid of the nominal increments, at most one of them."""
    doubled = 2 * span
    return doubled if doubled <= TICKS and position % doubled == 0 else span


def _attempt(
    problem: Problem, stepping: Stepping, state: State, span: int, system: System, watch: Callable[[], None]
) -> Solution:
    """One increment, from the better of the last state and its extrapolation."""
    start_fraction, fraction = state.position / stepping.end, (state.position + span) / stepping.end
    total = problem.energy(fraction, state, start_fraction)
    solution = _continued(problem, stepping, total, state, span, system, watch)
    if solution is None:
        guess = _predict(total, state, span, system)
        solution = minimise(
            total,
            guess,
            system,
            stepping.criterion,
            problem.candidates,
            watch,
            problem.shift_mass,
            problem.old_steps,
        )
    if solution.result is Result.CONVERGED and not problem.is_path_admissible(state.u, solution.u):
        return replace(solution, result=Result.CROSSING_PATH)
    return solution


def _continued(
    problem: Problem,
    stepping: Stepping,
    total: TotalEnergy,
    state: State,
    span: int,
    system: System,
    watch: Callable[[], None],
) -> Solution | None:
    """Equilibrium on the extrapolated path, stable or not; None where it is not plainly the same branch."""
    step = (state.u - state.u_before) * (span / state.span)
    size = float(np.abs(step).max())
    if size == 0.0 or not problem.is_path_kept:
        return None
    guess = state.u + total.max_step(state.u, step) * step
    criterion = replace(stepping.criterion, max_iterations=_CONTINUATION_ITERATIONS)
    solution = find_equilibrium(total, guess, system, criterion, problem.candidates, watch)
    if solution.result is Result.CONVERGED and float(np.abs(solution.u - guess).max()) <= size:
        return solution
    return None


def _predict(total: TotalEnergy, state: State, span: int, system: System) -> Iterate:
    """Linear extrapolation as far as it is admissible, if it lowers the energy."""
    step = (state.u - state.u_before) * (span / state.span)
    guess = Iterate.at(total, state.u + total.max_step(state.u, step) * step, system)
    return guess if guess.value < total.value(state.u) else Iterate.at(total, state.u, system)
