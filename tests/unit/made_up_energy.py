"""An energy of one point (x, y) that is whatever a test says along x, to see which steps are accepted."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from test_newton import DIAGONAL, NONE, system

from gyrify.energy.term import Evaluation, Hessian
from gyrify.energy.total import TotalEnergy
from gyrify.solve.linear import SuperLU
from gyrify.solve.newton import Criterion, minimise
from gyrify.solve.quasi_newton import QuasiNewton
from gyrify.solve.result import Solution
from gyrify.solve.system import System

Curve = Callable[[float], float]


class MadeUp:
    """Value, slope and stiffness along x need not belong together; along y nothing acts.

    ``accepted`` are the places where a Hessian was wanted: those that a plain Newton method stepped from.
    """

    is_barrier = False

    def __init__(
        self, value: Curve, slope: Curve, stiffness: Curve = lambda _: 1.0, largest: float = 1.0
    ) -> None:
        self.value, self.slope, self.stiffness, self.largest = value, slope, stiffness, largest
        self.accepted: list[float] = []

    def evaluate(self, u: np.ndarray, order: int, project_psd: bool = False) -> Evaluation:  # noqa: ARG002
        x = float(u[0, 0])
        if order >= 2:
            self.accepted.append(x)
        if not np.isfinite(self.value(x)):
            return Evaluation(np.inf)
        return Evaluation(
            self.value(x),
            np.array([[self.slope(x), 0.0]]) if order >= 1 else None,
            Hessian(DIAGONAL, np.array([self.stiffness(x), 1.0])) if order >= 2 else None,
        )

    def max_step(self, u: np.ndarray, du: np.ndarray) -> float:  # noqa: ARG002
        return self.largest


class Blind(SuperLU):
    """Overlooks negative pivots."""

    def factorise_definite(self, data: np.ndarray):
        return self.factorise(data)


def blind_system() -> System:
    return System(np.arange(2), 2, 2, DIAGONAL, Blind(), NONE)


def minimised(
    energy: MadeUp,
    x: float = 0.0,
    *,
    force: float = 1e-12,
    iterations: int = 1,
    shared: System | None = None,
    model: QuasiNewton | None = None,
) -> Solution:
    """End of a minimisation from x, by plain Newton steps unless a model is given."""
    return minimise(
        TotalEnergy([energy]),
        np.array([[x, 0.0]]),
        shared or system(),
        Criterion(force, iterations),
        lambda _: NONE,
        model=model or QuasiNewton(0),
    )
