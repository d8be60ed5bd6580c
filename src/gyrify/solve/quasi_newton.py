r"""Steps with an old factor: limited-memory BFGS on top of it, for as long as few of them lead to the goal.

.. math:: s = u_{k+1} - u_k, \quad y = g_{k+1} - g_k, \quad \rho = 1 / s^T y

The inverse Hessian is that of the factor, updated by every pair (s, y) since then (Nocedal 1980). What
changes between late iterations is the stiffness of a few contacts, a matrix of low rank, so that few updates
do what a new factor would, each at a fraction of its cost.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from gyrify.solve.linear import Inverse
from gyrify.solve.types import FloatArray

# Steps with an old factor that are worth trying before a new one.
STEPS = 8
# Contraction expected of the first step with a factor of an earlier increment.
CARRIED_CONTRACTION = 0.55


@dataclass
class QuasiNewton:
    """The latest factor, its updates, and how fast steps with it converge.

    Attributes
    ----------
    steps : int
        How many steps with an old factor are worth trying; 0 for plain Newton.
    factor : Inverse or None
        The factor; None where there is none to use again.
    contraction : float
        Residual after the last step over the residual before it [-].
    """

    steps: int = STEPS
    factor: Inverse | None = None
    contraction: float = 1.0
    _pairs: list[tuple[FloatArray, FloatArray, float]] = field(default_factory=list, repr=False)

    def serves(self, residual: float, goal: float) -> bool:
        """Whether so few more steps can be expected to reach the goal."""
        return self.factor is not None and self.steps > 0 and residual * self.contraction**self.steps <= goal

    def renew(self, factor: Inverse | None) -> None:
        """Take a new factor, or none."""
        self.factor, self.contraction = factor, 1.0
        self._pairs.clear()

    def carry(self) -> None:
        """Keep the factor for another problem near by; what was learnt of this one is forgotten."""
        self.contraction = CARRIED_CONTRACTION
        self._pairs.clear()

    def direction(self, gradient: FloatArray) -> FloatArray:
        """(n_free,) descent direction [mm] for a gradient [Pa mm], by the two-loop recursion."""
        if self.factor is None:
            raise RuntimeError("there is no factor to take a direction from")
        right, shares = gradient.copy(), []
        for s, y, rho in reversed(self._pairs):
            share = rho * _dot(s, right)
            right -= share * y
            shares.append(share)
        along = self.factor.solve(right)
        for (s, y, rho), share in zip(self._pairs, reversed(shares), strict=True):
            along += (share - rho * _dot(y, along)) * s
        return -along

    def learn(self, s: FloatArray, y: FloatArray, contraction: float) -> None:
        """Take in a step, its change of gradient, and the ratio of the residuals after and before it."""
        curvature = _dot(s, y)
        if curvature > 0.0:
            self._pairs.append((s, y, 1.0 / curvature))
        self.contraction = contraction


def _dot(a: FloatArray, b: FloatArray) -> float:
    """Scalar product, not by BLAS, whose sums depend on the number of threads."""
    return float(np.einsum("i,i->", a, b))
