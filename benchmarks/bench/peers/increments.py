"""gyrify's increments with another library's assembly and SciPy's own solver in the place of gyrify's.

Increments, predictor, Newton's method, line search, contact, drag and tolerance stay gyrify's: only the
elastic term and the linear solver are exchanged, as an expert user of scikit-fem and SciPy writes them.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from unittest import mock

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla

from bench.peers.cells import GrownCells
from bench.peers.scikit_fem import ScalarBlocks
from bench.peers.solid import BLOCKS, GrownSolid
from gyrify.energy.elastic import ElasticEnergy
from gyrify.energy.kinematics import ElasticKinematics
from gyrify.energy.term import Evaluation, FloatArray, Hessian, IntArray
from gyrify.model.tissue import Tissue


class ScikitFemEnergy:
    """The elastic term by scikit-fem; see `gyrify.energy.term.EnergyTerm`.

    Parameters
    ----------
    ours : ElasticEnergy
        Gives the pattern, and the step at which a cell is inverted.
    assembler : ScalarBlocks
        Mesh and pattern in scikit-fem, the same in every increment.
    solid : GrownSolid
        Growth and stiffness of this increment.
    """

    is_barrier = False

    evaluated = 0

    def __init__(self, ours: ElasticEnergy, assembler: ScalarBlocks, solid: GrownSolid) -> None:
        self._ours, self._assembler, self._solid = ours, assembler, solid
        self.kinematics, self.pattern = ours.kinematics, ours.pattern

    def evaluate(self, u: FloatArray, order: int, project_psd: bool = False) -> Evaluation:
        """Energy, gradient and Hessian as far as asked for."""
        type(self).evaluated += 1
        self._assembler.solid = self._solid
        grad_u = self._assembler.gradient(u)
        det = (1.0 + grad_u[0, 0]) * (1.0 + grad_u[1, 1]) - grad_u[0, 1] * grad_u[1, 0]
        if not det.min() > 0.0:
            return Evaluation(np.inf)
        if order == 0:
            return Evaluation(self._assembler.energy(u))
        density, stress, tangent = self._solid.all(grad_u)
        value, forces = self._assembler.integral(density), self._assembler.forces(stress).reshape(u.shape)
        if order == 1:
            return Evaluation(value, forces)
        matrix = self._assembler.matrix(_projected(tangent) if project_psd else tangent)
        return Evaluation(value, forces, Hessian(self.pattern.pattern, matrix.data[self._assembler.upper]))

    def max_step(self, u: FloatArray, du: FloatArray) -> float:
        """Gyrify's own: the search for inverted cells is part of the algorithm, not of the assembly."""
        return self._ours.max_step(u, du)


def _projected(tangent: FloatArray) -> FloatArray:
    """Blocks of the tangent without its negative eigenvalues."""
    n_cells = tangent.shape[3]
    matrices = np.moveaxis(GrownSolid.full(tangent), -1, 0).reshape(n_cells, 4, 4)
    values, vectors = np.linalg.eigh(matrices)
    positive = np.einsum("cij,cj,ckj->cik", vectors, np.maximum(values, 0.0), vectors)
    whole = np.moveaxis(positive.reshape(n_cells, 2, 2, 2, 2), 0, -1)
    return np.stack([whole[i, :, k] for i, k in BLOCKS])


class SciPySolver:
    """`scipy.sparse.linalg.splu` as its documentation advises for symmetric matrices, all of it each time.

    See `gyrify.solve.linear.LinearSolver`.
    """

    name = "superlu"

    def analyse(self, indptr: IntArray, indices: IntArray) -> None:
        """Keep the pattern; SciPy orders anew in every factorisation."""
        n, entry = indptr.size - 1, np.arange(1, indices.size + 1)
        upper = sp.csr_matrix((entry, indices, indptr), shape=(n, n))
        self._matrix = (upper + sp.triu(upper, 1).T).tocsc()
        self._source = self._matrix.data - 1

    def factorise(self, data: FloatArray) -> SciPyFactor:
        """Factorise."""
        matrix = sp.csc_matrix(
            (data[self._source], self._matrix.indices, self._matrix.indptr), shape=self._matrix.shape
        )
        options = {"SymmetricMode": True}
        return SciPyFactor(
            sla.splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
        )

    def factorise_definite(self, data: FloatArray) -> SciPyFactor | None:
        """Factorise where no pivot is negative, else None."""
        factor = self.factorise(data)
        return factor if factor.n_negative == 0 else None


class SciPyFactor:
    """See `gyrify.solve.linear.Factor`."""

    def __init__(self, factors: sla.SuperLU) -> None:
        self._factors = factors
        self.n_negative = int(np.count_nonzero(factors.U.diagonal() < 0.0))

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve."""
        return np.asarray(self._factors.solve(right))


@contextmanager
def replaced() -> Iterator[None]:
    """Exchange assembly and solver; configurations must ask for ``superlu``."""
    own, kept = Tissue.elastic_energy, {}

    def elastic_energy(self: Tissue, kinematics: ElasticKinematics) -> ScikitFemEnergy:
        cells = GrownCells.grown(self, kinematics)
        if id(self.mesh) not in kept:
            kept[id(self.mesh)] = (self.mesh, ScalarBlocks(cells))
        return ScikitFemEnergy(own(self, kinematics), kept[id(self.mesh)][1], GrownSolid(cells))

    with (
        mock.patch.object(Tissue, "elastic_energy", elastic_energy),
        mock.patch("gyrify.solve.linear.SuperLU", SciPySolver),
    ):
        yield
