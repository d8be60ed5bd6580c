"""Factors that are made definite: by the least shift of a sequence, which the next step takes up."""

from __future__ import annotations

import numpy as np
import pytest
from made_up_energy import MadeUp
from test_linear import available
from test_newton import DIAGONAL, NONE, system

from gyrify.energy.term import Evaluation, Hessian
from gyrify.energy.total import TotalEnergy
from gyrify.errors import SolveError
from gyrify.solve.definite import PATIENCE, DefiniteHessian
from gyrify.solve.linear import SuperLU, linear_solver
from gyrify.solve.shift import shifted_factor
from gyrify.solve.stability import Tangent
from gyrify.solve.system import System

STIFFNESS, MASS = np.array([-3.0, 10.0]), np.array([1.0, 2.0])
# A hundred-thousandth of the largest entry of M^-1 K, which is 5.
FIRST = 5e-5


@pytest.mark.parametrize(("growth", "tau"), [(2.0, FIRST * 2**16), (4.0, FIRST * 4**8), (10.0, FIRST * 1e5)])
def test_the_shift_is_the_first_of_its_sequence_that_is_enough(growth: float, tau: float) -> None:
    """K + tau M of K = diag(-3, 10), M = diag(1, 2) is definite from tau = 3 on."""
    found = shifted_factor(system(), STIFFNESS, MASS, growth=growth)
    assert found.tau == pytest.approx(tau, rel=1e-12)
    assert found.tau > 3.0 >= found.tau / growth
    assert found.factor.n_negative == 0


def test_the_factor_is_that_of_the_shift_it_is_given_with() -> None:
    data = STIFFNESS.copy()
    found = shifted_factor(system(), data, MASS)
    right = np.array([7.0, -5.0])
    assert found.factor.solve(right) == pytest.approx(right / (STIFFNESS + found.tau * MASS))
    np.testing.assert_array_equal(data, STIFFNESS)


@pytest.mark.parametrize(("least", "tau"), [(3.5, 3.5), (1.0, 4.0), (1e-9, FIRST * 2**16)])
def test_a_shift_known_to_be_needed_is_where_the_sequence_begins(least: float, tau: float) -> None:
    assert shifted_factor(system(), STIFFNESS, MASS, least).tau == pytest.approx(tau)


def test_a_stiffness_that_is_negative_throughout_is_shifted_too() -> None:
    """The sequence begins at a share of the largest entry whatever its sign, and not at zero for good."""
    found = shifted_factor(system(), np.array([-4.0, -1.0]), np.ones(2))
    assert found.tau == pytest.approx(4e-5 * 2**17)


@pytest.mark.parametrize("solver", available())
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_stiffness_that_is_no_number_is_neither_stable_nor_shifted(solver: str, value: float) -> None:
    """A NaN is no negative pivot."""
    shared = System(np.arange(2), 2, 2, DIAGONAL, linear_solver(solver), NONE)
    data = np.array([value, 1.0])
    for factorised in (shared.factorise_data, shared.factorise_definite):
        with pytest.raises(SolveError, match="not finite"):
            factorised(data)
    with pytest.raises(SolveError, match="not finite"):
        shifted_factor(shared, data, MASS)


class Saddle(MadeUp):
    """Of a stiffness across that a test sets."""

    def __init__(self, across: float) -> None:
        super().__init__(lambda _: 0.0, lambda _: 1.0, lambda _: self.across)
        self.across = across


def test_the_next_step_begins_one_shift_below_the_last_one() -> None:
    """So that the shift can fall again, and need not be sought from its smallest each time."""
    saddle, shared, u = Saddle(-3.0), system(), np.zeros((1, 2))
    hessian = DefiniteHessian(TotalEnergy([saddle]), shared, lambda _: NONE, np.ones(2))
    hessian.factor(u)
    needed = hessian.tau
    assert needed > 3.0 >= needed / 4.0
    before = shared.factorizations
    hessian.factor(u)
    assert hessian.tau == pytest.approx(needed)
    assert shared.factorizations - before == 3  # the exact one, the shift below, and the one needed
    saddle.across = -1e-3
    taus = []
    for _ in range(4):
        hessian.factor(u)
        taus.append(hessian.tau)
    assert taus == pytest.approx([needed / 4.0**k for k in (1, 2, 3, 4)])


def test_a_minimisation_that_takes_long_is_allowed_a_shift_below_the_first() -> None:
    """Where a barrier is a million times as stiff as the tissue, the first shift stops all motion."""
    saddle, shared, u = Saddle(-1e-9), system(), np.zeros((1, 2))
    hessian = DefiniteHessian(TotalEnergy([saddle]), shared, lambda _: NONE, np.ones(2))
    taus = []
    for _ in range(30):
        hessian.factor(u)
        taus.append(hessian.tau)
    assert taus[:PATIENCE] == pytest.approx([1e-5] * PATIENCE)
    assert taus[PATIENCE : PATIENCE + 3] == pytest.approx([1e-5 / 4.0**k for k in (1, 2, 3)])
    assert 1e-9 < taus[-1] <= 4e-9


def tangent(stiffness: np.ndarray, mass: np.ndarray) -> Tangent:
    evaluation = Evaluation(0.0, np.zeros((1, 2)), Hessian(DIAGONAL, stiffness))
    return Tangent([evaluation], system(), mass, lambda: NONE)


@pytest.mark.parametrize(("stiffness", "n_negative"), [((-1.0, -2.0), 2), ((-1.0, 2.0), 1), ((1.0, 2.0), 0)])
def test_a_state_is_stable_where_no_pivot_is_negative(
    stiffness: tuple[float, float], n_negative: int
) -> None:
    found = tangent(np.array(stiffness), MASS)
    assert found.n_negative == n_negative
    assert found.is_stable is (n_negative == 0)


@pytest.mark.parametrize(
    ("error", "is_accepted"), [(0.0, True), (0.5e-6, True), (2e-6, False), (1e-2, False), (np.nan, False)]
)
def test_an_eigenpair_is_refused_where_its_residual_is_large(error: float, is_accepted: bool) -> None:
    """||K v - lambda M v|| <= 1e-6 ||K|| ||v||, with K = diag(1, 4), M = 1, and v an angle off the axis.

    The residual is then 3 sin cos of that angle, and the norm 4.
    """
    found = tangent(np.array([1.0, 4.0]), np.ones(2))
    angle = 4.0 / 3.0 * error
    v = np.array([np.cos(angle), np.sin(angle)])
    if is_accepted:
        pair = found._checked(v)
        assert pair.residual == pytest.approx(error, rel=1e-6, abs=1e-15)
        assert pair.eigenvalue == pytest.approx(1.0 + 3.0 * np.sin(angle) ** 2)
    else:
        with pytest.raises(SolveError, match="above 1e-06"):
            found._checked(v)


def test_a_guess_of_the_eigenvalue_saves_every_factorisation_but_one() -> None:
    """The first shift is beyond it then; without one, a hundred-thousandth is doubled until it is."""
    found = tangent(np.array([-3.0, 4.0]), np.ones(2))
    before = found._system.factorizations
    assert found._definite(-3.0).n_negative == 0
    assert found._system.factorizations - before == 1
    found._definite(0.0)
    assert found._system.factorizations - before > 10


def test_a_factor_that_is_refused_next_to_a_singular_state_is_made_in_the_other_way() -> None:
    class Cautious(SuperLU):
        def factorise_definite(self, data: np.ndarray) -> None:  # noqa: ARG002
            return None

    shared = System(np.arange(2), 2, 2, DIAGONAL, Cautious(), NONE)
    evaluation = Evaluation(0.0, np.zeros((1, 2)), Hessian(DIAGONAL, np.array([1e-9, 4.0])))
    factor = Tangent([evaluation], shared, np.ones(2), lambda: NONE)._definite(0.0)
    assert factor.solve(np.array([1e-9, 4.0])) == pytest.approx([1.0, 1.0])


def test_a_tangent_whose_pattern_is_out_of_date_is_refused() -> None:
    found = tangent(np.array([1.0, 4.0]), np.ones(2))
    found._system._set_couplings(NONE)
    with pytest.raises(RuntimeError, match="pattern has grown"):
        found.lowest()
