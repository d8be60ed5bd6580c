r"""Linear cells without volumetric locking: the volume ratio is averaged over patches of cells.

.. math::
   E(u) = \sum_c w_c W_{iso}(F_e) + \sum_p w_p \frac{\kappa}{2} (\bar J_p - 1)^2, \quad
   \bar J_p = \frac{1}{w_p} \sum_{c \in p} w_c J_e, \; w_p = \sum_{c \in p} w_c

A patch is the pair of triangles of a quadrilateral (three where columns are halved): one constraint per
quadrilateral instead of two, as many as a mixed quadrilateral with constant pressure has. In space it is the
three tetrahedra of a prism (seven where a surface coarsens).
"""

from __future__ import annotations

import numpy as np

from gyrify.energy.elastic import CellPattern, ElasticEnergy
from gyrify.energy.kinematics import ElasticKinematics
from gyrify.energy.patch_kernels import add_patch_products, volume_ratios
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
        self.order = np.argsort(patch, kind="stable")
        self.starts = np.searchsorted(patch[self.order], np.arange(self.n_patches + 1))
        # The nodes of each patch in order, so that rows of its entries come before columns.
        stride = int(cells.max()) + 1
        codes, number = np.unique(patch[:, None] * stride + cells, return_inverse=True)
        self.corners = np.searchsorted(codes // stride, np.arange(self.n_patches + 1))
        self.local = number.reshape(cells.shape) - self.corners[patch][:, None]
        rows, cols = _entries(codes % stride, self.corners, n_dim)
        self.pattern, position = Pattern.of(rows, cols)
        self.position = position.astype(np.int32)
        width = int(self.pattern.cols.max()) + 1
        entries = self.pattern.rows * width + self.pattern.cols
        self.within = np.searchsorted(entries, within.rows * width + within.cols)

    def sums(self, values: FloatArray) -> FloatArray:
        """(n_patches,) sums over the cells of each patch."""
        return np.bincount(self.patch, weights=values, minlength=self.n_patches).astype(np.float64)


def _entries(nodes: IntArray, corners: IntArray, n_dim: int) -> tuple[IntArray, IntArray]:
    """Upper triangles of the matrices of all patches, one patch after the other."""
    sizes = np.diff(corners)
    first = np.concatenate([[0], np.cumsum((n_dim * sizes) * (n_dim * sizes + 1) // 2)])
    rows, cols = np.empty(first[-1], dtype=np.int64), np.empty(first[-1], dtype=np.int64)
    for size in np.unique(sizes):
        chosen = np.flatnonzero(sizes == size)
        own = nodes[corners[chosen][:, None] + np.arange(size)]
        dofs = (own[:, :, None] * n_dim + np.arange(n_dim)).reshape(chosen.size, -1)
        i, j = np.triu_indices(n_dim * size)
        places = first[chosen][:, None] + np.arange(i.size)
        rows[places], cols[places] = dofs[:, i], dofs[:, j]
    return rows, cols


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
        J = np.empty(F.shape[0])
        volume_ratios(F, self.kinematics.f33, J)
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
        patches = self.patches
        values = np.zeros(patches.pattern.rows.size)
        add_patch_products(
            F,
            self.kinematics.gradients,
            self.weight * J,
            self._patch_kappa / self._patch_weight,
            patches.starts,
            patches.order,
            patches.local,
            patches.corners,
            patches.position,
            values,
        )
        values[self.patches.within] += hessian.values
        return Hessian(self.patches.pattern, values)
