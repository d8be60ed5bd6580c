"""Quasi-static growth: increments that are accepted, or rejected and halved."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from gyrify.errors import InvertedCellError, SolveError
from gyrify.solve.increment import Increments, is_factor_kept
from gyrify.solve.path import Path
from gyrify.solve.problem import TICKS, Problem, State, Stepping
from gyrify.solve.result import Result, Stats


def grow(
    problem: Problem,
    stepping: Stepping,
    state: State,
    watch: Callable[[], None] = lambda: None,
    inspect: Callable[[State, State], State] = lambda _, accepted: accepted,
    recall: Callable[[int], State] | None = None,
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
    recall : callable, optional
        Gives an accepted state before ``state`` by its number; without it, only the reference state can be
        gone on from.

    Yields
    ------
    State

    Raises
    ------
    SolveError
        If an increment fails at the smallest size; the message names the reason.
    InvertedCellError
        The same, where a cell that is inverted, or would be, is the reason.
    """
    increments = _taken_up(problem, stepping, state, recall or _nothing_before, watch)
    if state.index == 0:
        state = replace(state, stats=state.stats + Stats(analyses=increments.system.analyses))
    while state.position < stepping.end:
        accepted = _advance(increments, state)
        work = accepted.stats - state.stats
        state = problem.evolved(state, inspect(state, accepted))
        increments.accept(state, work)
        yield state


def _taken_up(
    problem: Problem,
    stepping: Stepping,
    state: State,
    recall: Callable[[int], State],
    watch: Callable[[], None],
) -> Increments:
    """Increments as they were when a state had just been accepted, the carried factor included."""
    system = problem.increment_system(state.couplings)
    after = state
    while after.index > 0 and problem.old_steps > 0:
        before = recall(after.index - 1)
        work = after.stats - before.stats
        if not is_factor_kept(work):
            break
        if work.factorizations > 0:
            maker = Increments(problem, stepping, system, Path(before, recall), watch)
            maker.rebuild_factor(before, after.span)
            maker.path = Path(state, recall)
            return maker
        after = before
    return Increments(problem, stepping, system, Path(state, recall), watch)


def _nothing_before(index: int) -> State:
    raise ValueError(f"state {index} is needed to go on as if growth had never stopped: give `recall`")


def _advance(increments: Increments, state: State) -> State:
    """Next accepted state: try the planned span, halve it until it is accepted."""
    problem, stepping = increments.problem, increments.stepping
    span, work = min(state.next_span, stepping.end - state.position), state.stats
    while True:
        solution = increments.attempt(state, span)
        work = work + solution.stats
        if solution.result is Result.CONVERGED:
            break
        if solution.result is Result.CROSSING_PATH and problem.may_jump and stepping.is_smallest(span):
            break  # each step of the descent was free of collisions
        work = replace(work, rejected=work.rejected + 1)
        if stepping.is_smallest(span):
            time = state.position / stepping.end
            failure = InvertedCellError if solution.result.is_inversion else SolveError
            raise failure(
                f"Growth stopped at {time:.4%} of the duration: {solution.result.message} "
                f"(residual {solution.residual:.3g} {stepping.force_unit}, "
                f"wanted {stepping.criterion.force:.3g}).",
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
        couplings=increments.system.couplings,
        residual=solution.residual,
        stats=work,
    )


def _next_span(position: int, span: int) -> int:
    """Twice the span where that keeps to the grid of the nominal increments, at most one of them."""
    doubled = 2 * span
    return doubled if doubled <= TICKS and position % doubled == 0 else span
