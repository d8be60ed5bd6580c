"""Newton's method on problems small enough to solve by hand."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from gyrify.energy.term import Evaluation, Hessian, Pattern
from gyrify.energy.total import FreePattern, TotalEnergy
from gyrify.solve.linear import SuperLU
from gyrify.solve.newton import Criterion, minimise
from gyrify.solve.quasi_newton import QuasiNewton
from gyrify.solve.result import Result
from gyrify.solve.system import System

NONE = np.empty((0, 2), dtype=np.int64)
DIAGONAL = Pattern(np.arange(2), np.arange(2))


class Well:
    """x^4/4 - a x^2/2 + y^2/2 in one point (x, y): minima at x = +-sqrt(a), a saddle at 0."""

    def __init__(self, a: float, limit: float = np.inf) -> None:
        self.a, self.limit = a, limit

    def evaluate(self, u: np.ndarray, order: int, project_psd: bool = False) -> Evaluation:
        x, y = u[0]
        if abs(x) > self.limit:
            return Evaluation(np.inf)
        stiffness = 3 * x**2 - self.a
        if project_psd:
            stiffness = abs(stiffness)
        return Evaluation(
            x**4 / 4 - self.a * x**2 / 2 + y**2 / 2,
            np.array([[x**3 - self.a * x, y]]) if order >= 1 else None,
            Hessian(DIAGONAL, np.array([stiffness, 1.0])) if order >= 2 else None,
        )

    is_barrier = False

    def max_step(self, u: np.ndarray, du: np.ndarray) -> float:  # noqa: ARG002
        return 1.0


def system() -> System:
    return System(np.arange(2), 2, 2, DIAGONAL, SuperLU(), NONE)


def solved(well: Well, x: float, force: float = 1e-12, iterations: int = 50):
    start = np.array([[x, 1.0]])
    return minimise(TotalEnergy([well]), start, system(), Criterion(force, iterations), lambda _: NONE)


@pytest.mark.parametrize(("start", "end"), [(3.0, 2.0), (0.1, 2.0), (-0.1, -2.0)])
def test_newton_finds_the_minimum_on_its_side_of_the_saddle(start: float, end: float) -> None:
    """a = 4: from 0.1 the stiffness is negative and the plain Newton step would run to the saddle at 0."""
    solution = solved(Well(4.0), start)
    assert solution.result is Result.CONVERGED
    assert solution.u == pytest.approx(np.array([[end, 0.0]]), abs=1e-12)
    assert solution.residual <= 1e-12


@pytest.mark.parametrize("mass", [0.1, 10.0])
def test_a_shift_by_the_mass_finds_the_same_minimum(mass: float) -> None:
    """Instead of a projection, the indefinite stiffness -4 + 3 x^2 gets a multiple of the mass added."""
    start = np.array([[0.1, 1.0]])
    masses = np.full(2, mass)
    total, criterion = TotalEnergy([Well(4.0)]), Criterion(1e-12, 50)
    solution = minimise(total, start, system(), criterion, lambda _: NONE, lambda: None, masses)
    assert solution.result is Result.CONVERGED
    assert solution.u == pytest.approx(np.array([[2.0, 0.0]]), abs=1e-12)


@pytest.mark.parametrize("is_barrier", [True, False])
def test_barriers_are_projected_before_anything_is_shifted(is_barrier: bool) -> None:
    """The projection |3 x^2 - 4| = 3.97 at 0.1 gives the step (4 x - x^3) / 3.97 towards the minimum."""
    well, start = Well(4.0), np.array([[0.1, 0.0]])
    well.is_barrier = is_barrier
    criterion = Criterion(1e-12, 1)
    solution = minimise(
        TotalEnergy([well]), start, system(), criterion, lambda _: NONE, lambda: None, np.full(2, 0.1)
    )
    assert solution.stats.factorizations == 2 if is_barrier else solution.stats.factorizations > 2
    assert (solution.u[0, 0] == pytest.approx(0.1 + 0.399 / 3.97, rel=1e-12)) == is_barrier


def test_where_no_new_factor_can_be_made_the_old_one_is_forgotten() -> None:
    """It has been overwritten: a later minimisation must not take it."""

    class Flat(Well):
        def evaluate(self, u, order, project_psd=False):
            found = super().evaluate(u, order, project_psd)
            return replace(found, hessian=Hessian(DIAGONAL, np.zeros(2))) if order >= 2 else found

    model, shared, criterion = QuasiNewton(), system(), Criterion(1e-3, 50)
    near, far, mass = np.array([[2.001, 0.0]]), np.array([[9.0, 0.0]]), np.ones(2)
    minimise(TotalEnergy([Well(4.0)]), near, shared, criterion, lambda _: NONE, lambda: None, mass, model)
    assert model.factor is not None
    model.carry()
    total = TotalEnergy([Flat(4.0)])
    lost = minimise(total, far, shared, criterion, lambda _: NONE, lambda: None, mass, model)
    assert lost.result is Result.SINGULAR
    assert model.factor is None


def test_convergence_is_quadratic() -> None:
    """From 3 in the well of a = 4, by hand: x - (x^3 - 4 x) / (3 x^2 - 4), until an old factor does."""
    expected, x = [], 3.0
    for _ in range(3):
        x -= (x**3 - 4 * x) / (3 * x**2 - 4)
        expected.append(x)
    found = [solved(Well(4.0), 3.0, iterations=n).u[0, 0] for n in (1, 2, 3)]
    assert found == pytest.approx(expected, rel=1e-13)
    errors = [abs(x - 2.0) for x in found]
    assert all(after < 1.5 * before**2 for before, after in pairwise(errors))


def test_late_steps_use_the_old_factor_and_its_secants() -> None:
    """Fewer factorisations than iterations, and the same minimum; plain Newton needs one for each."""
    end = solved(Well(4.0), 3.0)
    assert end.result is Result.CONVERGED
    assert end.u[0, 0] == pytest.approx(2.0, abs=1e-12)
    assert end.stats.factorizations < end.stats.newton_iterations <= 8


def test_direction_is_that_of_the_dense_update(rng: np.random.Generator) -> None:
    """H <- (I - rho s y^T) H (I - rho y s^T) + rho s s^T, from the identity, for two pairs."""
    solver = SuperLU()
    solver.analyse(np.arange(5), np.arange(4))
    model, H = QuasiNewton(), np.eye(4)
    model.renew(solver.factorise(np.ones(4)))
    for _ in range(2):
        s = rng.standard_normal(4)
        y = 2.0 * s + 0.3 * rng.standard_normal(4)
        model.learn(s, y, 0.5)
        shear = np.eye(4) - np.outer(s, y) / (s @ y)
        H = shear @ H @ shear.T + np.outer(s, s) / (s @ y)
    gradient = rng.standard_normal(4)
    assert model.direction(gradient) == pytest.approx(-H @ gradient)


def test_secant_pairs_make_the_direction_exact_for_what_they_saw() -> None:
    """The factor is the identity, the Hessian diag(4, 1): after a step along x the direction is Newton's."""
    solver = SuperLU()
    solver.analyse(np.array([0, 1, 2]), np.array([0, 1]))
    model = QuasiNewton()
    model.renew(solver.factorise(np.ones(2)))
    gradient = np.array([8.0, 3.0])
    assert model.direction(gradient) == pytest.approx([-8.0, -3.0])
    model.learn(np.array([0.5, 0.0]), np.array([2.0, 0.0]), 0.5)
    assert model.direction(gradient) == pytest.approx([-2.0, -3.0])
    model.learn(np.array([0.0, 1.0]), np.array([0.0, -1.0]), 0.5)  # negative curvature is not taken in
    assert model.direction(gradient) == pytest.approx([-2.0, -3.0])
    assert model.serves(256.0, 1.0)
    assert not model.serves(257.0, 1.0)
    model.renew(None)
    assert not model.serves(1e-3, 1.0)
    with pytest.raises(RuntimeError, match="no factor"):
        model.direction(gradient)


def test_the_iteration_cap_is_a_failure_and_never_an_acceptance() -> None:
    solution = solved(Well(4.0), 3.0, iterations=2)
    assert solution.result is Result.MAX_NEWTON
    assert solution.residual > 1e-3
    assert solution.stats.newton_iterations == 2
    assert solution.result.advice


def test_the_last_allowed_iteration_may_converge() -> None:
    needed = solved(Well(4.0), 3.0).stats.newton_iterations
    assert solved(Well(4.0), 3.0, iterations=needed).result is Result.CONVERGED
    assert solved(Well(4.0), 3.0, iterations=needed - 1).result is Result.MAX_NEWTON


def test_the_line_search_never_enters_infinite_energy() -> None:
    """Beyond |x| = 2.2 nothing exists; the projected step from 0.9 (stiffness 1.57) would land near 2.7."""
    step = (4 * 0.9 - 0.9**3) / abs(3 * 0.81 - 4)
    assert 0.9 + step > 2.2
    solution = solved(Well(4.0, limit=2.2), 0.9)
    assert solution.result is Result.CONVERGED
    assert solution.u[0, 0] == pytest.approx(2.0, abs=1e-12)


def test_an_inadmissible_start_is_named() -> None:
    assert solved(Well(4.0, limit=2.2), 3.0).result is Result.INADMISSIBLE


def test_no_room_for_a_step_is_named() -> None:
    well = Well(4.0)
    well.max_step = lambda u, du: 0.0  # noqa: ARG005
    assert solved(well, 3.0).result is Result.INVERTING
    well.is_barrier = True
    assert solved(well, 3.0).result is Result.BLOCKED


def test_an_energy_that_nothing_lowers_is_named() -> None:
    class Lie(Well):
        """Its gradient points the wrong way."""

        def evaluate(self, u, order, project_psd=False):
            right = super().evaluate(u, order, project_psd)
            return Evaluation(right.value, -right.gradient if order >= 1 else None, right.hessian)

    assert solved(Lie(4.0), 3.0).result is Result.LINE_SEARCH


def test_every_result_says_what_happened_and_what_to_try() -> None:
    for result in Result:
        assert result.message
        assert bool(result.advice) == (result is not Result.CONVERGED)


def test_total_energy_and_pattern_keep_free_entries_only() -> None:
    """Three unknowns, the middle one held: of (0,0) (0,1) (0,2) (2,2) three remain, and (1,1) none."""
    free = np.array([0, 2])
    rows, cols = np.array([0, 0, 0, 2]), np.array([0, 1, 2, 2])
    pattern = FreePattern(free, 3, rows, cols)
    assert pattern.rows.tolist() == [0, 0, 1]
    assert pattern.cols.tolist() == [0, 1, 1]
    data = np.zeros(3)
    pattern.add(Pattern(rows, cols), np.array([1.0, 2.0, 3.0, 4.0]), data)
    assert data.tolist() == [1.0, 3.0, 4.0]
    assert not FreePattern(free, 3, np.array([0]), np.array([0])).holds(Pattern(rows, cols))


def test_total_energy_is_the_sum_and_the_smallest_step() -> None:
    one, other = Well(4.0), Well(1.0)
    one.max_step, other.max_step = (lambda u, du: 0.5), (lambda u, du: min(1.0, 0.1 / np.abs(du).max()))  # noqa: ARG005
    total, u = TotalEnergy([one, other]), np.array([[3.0, 1.0]])
    assert total.value(u) == pytest.approx(one.evaluate(u, 0).value + other.evaluate(u, 0).value)
    gradient = sum(e.gradient for e in total.evaluate(u, project_psd=False))
    assert gradient == pytest.approx(np.array([[2 * 27.0 - 5 * 3.0, 2.0]]))
    # the first allows half of du = 2, the second 0.1 of length
    assert total.max_step(u, np.array([[2.0, 0.0]])) == pytest.approx(0.05)
    assert TotalEnergy([Well(4.0, limit=1.0), other]).value(u) == np.inf
