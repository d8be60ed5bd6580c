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
from gyrify.energy.term import Evaluation, FloatArray, IntArray
from gyrify.physics.materials import NEO_HOOKEAN, Material


class AxialElasticEnergy(ElasticEnergy):
    """Elastic energy of planar cells whose common F33 is a degree of freedom.

    Parameters
    ----------
    kinematics : ElasticKinematics
        Cells in their grown state, at F33 = 1.
    parameters, weight, material
        As in `ElasticEnergy`.
    pattern : CellPattern
        Sparsity of the cells and the axial unknown; see `axial_pattern`.
    length : float
        L [mm].
    """

    def __init__(
        self,
        kinematics: ElasticKinematics,
        parameters: FloatArray,
        weight: FloatArray,
        pattern: CellPattern,
        length: float,
        material: Material = NEO_HOOKEAN,
    ) -> None:
        super().__init__(kinematics, parameters, weight, pattern, material)
        self.length = length
        self._add_cells = self._kernels.accumulate_axial
        self._slope = kinematics.f33 / length

    def evaluate(self, u: FloatArray, order: int, project_psd: bool = False) -> Evaluation:
        """Energy [Pa mm^2], gradient [Pa mm], Hessian [Pa]; see `EnergyTerm`."""
        F33 = 1.0 + float(u[-1, 0]) / self.length
        if not F33 > 0.0:
            return Evaluation(np.inf)
        return self._accumulate(u, order, project_psd, self.parameters, np.zeros_like(self.weight), F33)

    def max_step(self, u: FloatArray, du: FloatArray) -> float:
        """Largest fraction of du, at most 1, before a cell is inverted or F33 vanishes."""
        step, left, change = super().max_step(u, du), self.length + float(u[-1, 0]), float(du[-1, 0])
        return min(step, -0.9 * left / change) if change < 0.0 else step


def axial_pattern(cells: IntArray, n_points: int) -> CellPattern:
    """Pattern of planar cells that all share the first entry of the row after the last point."""
    return CellPattern(cells, 2, extra=2 * n_points)
