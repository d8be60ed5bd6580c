"""What every library is given, and what it must give back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from gyrify.energy.kinematics import ElasticKinematics
from gyrify.energy.term import Evaluation, FloatArray, IntArray
from gyrify.model.slice import Slice


@dataclass(frozen=True, eq=False)
class GrownCells:
    """Linear triangles in plane strain that have grown the same in all directions.

    Attributes
    ----------
    points : (n_points, 2) float array
        Reference coordinates [mm].
    cells : (n_cells, 3) int array
        Point indices.
    stretch : (n_cells,) float array
        Growth stretch lambda_g; F_e = F / lambda_g in the plane.
    f33 : (n_cells,) float array
        Out-of-plane elastic stretch.
    J_g : (n_cells,) float array
        Grown over reference volume, by which the energy density is counted.
    mu, kappa : (n_cells,) float array
        Shear and bulk modulus [Pa].
    """

    points: FloatArray
    cells: IntArray
    stretch: FloatArray
    f33: FloatArray
    J_g: FloatArray
    mu: FloatArray
    kappa: FloatArray

    @staticmethod
    def of(problem: Slice, time: float) -> GrownCells:
        """Cells of a slice of linear triangles at a growth time."""
        return GrownCells.grown(problem, problem.kinematics(time))

    @staticmethod
    def grown(problem: Slice, kinematics: ElasticKinematics) -> GrownCells:
        """Cells of a slice in the grown state of some kinematics."""
        config, mesh = problem.config, problem.mesh
        assert config.mesh.element == "linear", "the other libraries are given linear triangles"
        assert config.growth.law == "isotropic", "F_e = F / lambda_g holds for isotropic growth"
        assert config.growth.energy_per == "grown", "energy is counted per grown volume"
        stretch = np.sqrt(kinematics.J_g * kinematics.f33)  # det F_g without its 33 entry, in the plane
        return GrownCells(
            mesh.points,
            mesh.cells,
            stretch,
            kinematics.f33,
            kinematics.J_g,
            problem.parameters[0],
            problem.bulk_modulus,
        )


class Assembler(Protocol):
    """A library that sums the energy of the cells."""

    def energy(self, u: FloatArray) -> float:
        """Energy of a displacement (n_points, 2)."""
        ...

    def all(self, u: FloatArray) -> tuple[float, FloatArray, sp.csr_matrix]:
        """Energy, gradient (2 n_points,) and Hessian in the order x0, y0, x1, y1, ..."""
        ...


def disagreement(ours: Evaluation, theirs: tuple[float, FloatArray, sp.csr_matrix]) -> float:
    """Largest difference of energy, gradient and Hessian, each over the largest entry of ours."""
    value, gradient, hessian = theirs
    assert ours.gradient is not None
    assert ours.hessian is not None
    pattern, entries = ours.hessian.pattern, ours.hessian.values
    size = ours.gradient.size
    upper = sp.csr_matrix((entries, (pattern.rows, pattern.cols)), shape=(size, size))
    whole = upper + sp.triu(upper, 1).T
    return max(
        abs(value - ours.value) / abs(ours.value),
        float(np.abs(gradient - ours.gradient.ravel()).max() / np.abs(ours.gradient).max()),
        float(abs(hessian - whole).max() / np.abs(entries).max()),
    )
