"""Stress and tangent of the grown solid in closed form, vectorised: the arrays end with the cells.

What an expert writes once and hands to any library. In the plane there are 3 different blocks of the
tangent, C_0j0l, C_0j1l and C_1j1l; the fourth is the transpose of the second.
"""

from __future__ import annotations

import numpy as np

from bench.peers.cells import GrownCells
from gyrify.energy.term import FloatArray

BLOCKS = ((0, 0), (0, 1), (1, 1))


class GrownSolid:
    """Density, stress and tangent per reference volume, by the gradient of the displacement.

    Parameters
    ----------
    cells : GrownCells
        Growth and stiffness.
    """

    def __init__(self, cells: GrownCells) -> None:
        self.inverse = 1.0 / cells.stretch
        self.f33, self.mu, self.kappa, self.J_g = cells.f33, cells.mu, cells.kappa, cells.J_g
        self._identity = np.eye(2)[:, :, None]

    def elastic(self, grad_u: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """F_e (2, 2, n), J_e and I1 of a displacement gradient (2, 2, n)."""
        F = (grad_u + self._identity) * self.inverse
        J = (F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0]) * self.f33
        return F, J, np.einsum("ijc,ijc->c", F, F) + self.f33**2

    def density(self, grad_u: FloatArray) -> FloatArray:
        """Energy per reference volume [Pa]."""
        _, J, I1 = self.elastic(grad_u)
        return self.J_g * (0.5 * self.mu * (I1 * np.cbrt(J) ** -2 - 3.0) + 0.5 * self.kappa * (J - 1.0) ** 2)

    def all(self, grad_u: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Density (n,), stress (2, 2, n) and the blocks of the tangent (3, 2, 2, n) [Pa]."""
        F, J, I1 = self.elastic(grad_u)
        H = np.empty_like(F)
        det = J / self.f33
        H[0, 0], H[0, 1], H[1, 0], H[1, 1] = F[1, 1] / det, -F[1, 0] / det, -F[0, 1] / det, F[0, 0] / det
        a = self.mu * np.cbrt(J) ** -2
        p = self.kappa * (J - 1.0)
        density = self.J_g * (0.5 * (a * I1 - 3.0 * self.mu) + 0.5 * p * (J - 1.0))
        b = J * p - a * I1 / 3.0
        c = J * p + self.kappa * J * J + 2.0 / 9.0 * a * I1
        first = self.J_g * self.inverse
        second = first * self.inverse
        stress = first * (a * F + b * H)
        e = -2.0 / 3.0 * a
        tangent = np.empty((3, 2, 2, F.shape[2]))
        for block, (i, k) in enumerate(BLOCKS):
            tangent[block] = (c * H[i] + e * F[i])[:, None] * H[k] + (e * H[i])[:, None] * F[k]
            tangent[block] -= b * H[k][:, None] * H[i]
            if i == k:
                tangent[block] += a * self._identity
        tangent *= second
        return density, stress, tangent

    @staticmethod
    def full(tangent: FloatArray) -> FloatArray:
        """(2, 2, 2, 2, n) tangent C_ijkl of the blocks."""
        whole = np.empty((2, 2, 2, 2, tangent.shape[3]))
        whole[0, :, 0], whole[0, :, 1], whole[1, :, 1] = tangent
        whole[1, :, 0] = tangent[1].swapaxes(0, 1)
        return whole
