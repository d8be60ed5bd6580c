"""Leaving an unstable equilibrium: which step is taken along its mode, and which state counts as settled."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from made_up_energy import MadeUp
from test_newton import DIAGONAL, NONE, system

from gyrify.energy.term import Evaluation, Hessian
from gyrify.energy.total import TotalEnergy
from gyrify.errors import SolveError
from gyrify.solve.branch import Settled, leave, settle
from gyrify.solve.newton import Criterion

# The steps tried, over the largest displacement allowed.
SCALES = 1e-3 * 2.0 ** np.arange(10)
ALONG = np.array([[0.5, 0.0], [0.0, 0.25]])


def left(falls: list[float], *, largest: float = 1.0, size: float = 1.0) -> float:
    """Where a mode is left to, of energies at the steps in turn that fall by so much; no other is known."""
    values = dict.fromkeys([0.0], 0.0) | {s * size * largest: -f for s, f in zip(SCALES, falls, strict=False)}
    energy = MadeUp(
        lambda x: values[min(values, key=lambda known: abs(known - x))], lambda _: 0.0, largest=largest
    )
    asked = []

    def value(x: float) -> float:
        near = min(values, key=lambda known: abs(known - x))
        assert x == pytest.approx(near, rel=1e-12), "a step that is none of the sequence"
        asked.append(x)
        return values[near]

    energy.value = value
    end = leave(TotalEnergy([energy]), np.zeros((2, 2)), ALONG, size)
    assert np.linalg.norm(end, axis=1).max() <= size
    return float(end[0, 0])


@pytest.mark.parametrize("size", [1.0, 0.2])
def test_steps_along_a_mode_double_for_as_long_as_they_lead_down(size: float) -> None:
    assert left([1, 2, 3, 4, 2, 9, 9, 9, 9, 9], size=size) == pytest.approx(SCALES[3] * size)
    assert left([1, 2, 3, 4, 4, 9, 9, 9, 9, 9], size=size) == pytest.approx(SCALES[3] * size)
    assert left(list(range(1, 11)), size=size) == pytest.approx(SCALES[9] * size)


def test_the_first_steps_may_be_lost_in_rounding() -> None:
    assert left([0, -1, 0, 0, 0, 3, 1, 9, 9, 9]) == pytest.approx(SCALES[5])


def test_a_mode_is_followed_no_further_than_is_admissible() -> None:
    assert left(list(range(1, 11)), largest=0.25) == pytest.approx(0.25 * SCALES[9])


def test_a_mode_that_leads_nowhere_down_is_not_taken() -> None:
    with pytest.raises(SolveError, match="no step along its lowest mode"):
        left([0.0] * 10)


class Separate:
    """A sum of an energy along x and one along y, each with its slope and stiffness."""

    is_barrier = False

    def __init__(self, *parts: tuple[Callable[[float], float], ...]) -> None:
        self.parts = parts

    def evaluate(self, u: np.ndarray, order: int, project_psd: bool = False) -> Evaluation:  # noqa: ARG002
        value, slope, stiffness = (
            [part[k](float(w)) for part, w in zip(self.parts, u[0], strict=True)] for k in range(3)
        )
        return Evaluation(
            sum(value),
            np.array([slope]) if order >= 1 else None,
            Hessian(DIAGONAL, np.array(stiffness)) if order >= 2 else None,
        )

    def max_step(self, u: np.ndarray, du: np.ndarray) -> float:  # noqa: ARG002
        return 1.0


def well(a: float) -> tuple[Callable[[float], float], ...]:
    """Minima at +-sqrt(a), and a saddle at 0."""
    return lambda x: x**4 / 4 - a * x**2 / 2, lambda x: x**3 - a * x, lambda x: 3 * x**2 - a


def settled(energy: Separate, *, iterations: int = 20, sides: float = 1.0, watch=lambda: None) -> Settled:
    return settle(
        TotalEnergy([energy]),
        np.zeros((1, 2)),
        system(),
        np.ones(2),
        Criterion(1e-10, iterations),
        lambda _: NONE,
        lambda u, mode: mode * np.sign(mode.sum()) * sides,  # noqa: ARG005
        0.5,
        watch,
    )


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_descent_that_ends_at_another_saddle_is_not_the_end(side: float) -> None:
    """The mode of x is the lowest; where it leads to, at x = 2, that of y is still unstable."""
    iterations: list[None] = []
    found = settled(Separate(well(4.0), well(1.0)), sides=side, watch=lambda: iterations.append(None))
    assert found.u == pytest.approx(np.array([[2.0, 1.0]]) * side, abs=1e-9)
    assert found.departures == 2
    assert found.residual <= 1e-10
    # each descent looks once more than it steps
    assert found.stats.newton_iterations == len(iterations) - 2


def test_a_descent_may_take_ten_times_the_iterations_of_an_increment_and_no_more() -> None:
    assert settled(Separate(well(4.0), well(-1.0)), iterations=1).u[0, 0] == pytest.approx(2.0)
    with pytest.raises(SolveError, match="descent from it failed: Newton's method did not converge"):
        settled(Separate(well(4.0), well(-1.0)), iterations=0)


def test_where_the_chosen_side_leads_up_the_other_one_is_taken() -> None:
    """x^4/4 + x^3/3 next to a singular state at 0: its minimum is at -1."""
    tilted = (
        lambda x: x**4 / 4 + x**3 / 3 - 1e-9 * x**2,
        lambda x: x**3 + x**2 - 2e-9 * x,
        lambda x: 3 * x**2 + 2 * x - 2e-9,
    )
    assert settled(Separate(tilted, well(-1.0))).u == pytest.approx(np.array([[-1.0, 0.0]]), abs=1e-6)


def test_a_stable_equilibrium_is_not_left() -> None:
    with pytest.raises(SolveError, match="no step along its lowest mode"):
        settled(Separate(well(-2.0), well(-1.0)))
