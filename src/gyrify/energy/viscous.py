"""Dissipation as energies of the increment (backward Euler): drag, and Kelvin-Voigt viscosity."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from gyrify.energy.elastic import CellPattern
from gyrify.energy.kinematics import ElasticKinematics
from gyrify.energy.term import Evaluation, FloatArray, Hessian, Pattern


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

    def evaluate(self, u: FloatArray, order: int, project_psd: bool = False) -> Evaluation:
        """Energy [Pa mm^2], gradient [Pa mm], Hessian [Pa]; see `EnergyTerm`."""
        k = self.kinematics
        F = k.deformation(u)
        rate = green_lagrange(F) - self.previous_strain
        value = 0.5 * float(np.sum(self.weight * np.einsum("cij,cij->c", rate, rate)))
        if order == 0:
            return Evaluation(value)
        weighted = self.weight[:, None, None] * rate
        gradient = np.zeros_like(u)
        np.add.at(gradient, k.cells, np.einsum("cij,cjk,cak->cai", F, weighted, k.gradients))
        return Evaluation(value, gradient, self._hessian(F, weighted, project_psd) if order >= 2 else None)

    def max_step(self, u: FloatArray, du: FloatArray) -> float:  # noqa: ARG002
        """No limit."""
        return 1.0

    def _hessian(self, F: FloatArray, weighted: FloatArray, project_psd: bool) -> Hessian:
        """Exact, or without the negative part of the stress stiffening (a positive semi-definite bound)."""
        k = self.kinematics
        g, n_dim = k.gradients, F.shape[1]
        stretched = np.einsum("cij,caj->cai", F, g)
        products = np.einsum("cai,cbi->cab", g, g)
        rotated = np.einsum("cij,ckj->cik", F, F)
        matrix = 0.5 * np.einsum("c,cak,cbi->caibk", self.weight, stretched, stretched)
        matrix += 0.5 * np.einsum("c,cab,cik->caibk", self.weight, products, rotated)
        if project_psd:
            eigenvalues, vectors = np.linalg.eigh(weighted)
            weighted = np.einsum("cij,cj,ckj->cik", vectors, np.maximum(eigenvalues, 0.0), vectors)
        stiffening = np.einsum("cai,cij,cbj->cab", g, weighted, g)
        matrix += np.einsum("cab,ik->caibk", stiffening, np.eye(n_dim))
        size = k.cells.shape[1] * n_dim
        rows, cols = np.triu_indices(size)
        entries = matrix.reshape(-1, size, size)[:, rows, cols]
        values = np.zeros(self.pattern.pattern.rows.size)
        np.add.at(values, self.pattern.position, entries)
        return Hessian(self.pattern.pattern, values)


def green_lagrange(F: FloatArray) -> FloatArray:
    """(n_cells, n_dim, n_dim) strain E = (F^T F - I) / 2."""
    return np.asarray(0.5 * (np.einsum("cki,ckj->cij", F, F) - np.eye(F.shape[1])))
