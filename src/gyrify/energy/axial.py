r"""Generalised plane strain: the out-of-plane stretch F33 is one unknown, common to all cells.

The state has one row more than the mesh has points; its first entry w [mm] gives F33 = 1 + w / L with a
fixed length L, so that force and displacement of this unknown have the size of the others. At equilibrium
the net axial force vanishes:

.. math:: L \frac{\partial E}{\partial w} = \sum_c w_c \frac{P_{33}}{F_{g,33}} = 0.
"""

from __future__ import annotations

import numpy as np

from gyrify.energy.elastic import CellPattern, ElasticEnergy
from gyrify.energy.kinematics import ElasticKinematics
from gyrify.energy.term import Evaluation, FloatArray, Hessian, IntArray
from gyrify.physics.isotropic import coefficients, energy_density, first_piola, invariants


class AxialElasticEnergy(ElasticEnergy):
    """Elastic energy of planar cells whose common F33 is a degree of freedom.

    Parameters
    ----------
    kinematics : ElasticKinematics
        Cells in their grown state, at F33 = 1.
    mu, kappa, weight
        As in `ElasticEnergy`.
    pattern : CellPattern
        Sparsity of the cells and the axial unknown; see `axial_pattern`.
    length : float
        L [mm].
    """

    def __init__(
        self,
        kinematics: ElasticKinematics,
        mu: FloatArray,
        kappa: FloatArray,
        weight: FloatArray,
        pattern: CellPattern,
        length: float,
    ) -> None:
        super().__init__(kinematics, mu, kappa, weight, pattern)
        self.length = length

    def evaluate(self, u: FloatArray, order: int, project_psd: bool = False) -> Evaluation:
        """Energy [Pa mm^2], gradient [Pa mm], Hessian [Pa]; see `EnergyTerm`."""
        k = self.kinematics
        F = k.deformation(u)
        f33 = (1.0 + float(u[-1, 0]) / self.length) * k.f33
        if not (np.linalg.det(F).min() > 0.0 and f33.min() > 0.0):
            return Evaluation(np.inf)
        value = float(np.sum(self.weight * energy_density(F, f33, self.mu, self.kappa)))
        if order == 0:
            return Evaluation(value)
        P, P33 = first_piola(F, f33, self.mu, self.kappa)
        gradient = np.zeros_like(u)
        np.add.at(gradient, k.cells, np.einsum("c,cij,caj->cai", self.weight, P, k.gradients))
        gradient[-1, 0] += float(np.sum(self.weight * P33 * k.f33)) / self.length
        return Evaluation(value, gradient, self._hessian(F, f33, project_psd) if order >= 2 else None)

    def max_step(self, u: FloatArray, du: FloatArray) -> float:
        """Largest fraction of du, at most 1, before a cell is inverted or F33 vanishes."""
        step, left, change = super().max_step(u, du), self.length + float(u[-1, 0]), float(du[-1, 0])
        return min(step, -0.9 * left / change) if change < 0.0 else step

    def _hessian(self, F: FloatArray, f33: FloatArray, project_psd: bool) -> Hessian:
        """Sum of w B^T C B, with C the tangent of (F11, F12, F21, F22, F33) and B its slope by the nodes."""
        tangent = _tangent(F, f33, self.mu, self.kappa)
        if project_psd:
            eigenvalues, vectors = np.linalg.eigh(tangent)
            tangent = np.einsum("cij,cj,ckj->cik", vectors, np.maximum(eigenvalues, 0.0), vectors)
        slopes = self._slopes()
        matrix = np.swapaxes(slopes, 1, 2) @ (self.weight[:, None, None] * tangent @ slopes)
        rows, cols = np.triu_indices(matrix.shape[1])
        values = np.zeros(self.pattern.pattern.rows.size)
        np.add.at(values, self.pattern.position, matrix[:, rows, cols])
        return Hessian(self.pattern.pattern, values)

    def _slopes(self) -> FloatArray:
        """(n, 5, 2 n_nodes + 1) slopes of the deformation by the nodal displacements and w."""
        k = self.kinematics
        n, n_nodes, _ = k.gradients.shape
        slopes = np.zeros((n, 5, 2 * n_nodes + 1))
        for i in range(2):
            for j in range(2):
                slopes[:, 2 * i + j, i : 2 * n_nodes : 2] = k.gradients[:, :, j]
        slopes[:, 4, -1] = k.f33 / self.length
        return slopes


def axial_pattern(cells: IntArray, n_points: int) -> CellPattern:
    """Pattern of planar cells that all share the first entry of the row after the last point."""
    return CellPattern(cells, 2, extra=2 * n_points)


def _tangent(F: FloatArray, f33: FloatArray, mu: FloatArray, kappa: FloatArray) -> FloatArray:
    """(n, 5, 5) tangent of an isotropic solid; see `gyrify.physics.isotropic`."""
    I1, J = invariants(F, f33)
    a, b, c, d, e = (
        np.asarray(m) * np.ones_like(J) for m in coefficients.py_func(I1, J, np.cbrt(J), mu, kappa, 0.0)
    )
    H = np.swapaxes(np.linalg.inv(F), 1, 2)
    stretch = np.concatenate([F.reshape(-1, 4), f33[:, None]], axis=1)
    normal = np.concatenate([H.reshape(-1, 4), 1.0 / f33[:, None]], axis=1)

    def outer(x: FloatArray, y: FloatArray) -> FloatArray:
        return np.asarray(x[:, :, None] * y[:, None, :])

    crossed = np.zeros((J.size, 5, 5))
    crossed[:, :4, :4] = np.einsum("cil,ckj->cijkl", H, H).reshape(-1, 4, 4)
    crossed[:, 4, 4] = normal[:, 4] ** 2
    mixed = outer(stretch, normal)
    terms = ((c, outer(normal, normal)), (d, outer(stretch, stretch)), (e, mixed + np.swapaxes(mixed, 1, 2)))
    tangent = sum((factor[:, None, None] * term for factor, term in terms), a[:, None, None] * np.eye(5))
    return np.asarray(tangent - b[:, None, None] * crossed)
