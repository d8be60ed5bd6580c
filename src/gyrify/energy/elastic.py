"""Hyperelastic energy of growing cells: sum over cells of volume x (J_g or 1) x W(F_e)."""

from __future__ import annotations

import numpy as np

from gyrify.energy.kernels import cell_kernels, elastic_kernels
from gyrify.energy.kinematics import ElasticKinematics
from gyrify.energy.term import Evaluation, FloatArray, Hessian, IntArray, Pattern
from gyrify.physics.materials import NEO_HOOKEAN, Material


class CellPattern:
    """Sparsity pattern of a mesh and the position in it of every entry of every cell matrix.

    Parameters
    ----------
    cells : (n_cells, n_nodes) int array
        Point indices.
    n_dim : int
        Degrees of freedom of a point.
    extra : int, optional
        A degree of freedom that all cells share.
    """

    def __init__(self, cells: IntArray, n_dim: int, extra: int | None = None) -> None:
        dofs = (cells[:, :, None] * n_dim + np.arange(n_dim)).reshape(cells.shape[0], -1)
        p, q = np.triu_indices(dofs.shape[1])
        if extra is not None:
            # its column comes last, so that the entries of the nodes have the same places with and without
            last = dofs.shape[1]
            dofs = np.concatenate([dofs, np.full((cells.shape[0], 1), extra)], axis=1)
            p, q = np.append(p, np.arange(last + 1)), np.append(q, np.full(last + 1, last))
        self.pattern, position = Pattern.of(dofs[:, p], dofs[:, q])
        self.position = np.ascontiguousarray(position, dtype=np.int32)


class ElasticEnergy:
    r"""Hyperelastic cells under growth.

    .. math:: E(u) = \sum_c V_c w_c W(F_e), \quad w_c = J_g \text{ (per grown volume) or } 1

    Parameters
    ----------
    kinematics : ElasticKinematics
        Cells in their grown state.
    parameters : (n_parameters, n_cells) float array
        Of the material; the last one is the bulk modulus [Pa].
    weight : (n_cells,) float array
        Volume that the energy density is counted by [mm^2]: V J_g (grown) or V (reference).
    pattern : CellPattern
        Sparsity of the mesh.
    material : Material
        Which solid.
    """

    is_barrier = False

    def __init__(
        self,
        kinematics: ElasticKinematics,
        parameters: FloatArray,
        weight: FloatArray,
        pattern: CellPattern,
        material: Material = NEO_HOOKEAN,
    ) -> None:
        self.kinematics = kinematics
        self.parameters, self.weight, self.material = parameters, weight, material
        self.pattern = pattern
        _, n_nodes, n_dim = kinematics.gradients.shape
        self._kernels = elastic_kernels(n_dim, n_nodes, material)
        self._cell_kernels = cell_kernels(n_dim, n_nodes)
        self._add_cells = self._kernels.accumulate
        self._slope = np.empty(0)

    def evaluate(self, u: FloatArray, order: int, project_psd: bool = False) -> Evaluation:
        """Energy [Pa mm^2], gradient [Pa mm], Hessian [Pa]; see `EnergyTerm`."""
        return self._accumulate(u, order, project_psd, self.parameters, np.zeros_like(self.weight))

    def _accumulate(
        self,
        u: FloatArray,
        order: int,
        project_psd: bool,
        parameters: FloatArray,
        pressure: FloatArray,
        F33: float = 1.0,
    ) -> Evaluation:
        """Sum over cells, with a pressure [Pa] added to dW/dJ of each, and all stretched by F33 along z."""
        k = self.kinematics
        if k.curved is not None and k.curved.first_inverted(u) is not None:
            return Evaluation(np.inf)
        gradient = np.zeros_like(u) if order >= 1 else np.empty((0, u.shape[1]))
        values = np.zeros(self.pattern.pattern.rows.size if order >= 2 else 0)
        cells = (
            k.cells,
            k.base,
            k.gradients,
            F33 * k.f33,
            self._slope,
            parameters,
            pressure,
            self.weight,
        )
        value = self._add_cells(u, *cells, order, project_psd, self.pattern.position, gradient, values)
        if not np.isfinite(value):
            return Evaluation(np.inf)
        hessian = Hessian(self.pattern.pattern, values) if order >= 2 else None
        return Evaluation(value, gradient if order >= 1 else None, hessian)

    def max_step(self, u: FloatArray, du: FloatArray) -> float:
        """Largest fraction of du, at most 1, before a cell is inverted anywhere in it."""
        k = self.kinematics
        step = float(self._cell_kernels.largest_step(u, du, k.cells, k.base, k.gradients))
        return step if k.curved is None else step * k.curved.largest_step(u, step * du)
