"""The cells of gyrify in scikit-fem: forms of its vector element, or blocks of scalar ones.

`VectorForms` is what the library's examples of hyperelasticity do. `ScalarBlocks` is what an expert makes of
it for speed: a vector basis function has one component that is not zero, so that the matrix falls into blocks
of scalar forms, of which the symmetric one is summed once; the pattern, and the place of every entry in it,
are found once.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
import scipy.sparse as sp
from skfem import Basis, BilinearForm, ElementTriP1, ElementVector, Functional, LinearForm, MeshTri
from skfem.helpers import ddot

from bench.peers.cells import GrownCells
from bench.peers.solid import BLOCKS, GrownSolid
from gyrify.energy.term import FloatArray


@Functional
def _integral(w):  # type: ignore[no-untyped-def]
    return w["density"]


@LinearForm
def _force(v, w):  # type: ignore[no-untyped-def]
    return ddot(np.asarray(w["stress"]), v.grad)


@BilinearForm
def _stiffness(u, v, w):  # type: ignore[no-untyped-def]
    return np.einsum("ij...,ijkl...,kl...->...", v.grad, np.asarray(w["tangent"]), u.grad)


@LinearForm
def _force_component(v, w):  # type: ignore[no-untyped-def]
    P = np.asarray(w["stress"])
    return P[0] * v.grad[0] + P[1] * v.grad[1]


@BilinearForm
def _stiffness_block(u, v, w):  # type: ignore[no-untyped-def]
    C, g, h = np.asarray(w["tangent"]), v.grad, u.grad
    return g[0] * (C[0, 0] * h[0] + C[0, 1] * h[1]) + g[1] * (C[1, 0] * h[0] + C[1, 1] * h[1])


def _mesh(cells: GrownCells) -> MeshTri:
    return MeshTri(np.ascontiguousarray(cells.points.T), np.ascontiguousarray(cells.cells.T))


class VectorForms:
    """Forms of the vector element.

    Parameters
    ----------
    cells : GrownCells
        Mesh, growth and stiffness.
    """

    def __init__(self, cells: GrownCells) -> None:
        self.solid = GrownSolid(cells)
        self.basis = Basis(_mesh(cells), ElementVector(ElementTriP1()), intorder=1)
        self._order = self.basis.nodal_dofs.T.ravel()  # degree of freedom of x0, y0, x1, ...

    def energy(self, u: FloatArray) -> float:
        """See `bench.peers.cells.Assembler`."""
        density = self.solid.density(self._gradient(u))
        return float(_integral.assemble(self.basis, density=density[:, None]))

    def all(self, u: FloatArray) -> tuple[float, FloatArray, sp.csr_matrix]:
        """See `bench.peers.cells.Assembler`; the numbering of the library is that of points already."""
        density, stress, tangent = self.solid.all(self._gradient(u))
        tangent = self.solid.full(tangent)
        return (
            float(_integral.assemble(self.basis, density=density[:, None])),
            _force.assemble(self.basis, stress=stress[..., None]),
            _stiffness.assemble(self.basis, tangent=tangent[..., None]),
        )

    def _gradient(self, u: FloatArray) -> FloatArray:
        values = np.empty(u.size)
        values[self._order] = u.ravel()
        return self.basis.interpolate(values).grad[..., 0]


class ScalarBlocks:
    """Blocks of the scalar element on a pattern that is kept.

    Parameters
    ----------
    cells : GrownCells
        Mesh, growth and stiffness.
    """

    def __init__(self, cells: GrownCells) -> None:
        self.solid = GrownSolid(cells)
        self.basis = Basis(_mesh(cells), ElementTriP1(), intorder=1)
        self.size = 2 * cells.points.shape[0]

    def energy(self, u: FloatArray) -> float:
        """See `bench.peers.cells.Assembler`."""
        return self.integral(self.solid.density(self.gradient(u)))

    def all(self, u: FloatArray) -> tuple[float, FloatArray, sp.csr_matrix]:
        """See `bench.peers.cells.Assembler`."""
        density, stress, tangent = self.solid.all(self.gradient(u))
        return self.integral(density), self.forces(stress), self.matrix(tangent)

    def gradient(self, u: FloatArray) -> FloatArray:
        """(2, 2, n_cells) gradient of a displacement."""
        return np.stack([self.basis.interpolate(u[:, i].copy()).grad[..., 0] for i in range(2)])

    def integral(self, density: FloatArray) -> float:
        """Sum of a density over the cells."""
        return float(_integral.assemble(self.basis, density=density[:, None]))

    def forces(self, stress: FloatArray) -> FloatArray:
        """(2 n_points,) nodal forces of a stress."""
        forces = np.empty((self.size // 2, 2))
        for i in range(2):
            forces[:, i] = _force_component.assemble(self.basis, stress=stress[i][..., None])
        return forces.ravel()

    def matrix(self, tangent: FloatArray) -> sp.csr_matrix:
        """Matrix of the blocks of a tangent."""
        indptr, indices, place = self._pattern
        entries = [_stiffness_block.elemental(self.basis, tangent=block[..., None]).data for block in tangent]
        entries.append(entries[1])  # the transpose of the block beside the diagonal
        data = np.bincount(place, weights=np.concatenate(entries), minlength=indices.size)
        return sp.csr_matrix((data, indices, indptr), shape=(self.size, self.size))

    @cached_property
    def _pattern(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Row starts and columns of the matrix, and the place in it of every entry of the blocks."""
        zero = np.zeros((2, 2, self.basis.nelems, 1))
        rows, cols = _stiffness_block.elemental(self.basis, tangent=zero).indices.astype(np.int64)
        entries = [(2 * rows + i) * self.size + 2 * cols + k for i, k in BLOCKS]
        entries.append((2 * cols + 1) * self.size + 2 * rows)
        codes, place = np.unique(np.concatenate(entries), return_inverse=True)
        starts = np.searchsorted(codes // self.size, np.arange(self.size + 1))
        return starts.astype(np.int32), (codes % self.size).astype(np.int32), place

    @cached_property
    def upper(self) -> np.ndarray:
        """Which entries of the matrix are in its upper triangle."""
        indptr, indices, _ = self._pattern
        return np.repeat(np.arange(self.size), np.diff(indptr)) <= indices
