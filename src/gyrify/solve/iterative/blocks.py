"""Symmetric matrices of three by three blocks, one row of them for each point; the upper half is kept.

The product is compiled: SciPy's, of the whole matrix, takes more than three times as long.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from gyrify.energy.symmetric_product import multiply
from gyrify.solve.types import FloatArray, IntArray

AXES = 3


@dataclass(frozen=True, eq=False)
class Nodes:
    """Which point and direction each unknown moves.

    Attributes
    ----------
    place : (n_unknowns,) int array
        3 times the number of the point, among those that move, plus the direction; increasing.
    n_nodes : int
        Number of points that move.
    modes : (3 n_nodes, n_modes) float array
        Motions that strain the body hardly or not at all, as a preconditioner may want to know.
    """

    place: IntArray
    n_nodes: int
    modes: FloatArray

    @staticmethod
    def of(moving: IntArray, modes: FloatArray) -> Nodes:
        """Nodes of the degrees of freedom that move, in order; modes are (n_dofs, n_modes) of all of them."""
        points, number = np.unique(moving // AXES, return_inverse=True)
        kept = (AXES * points[:, None] + np.arange(AXES)).ravel()
        place = AXES * number + moving % AXES
        # what a point is held by in part moves no more than the point where all of it is held
        is_held = np.ones(kept.size, dtype=bool)
        is_held[place] = False
        return Nodes(place, points.size, np.where(is_held[:, None], 0.0, modes[kept]))

    def expand(self, x: FloatArray) -> FloatArray:
        """(3 n_nodes, ...) of unknowns (n_unknowns, ...); zero where a point is held in part."""
        full = np.zeros((AXES * self.n_nodes, *x.shape[1:]))
        full[self.place] = x
        return full


class BlockPattern:
    """Upper triangle of a sparsity pattern, in blocks.

    Parameters
    ----------
    indptr, indices : int arrays
        The upper triangle in compressed rows, with a full diagonal, of unknowns.
    nodes : Nodes
        Where the unknowns are.

    Attributes
    ----------
    indptr, indices : int arrays
        The same of blocks; the first one of each row is that of the diagonal.
    """

    def __init__(self, indptr: IntArray, indices: IntArray, nodes: Nodes) -> None:
        self.nodes, n = nodes, nodes.n_nodes
        rows = nodes.place[np.repeat(np.arange(indptr.size - 1), np.diff(indptr))]
        cols = nodes.place[indices]
        codes = (rows // AXES) * n + cols // AXES
        # rows are sorted, and points along them, so that a stable sort of few runs is fast
        kept = np.unique(codes)
        block = np.searchsorted(kept, codes)
        self.indptr = np.searchsorted(kept, np.arange(n + 1) * n).astype(np.int32)
        self.indices = (kept % n).astype(np.int32)
        self._target = (9 * block + AXES * (rows % AXES) + cols % AXES).astype(np.int32)
        self._mirrored = np.flatnonzero((rows // AXES == cols // AXES) & (rows != cols))
        self._mirror = 9 * block[self._mirrored] + AXES * (cols % AXES)[self._mirrored]
        self._mirror += (rows % AXES)[self._mirrored]
        held = np.setdiff1d(np.arange(AXES * n), nodes.place)
        self._held = 9 * self.indptr[held // AXES].astype(np.int64) + (AXES + 1) * (held % AXES)

    def matrix(self, data: FloatArray) -> BlockMatrix:
        """Matrix of values on the pattern of unknowns; 1 on the diagonal where a point is held in part."""
        values = np.zeros(9 * self.indices.size)
        values[self._target] = data
        values[self._mirror] = data[self._mirrored]
        values[self._held] = 1.0
        return BlockMatrix(self, values.reshape(-1, AXES, AXES))


@dataclass(frozen=True, eq=False)
class BlockMatrix:
    """A symmetric matrix.

    Attributes
    ----------
    pattern : BlockPattern
        Where its blocks are.
    blocks : (n_blocks, 3, 3) float array
        The upper triangle, with whole blocks on the diagonal.
    """

    pattern: BlockPattern
    blocks: FloatArray

    def __matmul__(self, x: FloatArray) -> FloatArray:
        """Product with a vector (3 n_nodes,)."""
        product = np.zeros_like(x)
        multiply(self.pattern.indptr, self.pattern.indices, self.blocks, x, product)
        return product

    @property
    def diagonal(self) -> FloatArray:
        """(n_nodes, 3, 3) blocks on the diagonal."""
        return np.asarray(self.blocks[self.pattern.indptr[:-1]])

    def shifted(self, mass: FloatArray) -> BlockMatrix:
        """With a diagonal (3 n_nodes,) added."""
        blocks, axis = self.blocks.copy(), np.arange(AXES)
        blocks[self.pattern.indptr[:-1, None], axis, axis] += mass.reshape(-1, AXES)
        return BlockMatrix(self.pattern, blocks)

    def whole(self) -> sp.bsr_matrix:
        """Both triangles, for a library."""
        pattern, n = self.pattern, self.pattern.nodes.n_nodes
        upper = sp.bsr_matrix((self.blocks, pattern.indices, pattern.indptr), shape=(AXES * n, AXES * n))
        diagonal = sp.bsr_matrix(
            (self.diagonal, np.arange(n, dtype=np.int32), np.arange(n + 1, dtype=np.int32)), shape=upper.shape
        )
        return sp.bsr_matrix(upper + upper.T - diagonal, blocksize=(AXES, AXES))
