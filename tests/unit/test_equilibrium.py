"""Newton's method on the residual: which steps it accepts, and how it says that it has found nothing."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from made_up_energy import MadeUp
from test_newton import NONE, Well, system

from gyrify.energy.total import TotalEnergy
from gyrify.solve.equilibrium import find_equilibrium
from gyrify.solve.newton import Criterion
from gyrify.solve.result import Result, Solution

# A step must lower the residual by this share of itself.
SHARE = 1e-4


def found(energy, x: float = 0.0, *, force: float = 1e-12, iterations: int = 1) -> Solution:
    start, criterion = np.array([[x, 0.0]]), Criterion(force, iterations)
    return find_equilibrium(TotalEnergy([energy]), start, system(), criterion, lambda _: NONE)


def step_taken(forces: dict[float, float], largest: float = 1.0) -> float:
    """Where the first step from 0 ends, of slopes at 1, 1/2, ...; at 0 it is -1, and foretells 0 at 1."""
    energy = MadeUp(lambda _: 0.0, ({0.0: -1.0} | forces).__getitem__, largest=largest)
    return float(found(energy).u[0, 0])


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(
    ("force", "is_enough"),
    [(0.0, True), (0.5, True), (1.0 - 2.0 * SHARE, True), (1.0 - 0.99 * SHARE, False), (1.0, False),
     (1.0 + 0.99 * SHARE, False), (2.0, False)],
)  # fmt: skip
def test_a_step_must_lower_the_residual_by_a_share_of_itself(
    force: float, is_enough: bool, sign: float
) -> None:
    assert step_taken({1.0: sign * force, 0.5: -0.5}) == (1.0 if is_enough else 0.5)


def test_a_shorter_step_must_bring_its_own_share() -> None:
    before = {1.0: 1.0, 0.5: 1.0}
    assert step_taken({**before, 0.25: 1.0 - 0.26 * SHARE, 0.125: 0.0}) == 0.25
    assert step_taken({**before, 0.25: 1.0 - 0.24 * SHARE, 0.125: 0.0}) == 0.125


@pytest.mark.parametrize("largest", [0.75, 1e-6])
def test_the_first_step_is_the_largest_admissible_one(largest: float) -> None:
    assert step_taken({largest: 0.5}, largest) == largest
    assert step_taken({largest: 2.0, 0.5 * largest: 0.5}, largest) == 0.5 * largest


def test_a_state_of_infinite_energy_is_never_taken_though_no_force_is_known_there() -> None:
    energy = MadeUp(lambda x: np.inf if x > 0.7 else 0.0, lambda x: x - 1.0)
    assert found(energy).u[0, 0] == 0.5


@pytest.mark.parametrize("seed", range(10))
def test_every_accepted_step_is_the_first_of_its_halvings_that_falls_enough(seed: int) -> None:
    rng = np.random.default_rng(seed)
    k, start = rng.uniform(2.0, 4.0), rng.uniform(1.0, 3.0)
    # the residual of arctan overshoots ever further without damping
    energy = MadeUp(lambda _: 0.0, lambda x: np.arctan(k * x), lambda x: k / (1.0 + (k * x) ** 2))
    solution = found(energy, start, iterations=40)
    assert solution.result is Result.CONVERGED
    path = [*energy.accepted, float(solution.u[0, 0])]
    for x, after in pairwise(path):
        whole, size = -energy.slope(x) / energy.stiffness(x), abs(energy.slope(x))
        halvings = round(np.log2(whole / (after - x)))
        for number in range(halvings + 1):
            residual = abs(energy.slope(x + 0.5**number * whole))
            assert (residual <= (1.0 - SHARE * 0.5**number) * size) == (number == halvings)
    assert any(abs(after - x) < abs(energy.slope(x) / energy.stiffness(x)) for x, after in pairwise(path))


def test_an_unstable_equilibrium_is_found_with_the_exact_stiffness() -> None:
    """The well's saddle at 0, where a minimisation would leave: projected, steps would lead away."""
    solution = found(Well(4.0), 0.3, iterations=8)
    assert solution.result is Result.CONVERGED
    assert abs(solution.u[0, 0]) < 1e-12


def test_a_residual_at_the_tolerance_has_converged_and_one_above_it_has_not() -> None:
    energy = MadeUp(lambda _: 0.0, lambda _: -0.3)
    assert found(energy, force=0.3).result is Result.CONVERGED
    assert found(energy, force=np.nextafter(0.3, 0.0)).result is not Result.CONVERGED


@pytest.mark.parametrize("iterations", [1, 2, 3])
def test_the_iteration_cap_is_a_failure_and_never_an_acceptance(iterations: int) -> None:
    solution = found(Well(4.0), 3.0, iterations=iterations)
    assert solution.result is Result.MAX_NEWTON
    assert solution.stats.newton_iterations == iterations
    assert solution.residual > 1e-3


def test_a_residual_that_nothing_lowers_is_named() -> None:
    solution = found(MadeUp(lambda _: 0.0, lambda x: -1.0 - abs(x)), iterations=5)
    assert solution.result is Result.LINE_SEARCH
    assert solution.u[0, 0] == 0.0


def test_a_singular_stiffness_is_named() -> None:
    assert found(MadeUp(lambda _: 0.0, lambda _: -1.0, lambda _: 0.0)).result is Result.SINGULAR


def test_an_inadmissible_start_is_named() -> None:
    solution = found(Well(4.0, limit=2.2), 3.0)
    assert (solution.result, solution.residual) == (Result.INADMISSIBLE, np.inf)
