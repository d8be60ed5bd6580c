r"""Newton directions by conjugate gradients: as accurate as the state is worth, and always downhill.

.. math:: \|(K + \tau M) p - g\| \le \eta \|g\|, \quad
    \eta_k = 0.9 \, (\|g_k\| / \|g_{k-1}\|)^2

at most 0.1 (Eisenstat and Walker 1996, choice 2), and at least what brings the largest force to a third of
the tolerance of the increment: an inexact direction costs iterations, never accuracy. Where a direction d of
negative curvature is met, the shift is raised beyond

.. math:: \tau = - d^T K d / d^T M d,

at the price of some products with the matrix; a factor would cost a whole one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from gyrify.energy.term import Evaluation
from gyrify.energy.total import TotalEnergy
from gyrify.errors import SolveError
from gyrify.solve.iterative.blocks import BlockMatrix
from gyrify.solve.iterative.conjugate import Ended, dot, norm
from gyrify.solve.iterative.krylov import ConjugateGradients
from gyrify.solve.system import System
from gyrify.solve.types import FloatArray, IntArray

# Relative residuals: of the first step and at most of a later one, and over what the tolerance asks for.
_FIRST: Final = 1e-2
_LARGEST: Final = 0.1
_BELOW_TOLERANCE: Final = 0.3
_SMALLEST: Final = 1e-10
# The next shift over the last one; and over what a direction of negative curvature asks for at least.
_GROWTH: Final = 4.0
_BEYOND: Final = 2.0
_RAISES: Final = 60
# The least shift, over the largest entry of the stiffness.
_LEAST: Final = 1e-9


@dataclass
class InexactHessian:
    """Hessian of an energy, of which directions are asked for and never a factor.

    Attributes
    ----------
    total : TotalEnergy
        Whose Hessian.
    system : System
        Linear system of the free degrees of freedom.
    solver : ConjugateGradients
        That of the system.
    candidates : callable
        Couplings near a state, for the pattern.
    mass : (n_free,) float array or None
        Lumped volume, to shift by a multiple of; None to project every cell.
    force : float
        Largest nodal force accepted as zero.
    tau : float
        The last shift that was needed.
    """

    total: TotalEnergy
    system: System
    solver: ConjugateGradients
    candidates: Callable[[FloatArray], IntArray]
    mass: FloatArray | None
    force: float
    watch: Callable[[], None] = lambda: None
    tau: float = 0.0
    _negative: FloatArray | None = field(default=None, repr=False)
    _size: float = 0.0
    _share: float = _FIRST

    def factor(self, u: FloatArray) -> Direction:
        """What solves with the Hessian at a state."""
        return Direction(self, u)

    def direction(self, u: FloatArray, gradient: FloatArray) -> FloatArray:
        """(n_free,) approximate solution p of K p = g with p g > 0.

        Raises
        ------
        SolveError
            If nothing makes the Hessian definite.
        """
        share = self._accuracy(gradient)
        exact = self.total.evaluate(u, project_psd=False)
        matrix = self._matrix(exact, u)
        right = matrix.pattern.nodes.expand(gradient)
        if self.tau == 0.0 or not self._is_refuted(matrix):
            found = self._solved(matrix, right, share)
            if found.negative is None:
                return self._accepted(matrix, found, 0.0)
            if self.mass is None:
                projected = self._matrix(self.total.evaluate(u, project_psd=True), u)
                return self._accepted(projected, self._solved(projected, right, share), 0.0)
        barriers = self.total.project_barriers(u, exact)
        if barriers is not None:
            matrix = self._matrix(barriers, u)
            if self.tau == 0.0:
                found = self._solved(matrix, right, share)
                if found.negative is None:
                    return self._accepted(matrix, found, 0.0)
        return self._shifted(matrix, right, share)

    def _shifted(self, matrix: BlockMatrix, right: FloatArray, share: float) -> FloatArray:
        """Direction of K + tau M with the first tau of a sequence that shows no negative curvature."""
        if self.mass is None:
            raise RuntimeError("there is no mass to shift by")
        mass = matrix.pattern.nodes.expand(self.mass)
        tau = self.tau / _GROWTH
        for _ in range(_RAISES):
            q = self._negative
            if q is not None:
                tau = max(tau, -_BEYOND * dot(q, matrix @ q) / dot(q, mass * q))
            if tau == 0.0:  # the curvature that was met is none but for rounding
                tau = _LEAST * float(np.abs(matrix.diagonal).max()) / float(mass.max())
            found = self._solved(matrix.shifted(tau * mass), right, share)
            if found.negative is None:
                return self._accepted(matrix, found, tau)
            tau *= _GROWTH
        raise SolveError(
            "No shift makes the stiffness positive definite.", "Check that all stiffnesses are finite."
        )

    def _solved(self, matrix: BlockMatrix, right: FloatArray, share: float) -> Ended:
        """Conjugate gradients; a direction of negative curvature is kept."""
        found = self.solver.solve(matrix, right, share, self.watch)
        if found.negative is not None:
            self._negative = found.negative
        return found

    def _accepted(self, matrix: BlockMatrix, found: Ended, tau: float) -> FloatArray:
        self.tau = tau
        return np.asarray(found.x[matrix.pattern.nodes.place])

    def _is_refuted(self, matrix: BlockMatrix) -> bool:
        """Whether the last direction of negative curvature is one still."""
        q = self._negative
        return q is not None and q.size == matrix.diagonal.shape[0] * 3 and dot(q, matrix @ q) < 0.0

    def _accuracy(self, gradient: FloatArray) -> float:
        """Relative residual of the next solve."""
        size = norm(gradient)
        if self._size > 0.0:
            share, last = 0.9 * (size / self._size) ** 2, 0.9 * self._share**2
            self._share = min(_LARGEST, max(share, last) if last > _LARGEST else share)
        self._size = size
        largest = float(np.abs(gradient).max())
        least = max(_SMALLEST, _BELOW_TOLERANCE * self.force / largest)
        return max(self._share, min(least, _LARGEST))

    def _matrix(self, evaluations: Sequence[Evaluation], u: FloatArray) -> BlockMatrix:
        data = self.system.assemble(evaluations, lambda: self.candidates(u))
        self.system.require_numbers(data)
        return self.solver.matrix(data)


@dataclass(frozen=True, eq=False)
class Direction:
    """See `gyrify.solve.linear.Factor`; solves for a descent direction."""

    hessian: InexactHessian
    u: FloatArray

    def solve(self, right: FloatArray) -> FloatArray:
        """Approximate solution of K x = right, or of a shifted K where that is not positive definite."""
        return self.hessian.direction(self.u, right)
