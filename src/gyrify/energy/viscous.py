"""Dissipation as energies of the increment (backward Euler): drag, and Kelvin-Voigt viscosity."""

from __future__ import annotations

from functools import lru_cache
from typing import Literal

import numpy as np

from gyrify.energy.dashpot import strains
from gyrify.energy.elastic import CellPattern
from gyrify.energy.kernels import cell_kernels
from gyrify.energy.kinematics import ElasticKinematics
from gyrify.energy.term import Evaluation, FloatArray, Hessian, Pattern

# What is left of a reduced coefficient at the end of growth.
_LEAST = 1e-3


def reduction(course: Literal["constant", "reduced"], fraction: float) -> float:
    """Part of its coefficient that dissipation has over an increment.

    Parameters
    ----------
    course : {"constant", "reduced"}
        Constant, or in proportion to the growth that is left, so that the last state is an equilibrium.
    fraction : float
        Growth at the end of the increment, as a fraction of the whole.

    Returns
    -------
    float
        max(1 - fraction, 0.001) where it is reduced.
    """
    return 1.0 if course == "constant" else max(1.0 - fraction, _LEAST)


class DragEnergy:
    r"""Drag against a fixed background, a force c m du/dt per reference area.

    .. math:: E(u) = \frac{c}{2 \Delta t} \sum_i m_i |u_i - u_i^n|^2

    Parameters
    ----------
    coefficient : float
        c / Delta t [Pa / mm^2].
    lumped_area : (n_points,) float array
        Reference area m_i of each point [mm^2].
    previous : (n_points, n_dim) float array
        Displacement at the start of the increment [mm].
    """

    is_barrier = False

    def __init__(self, coefficient: float, lumped_area: FloatArray, previous: FloatArray) -> None:
        self.weight = coefficient * lumped_area
        self.previous = previous
        self._pattern = _diagonal(previous.size)

    def evaluate(self, u: FloatArray, order: int, project_psd: bool = False) -> Evaluation:  # noqa: ARG002
        """Energy [Pa mm^2], gradient [Pa mm], Hessian [Pa]; see `EnergyTerm`."""
        rate = u - self.previous
        force = self.weight[:, None] * rate
        hessian = Hessian(self._pattern, np.repeat(self.weight, u.shape[1])) if order >= 2 else None
        return Evaluation(
            0.5 * float(np.einsum("pi,pi->", force, rate)), force if order >= 1 else None, hessian
        )

    def max_step(self, u: FloatArray, du: FloatArray) -> float:  # noqa: ARG002
        """No limit."""
        return 1.0


@lru_cache(maxsize=4)
def _diagonal(n_dofs: int) -> Pattern:
    dofs = np.arange(n_dofs)
    return Pattern(dofs, dofs)


class KelvinVoigtEnergy:
    r"""Dashpot beside the elastic spring of each cell; objective, and free growth costs nothing.

    .. math::
       E(u) = \frac{\eta}{2 \Delta t} \sum_c V_c w_c |E_e - E_e^n|^2, \quad E_e = \tfrac12 (F_e^T F_e - I)

    Parameters
    ----------
    kinematics : ElasticKinematics
        Cells in their grown state at the end of the increment.
    coefficient : float
        eta / Delta t [Pa].
    weight : (n_cells,) float array
        Volume that the density is counted by [mm^2], as in `ElasticEnergy`.
    previous_strain : (n_cells, n_dim, n_dim) float array
        Elastic Green-Lagrange strain E_e at the start of the increment.
    pattern : CellPattern
        Sparsity of the mesh.
    """

    is_barrier = False

    def __init__(
        self,
        kinematics: ElasticKinematics,
        coefficient: float,
        weight: FloatArray,
        previous_strain: FloatArray,
        pattern: CellPattern,
    ) -> None:
        self.kinematics = kinematics
        self.weight = coefficient * weight
        self.previous_strain = previous_strain
        self.pattern = pattern
        _, n_nodes, n_dim = kinematics.gradients.shape
        self._add_cells = cell_kernels(n_dim, n_nodes).dissipate

    def evaluate(self, u: FloatArray, order: int, project_psd: bool = False) -> Evaluation:
        """Energy [Pa mm^2], gradient [Pa mm], Hessian [Pa]; see `EnergyTerm`.

        Projected is the Hessian without the negative part of the stress stiffening: semi-definite, and
        more than the exact one.
        """
        k = self.kinematics
        gradient = np.zeros_like(u) if order >= 1 else np.empty((0, u.shape[1]))
        values = np.zeros(self.pattern.pattern.rows.size if order >= 2 else 0)
        cells = (k.cells, k.base, k.gradients, self.previous_strain, self.weight)
        value = self._add_cells(u, *cells, order, project_psd, self.pattern.position, gradient, values)
        hessian = Hessian(self.pattern.pattern, values) if order >= 2 else None
        return Evaluation(value, gradient if order >= 1 else None, hessian)

    def max_step(self, u: FloatArray, du: FloatArray) -> float:  # noqa: ARG002
        """No limit."""
        return 1.0


def green_lagrange(F: FloatArray) -> FloatArray:
    """(n_cells, n_dim, n_dim) strain E = (F^T F - I) / 2."""
    E = np.empty_like(F)
    strains(F, E)
    return E
