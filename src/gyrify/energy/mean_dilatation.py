r"""Linear cells without volumetric locking: the volume ratio is averaged over patches of cells.

.. math::
   E(u) = \sum_c w_c W_{iso}(F_e) + \sum_p w_p \frac{\kappa}{2} (\bar J_p - 1)^2, \quad
   \bar J_p = \frac{1}{w_p} \sum_{c \in p} w_c J_e, \; w_p = \sum_{c \in p} w_c

A patch is the pair of triangles of a quadrilateral (three where columns are halved): one constraint per
quadrilateral instead of two, as many as a mixed quadrilateral with constant pressure has.
"""

from __future__ import annotations

import numpy as np

from gyrify.energy.elastic import CellPattern, ElasticEnergy
from gyrify.energy.kinematics import ElasticKinematics
from gyrify.energy.term import Evaluation, FloatArray, Hessian, IntArray, Pattern
from gyrify.physics.materials import NEO_HOOKEAN, Material


class PatchPattern:
    """Which cells share a patch, and where the products of their volume gradients go.

    Parameters
    ----------
    cells : (n_cells, n_nodes) int array
        Point indices.
    patch : (n_cells,) int array
        Patch of each cell.
    n_dim : int
        Dimension.
    within : Pattern
        Pattern of the cells alone.
    """

    def __init__(self, cells: IntArray, patch: IntArray, n_dim: int, within: Pattern) -> None:
        self.patch = patch
        self.n_patches = int(patch.max()) + 1
        self.pairs = _pairs_in_patches(patch)
        dofs = (cells[:, :, None] * n_dim + np.arange(n_dim)).reshape(cells.shape[0], -1)
        rows, cols = np.broadcast_arrays(dofs[self.pairs[:, 0], :, None], dofs[self.pairs[:, 1], None, :])
        self.upper = rows <= cols
        self.pattern, self.position = Pattern.of(rows[self.upper], cols[self.upper])
        stride = int(self.pattern.cols.max()) + 1
        codes = self.pattern.rows * stride + self.pattern.cols
        self.within = np.searchsorted(codes, within.rows * stride + within.cols)

    def sums(self, values: FloatArray) -> FloatArray:
        """(n_patches,) sums over the cells of each patch."""
        return np.bincount(self.patch, weights=values, minlength=self.n_patches).astype(np.float64)


def _pairs_in_patches(patch: IntArray) -> IntArray:
    """(n_pairs, 2) ordered pairs of cells in one patch, a cell with itself included."""
    order = np.argsort(patch, kind="stable")
    grouped = patch[order]
    pairs = [np.stack([order, order], axis=1)]
    for shift in range(1, int(np.bincount(patch).max())):
        same = grouped[shift:] == grouped[:-shift]
        first, second = order[:-shift][same], order[shift:][same]
        pairs += [np.stack([first, second], axis=1), np.stack([second, first], axis=1)]
    return np.concatenate(pairs)


class MeanDilatationEnergy(ElasticEnergy):
    """Hyperelastic cells with the volume ratio averaged over patches; see the module's equation.

    Parameters
    ----------
    kinematics, parameters, weight, pattern, material
        As in `ElasticEnergy`; the bulk modulus is the same all over a patch.
    patches : PatchPattern
        Which cells share a volume ratio.
    """

    def __init__(
        self,
        kinematics: ElasticKinematics,
        parameters: FloatArray,
        weight: FloatArray,
        pattern: CellPattern,
        patches: PatchPattern,
        material: Material = NEO_HOOKEAN,
    ) -> None:
        super().__init__(kinematics, parameters, weight, pattern, material)
        self.patches = patches
        self._patch_weight = patches.sums(weight)
        self._patch_kappa = patches.sums(weight * parameters[-1]) / self._patch_weight
        self._isochoric = np.concatenate([parameters[:-1], np.zeros_like(parameters[-1:])])

    def evaluate(self, u: FloatArray, order: int, project_psd: bool = False) -> Evaluation:
        """Energy [Pa mm^2], gradient [Pa mm], Hessian [Pa]; see `EnergyTerm`."""
        F = self.kinematics.deformation(u)
        J = np.linalg.det(F) * self.kinematics.f33
        if not J.min() > 0.0:
            return Evaluation(np.inf)
        excess = self.patches.sums(self.weight * J) / self._patch_weight - 1.0
        pressure = (self._patch_kappa * excess)[self.patches.patch]
        isochoric = self._accumulate(u, order, project_psd, self._isochoric, pressure)
        value = isochoric.value + 0.5 * float(np.sum(self._patch_weight * self._patch_kappa * excess**2))
        hessian = isochoric.hessian
        if hessian is not None:
            hessian = self._with_patches(hessian, F, J)
        return Evaluation(value, isochoric.gradient, hessian)

    def _with_patches(self, hessian: Hessian, F: FloatArray, J: FloatArray) -> Hessian:
        """Add the products of volume gradients, a positive semi-definite matrix of rank one per patch."""
        spatial = np.einsum("cai,cij->caj", self.kinematics.gradients, np.linalg.inv(F))
        volume = ((self.weight * J)[:, None, None] * spatial).reshape(J.size, -1)
        stiffness = (self._patch_kappa / self._patch_weight)[self.patches.patch[self.patches.pairs[:, 0]]]
        first, second = volume[self.patches.pairs[:, 0]], volume[self.patches.pairs[:, 1]]
        products = stiffness[:, None, None] * first[:, :, None] * second[:, None, :]
        values = np.zeros(self.patches.pattern.rows.size)
        np.add.at(values, self.patches.position, products[self.patches.upper])
        values[self.patches.within] += hessian.values
        return Hessian(self.patches.pattern, values)
