"""Which steps the line search of the minimisation accepts, and which states are taken for converged."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from made_up_energy import MadeUp, blind_system, minimised
from test_newton import DIAGONAL, NONE, Well, solved, system

from gyrify.solve.linear import SuperLU
from gyrify.solve.quasi_newton import QuasiNewton
from gyrify.solve.result import Result
from gyrify.solve.system import System

# A step must bring this share of the decrease that the slope foretells (Armijo), up to rounding.
SHARE, ROUNDING = 1e-4, 1e-14


def step_taken(values: dict[float, float], *, slope: float = -1.0, largest: float = 1.0) -> float:
    """Where the first step from 0 ends, of energies at 1, 1/2, ...; the slope foretells a fall of 1 at 1."""
    energy = MadeUp(
        values.__getitem__, lambda x: slope if x == 0.0 else 0.0, lambda _: abs(slope), largest=largest
    )
    solution = minimised(energy, force=0.0)
    assert solution.stats.newton_iterations == 1
    return float(solution.u[0, 0])


@pytest.mark.parametrize(
    ("fall", "is_enough"),
    [(0.5, True), (2.0 * SHARE, True), (1.01 * SHARE, True), (0.99 * SHARE, False), (0.01 * SHARE, False),
     (0.0, False), (-0.99 * SHARE, False), (-1.0, False)],
)  # fmt: skip
def test_a_step_must_lower_the_energy_by_a_share_of_what_the_slope_foretells(
    fall: float, is_enough: bool
) -> None:
    """That it goes down is not enough."""
    assert step_taken({0.0: 0.0, 1.0: -fall, 0.5: -0.25}) == (1.0 if is_enough else 0.5)


@pytest.mark.parametrize(("fall", "is_enough"), [(0.26 * SHARE, True), (0.24 * SHARE, False)])
def test_a_shorter_step_must_bring_its_own_share(fall: float, is_enough: bool) -> None:
    values = {0.0: 0.0, 1.0: 1.0, 0.5: 1.0, 0.25: -fall, 0.125: -0.1}
    assert step_taken(values) == (0.25 if is_enough else 0.125)


@pytest.mark.parametrize("energy", [1e4, -1e4])
@pytest.mark.parametrize(("rise", "is_rounding"), [(0.5, True), (2.0, False), (100.0, False)])
def test_what_rounding_hides_is_no_rise(energy: float, rise: float, is_rounding: bool) -> None:
    values = {0.0: energy, 1.0: energy + rise * ROUNDING * abs(energy), 0.5: energy - 1.0}
    assert step_taken(values, slope=-1e-9) == (1.0 if is_rounding else 0.5)


def test_steps_are_halved_until_a_billionth() -> None:
    small = 2.0**-29
    values = {0.0: 0.0, **{2.0**-k: 1.0 for k in range(29)}, small: -small}
    assert step_taken(values) == small
    assert step_taken({0.0: 0.0, **{2.0**-k: 1.0 for k in range(30)}}) == 0.0


@pytest.mark.parametrize("largest", [0.75, 1e-6])
def test_the_first_step_is_the_largest_admissible_one(largest: float) -> None:
    assert step_taken({0.0: 0.0, largest: -largest}, largest=largest) == largest
    assert step_taken({0.0: 0.0, largest: 1.0, 0.5 * largest: -largest}, largest=largest) == 0.5 * largest


def test_less_room_than_a_billionth_of_a_step_is_none() -> None:
    blocked = minimised(MadeUp(lambda x: -x, lambda _: -1.0, largest=0.9e-9))
    assert blocked.result in (Result.BLOCKED, Result.INVERTING)
    assert blocked.u[0, 0] == 0.0


def wavy(rng: np.random.Generator) -> MadeUp:
    """a x^2 + b sin(k x + c), its stiffness made positive, as a projection does."""
    a, b, k, c = rng.uniform([0.5, 0.0, 1.0, 0.0], [2.0, 3.0, 9.0, 6.0])
    return MadeUp(
        lambda x: a * x**2 + b * np.sin(k * x + c),
        lambda x: 2.0 * a * x + b * k * np.cos(k * x + c),
        lambda x: abs(2.0 * a - b * k**2 * np.sin(k * x + c)) + 1e-3,
    )


def test_every_accepted_step_is_the_first_of_its_halvings_that_falls_enough(rng: np.random.Generator) -> None:
    """By the energy where each step leads, and where those led that come before it in the sequence."""
    shortened = 0
    for _ in range(20):
        energy = wavy(rng)
        solution = minimised(energy, 3.0, iterations=60, force=1e-9)
        assert solution.result is Result.CONVERGED
        for x, after in pairwise([*energy.accepted, float(solution.u[0, 0])]):
            whole = -energy.slope(x) / energy.stiffness(x)
            halvings = round(np.log2(whole / (after - x)))
            for number in range(halvings + 1):
                step = 0.5**number * whole
                bound = energy.value(x) + SHARE * energy.slope(x) * step + ROUNDING * abs(energy.value(x))
                assert (energy.value(x + step) <= bound) == (number == halvings)
            shortened += halvings > 0
    assert shortened >= 5


@pytest.mark.parametrize("side", [0.0, 1.0])
def test_a_direction_that_does_not_lead_down_is_never_taken(side: float) -> None:
    """A negative pivot was overlooked: the slope is positive (side 0) or zero; the energy would allow it."""

    class Uphill(MadeUp):
        def evaluate(self, u, order, project_psd=False):
            found = super().evaluate(u, order, project_psd)
            if order >= 1:
                found.gradient[0, 1] = side
            return found

    energy = Uphill(lambda _: 0.0, lambda _: -1.0, lambda _: -1.0)
    solution = minimised(energy, shared=blind_system())
    assert solution.result is Result.LINE_SEARCH
    assert not solution.u.any()


def test_a_residual_at_the_tolerance_has_converged_and_one_above_it_has_not() -> None:
    energy = MadeUp(lambda x: -x, lambda _: -0.3)
    assert minimised(energy, force=0.3, iterations=0).result is Result.CONVERGED
    assert minimised(energy, force=0.3, iterations=9).stats.newton_iterations == 0
    above = minimised(energy, force=np.nextafter(0.3, 0.0), iterations=0)
    assert (above.result, above.residual) == (Result.MAX_NEWTON, 0.3)


def test_the_residual_is_the_largest_norm_of_the_force_on_a_free_point() -> None:
    """Forces (0, 1), (3, -4) and, on a held point, (9, 9); of the last point one direction is free."""
    points = System(np.array([0, 1, 2, 3, 6]), 8, 2, DIAGONAL, SuperLU(), NONE)
    forces = np.array([[0.0, 1.0], [3.0, -4.0], [9.0, 9.0], [4.5, 9.0]])
    assert points.largest_force(forces) == 5.0
    forces[3, 0] = -5.5
    assert points.largest_force(forces) == 5.5


def test_an_inadmissible_state_is_in_no_balance() -> None:
    assert solved(Well(4.0, limit=2.2), 3.0).residual == np.inf


def test_the_model_learns_the_step_that_was_taken() -> None:
    """The secant equation: its inverse Hessian gives the step for the change of gradient, though halved."""
    energy = MadeUp({0.0: 0.0, 1.0: 1.0, 0.5: -0.2}.__getitem__, lambda x: -1.0 + 1.8 * x)
    model = QuasiNewton()
    assert minimised(energy, model=model).u[0, 0] == 0.5
    assert model.direction(np.array([0.9, 0.0])) == pytest.approx([-0.5, 0.0])
    # from 1 to 0.1, but a shortened step foretells nothing of the next one
    assert model.contraction == 1.0
    whole = QuasiNewton()
    minimised(MadeUp(lambda x: -x, lambda x: -1.0 + 0.75 * x), model=whole)
    assert whole.contraction == 0.25


def test_where_an_old_factor_fails_a_new_one_is_made() -> None:
    """The old one belongs to a negative stiffness: its direction leads uphill."""
    shared, model = system(), QuasiNewton()
    model.renew(shared.factorise_data(np.array([-1.0, 1.0])))
    model.carry()
    energy = MadeUp(lambda x: 0.5 * (x - 1.0) ** 2, lambda x: x - 1.0)
    solution = minimised(energy, force=0.05, iterations=5, shared=shared, model=model)
    assert (solution.result, solution.u[0, 0]) == (Result.CONVERGED, 1.0)
    assert solution.stats.newton_iterations == 2


def test_what_a_model_forgets_with_a_new_factor_and_when_it_is_carried_on() -> None:
    solver = SuperLU()
    solver.analyse(np.arange(3), np.arange(2))
    model = QuasiNewton()
    model.renew(solver.factorise(np.ones(2)))
    model.learn(np.array([1.0, 0.0]), np.array([4.0, 0.0]), 0.1)
    assert model.direction(np.array([4.0, 0.0])) == pytest.approx([-1.0, 0.0])
    model.carry()
    assert model.direction(np.array([4.0, 0.0])) == pytest.approx([-4.0, 0.0])
    # eight steps with a contraction of 0.55 each
    assert model.serves(119.0, 1.0)
    assert not model.serves(120.0, 1.0)
    model.renew(model.factor)
    assert model.contraction == 1.0
