"""Which increments are accepted, from where each is begun, and what is refused however small it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from made_up_energy import MadeUp
from test_growth import Pull, states
from test_newton import DIAGONAL, NONE, system

from gyrify.energy.term import Evaluation, Hessian
from gyrify.energy.total import TotalEnergy
from gyrify.errors import SolveError
from gyrify.solve.increment import Increments, is_factor_kept
from gyrify.solve.newton import Criterion
from gyrify.solve.path import Path
from gyrify.solve.problem import TICKS, State, Stepping
from gyrify.solve.quasistatic import grow
from gyrify.solve.result import Result, Solution, Stats


class Fork:
    """A double well x^4/4 - 2 x^2 across, and |y - goal|^p / p along; nothing exists beyond y = ``end``."""

    is_barrier = False

    def __init__(self, goal: float, power: int, end: float) -> None:
        self.goal, self.power, self.end = goal, power, end

    def evaluate(self, u: np.ndarray, order: int, project_psd: bool = False) -> Evaluation:
        (x, y), p = u[0], self.power
        if y > self.end:
            return Evaluation(np.inf)
        across = 3 * x**2 - 4.0
        arm = y - self.goal
        stiffness = np.array([abs(across) if project_psd else across, (p - 1) * arm ** (p - 2)])
        return Evaluation(
            x**4 / 4 - 2.0 * x**2 + arm**p / p,
            np.array([[x**3 - 4.0 * x, arm ** (p - 1)]]) if order >= 1 else None,
            Hessian(DIAGONAL, stiffness) if order >= 2 else None,
        )

    def max_step(self, u: np.ndarray, du: np.ndarray) -> float:
        room, ahead = 0.9 * (self.end - u[0, 1]), du[0, 1]
        return min(1.0, room / ahead) if ahead > 0.0 else 1.0


@dataclass
class Forked(Pull):
    """An increment from (0.1, 0) that came from (0.1, -1): x leads to the saddle 0, or away from it to 2."""

    goal: float = 1.0
    power: int = 2
    end: float = np.inf
    is_path_kept: bool = True

    def energy(self, fraction: float, start: State, start_fraction: float) -> TotalEnergy:  # noqa: ARG002
        return TotalEnergy([Fork(self.goal, self.power, self.end)])


def taken(problem: Forked, span: int = TICKS, force: float = 1e-9) -> Solution:
    now, before = np.array([[0.1, 0.0]]), np.array([[0.1, -1.0]])
    state = State(1, TICKS, now, TICKS, before, TICKS, NONE, 0.0, Stats())
    stepping = Stepping(10, 1e-6, Criterion(force, 200))
    path = Path(state, lambda _: State.reference(1, 2))
    return Increments(problem, stepping, system(), path).attempt(state, span)


def is_kept(solution: Solution) -> bool:
    """Whether the end is the saddle, and no minimum."""
    assert solution.result is Result.CONVERGED
    x = abs(float(solution.u[0, 0]))
    assert min(x, abs(x - 2.0)) < 1e-6
    return x < 1e-6


@pytest.mark.parametrize(("correction", "kept"), [(0.99, True), (1.01, False), (50.0, False)])
def test_a_path_is_kept_while_its_correction_is_no_longer_than_its_step(
    correction: float, kept: bool
) -> None:
    """The step foretells y = 1; an equilibrium further from there than the step is long is another branch."""
    assert is_kept(taken(Forked(goal=1.0 + correction))) is kept
    assert is_kept(taken(Forked(goal=1.0 - correction))) is kept


def test_the_step_foretold_is_as_long_as_the_span() -> None:
    """Half of a span foretells y = 1/2, and allows a correction of 1/2."""
    assert is_kept(taken(Forked(goal=0.99), TICKS // 2))
    assert not is_kept(taken(Forked(goal=1.01), TICKS // 2))


def test_a_path_is_not_kept_unless_asked_for_or_without_a_step_to_foretell_it() -> None:
    assert not is_kept(taken(Forked(is_path_kept=False)))


@pytest.mark.parametrize(("force", "kept"), [(1e-3, True), (1e-9, False)])
def test_a_path_is_kept_only_where_newtons_method_takes_few_iterations(force: float, kept: bool) -> None:
    """A fourth power lets each iteration take a third of the way: 4 of them, or 17, for these tolerances."""
    assert is_kept(taken(Forked(goal=1.5, power=4), force=force)) is kept


def test_a_path_is_foretold_no_further_than_what_is_admissible() -> None:
    """Nothing exists beyond y = 0.8: the step of 1 is cut there, and the goal lies just before."""
    assert is_kept(taken(Forked(goal=0.7, end=0.8)))


@pytest.mark.parametrize(
    ("at_guess", "at_state", "admissible", "start"),
    [(-1.0, 0.0, 1.0, 4.0), (1.0, 0.0, 1.0, 2.0), (0.0, 0.0, 1.0, 2.0), (-1.0, 0.0, 0.5, 3.0)],
)
def test_an_increment_begins_at_the_extrapolation_only_if_that_lowers_the_energy(
    at_guess: float, at_state: float, admissible: float, start: float
) -> None:
    """From x = 2, a step of 2 after the reference state."""

    class Table(Pull):
        def energy(self, fraction, start, start_fraction):  # noqa: ARG002
            values = {2.0: at_state, 2.0 + 2.0 * admissible: at_guess}
            return TotalEnergy([MadeUp(values.__getitem__, lambda _: 1.0, largest=admissible)])

    state = State(1, TICKS, np.array([[2.0, 0.0]]), TICKS, np.zeros((1, 2)), TICKS, NONE, 0.0, Stats())
    path, stepping = Path(state, lambda _: State.reference(1, 2)), Stepping(4, 1e-6, Criterion(1e-9, 0))
    solution = Increments(Table(), stepping, system(), path).attempt(state, TICKS)
    assert solution.result is Result.MAX_NEWTON
    assert solution.u[0, 0] == start


def test_dissipation_counts_from_the_start_of_the_increment() -> None:
    asked = []

    class Noted(Pull):
        def energy(self, fraction, start, start_fraction):
            asked.append((start.position, start_fraction, fraction))
            return super().energy(fraction, start, start_fraction)

    states(Noted())
    assert asked == [(k * TICKS, k / 4, (k + 1) / 4) for k in range(4)]


@pytest.mark.parametrize("may_jump", [True, False])
@pytest.mark.parametrize("longest", [np.inf, 1e-9])
def test_an_increment_that_has_not_converged_is_refused_at_every_size(may_jump: bool, longest: float) -> None:
    """The iteration cap is no acceptance, nor is a jump a way around it; the reason given is the solve's."""
    problem = Pull(may_jump=may_jump, longest=longest, stiffens=50.0)
    stepping = Stepping(4, 0.05, Criterion(1e-9, 1))
    with pytest.raises(SolveError, match=r"max_newton.* wanted 1e-09"):
        list(grow(problem, stepping, State.reference(1, 2)))
    with pytest.raises(SolveError, match="inverted"):
        states(Pull(may_jump=may_jump, refuses_after=0.1), smallest=0.05)


@pytest.mark.parametrize("stiffens", [0.0, 5.0])
def test_every_accepted_state_is_in_balance_to_the_tolerance(stiffens: float) -> None:
    problem, stepping = Pull(stiffens=stiffens, wobble=1.0), Stepping(8, 1e-6, Criterion(1e-5, 6))
    for state in grow(problem, stepping, State.reference(1, 2)):
        energy = problem.energy(state.position / stepping.end, state, 0.0)
        force = float(np.linalg.norm(energy.slope(state.u)[1]))
        assert force == pytest.approx(state.residual, abs=1e-12)
        assert force <= 1e-5


def test_a_jump_is_accepted_at_the_smallest_increment_alone() -> None:
    """Of paths that cross; without leave to jump there is none."""
    found = states(Pull(longest=0.2, may_jump=True), smallest=1 / 16)
    assert [state.span for state in found] == [TICKS // 4] * 16
    assert [state.stats.rejected for state in found[:2]] == [2, 2]
    with pytest.raises(SolveError, match="straight path"):
        states(Pull(longest=0.2), smallest=1 / 16)


@pytest.mark.parametrize(
    ("smallest", "span", "is_smallest"),
    [(1 / 16, TICKS // 2, False), (1 / 16, TICKS // 4, True), (1 / 12, TICKS // 2, True),
     (1e-12, 2, False), (1e-12, 1, True)],
)  # fmt: skip
def test_no_increment_below_the_smallest_is_tried(smallest: float, span: int, is_smallest: bool) -> None:
    """Of four nominal increments: 1/16 of the whole is a quarter of one; half a tick does not exist."""
    assert Stepping(4, smallest, Criterion(1e-9, 1)).is_smallest(span) is is_smallest


def test_growth_ends_at_its_end_though_the_next_increment_would_lead_further() -> None:
    stepping, start = Stepping(4, 1e-6, Criterion(1e-9, 20)), State.reference(1, 2)
    late = State(5, 4 * TICKS - TICKS // 4, start.u, TICKS // 4, start.u, TICKS, NONE, 0.0, Stats())
    found = list(grow(Pull(), stepping, late, recall=lambda _: start))
    assert [state.position for state in found] == [stepping.end]


def test_a_factor_is_kept_only_from_where_it_can_be_made_again() -> None:
    assert is_factor_kept(Stats(newton_iterations=1))
    assert is_factor_kept(Stats())
    assert not is_factor_kept(Stats(newton_iterations=2))
    assert not is_factor_kept(Stats(newton_iterations=1, rejected=1))


def test_four_states_foretell_the_next_one_and_no_more() -> None:
    """Of a fourth power a cubic is continued: of more states, more noise would be."""
    t = np.arange(7.0)
    known = [
        State(k, k * TICKS, np.array([[k**4, 0.0]]), TICKS, np.zeros((1, 2)), TICKS, NONE, 0.0, Stats())
        for k in range(7)
    ]
    cubic = np.polynomial.Polynomial.fit(t[3:], t[3:] ** 4, 3)
    foretold = Path(known[-1], known.__getitem__).extrapolated(7 * TICKS)
    assert foretold[0, 0] == pytest.approx(cubic(7.0), rel=1e-9)
