"""Conjugate gradients in the place of a factorisation; see `gyrify.solve.linear.LinearSolver`."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property
from typing import Final

import numpy as np
import scipy.sparse.linalg as sla

from gyrify.errors import SolveError
from gyrify.solve.iterative.blocks import BlockMatrix, BlockPattern, Nodes
from gyrify.solve.iterative.conjugate import Ended, conjugate_gradients, norm
from gyrify.solve.iterative.lowest import Modes, lowest_modes
from gyrify.solve.iterative.preconditioners import block_diagonal, strongest
from gyrify.solve.types import FloatArray, IntArray

# Products with the matrix after which a direction of descent is taken as it is, over the third root of the
# number of unknowns, that is over the points along an edge of the body. Next to a bifurcation the last digits
# take most of the products and save no step: with 150 products at 33 411 unknowns a run to there took as many
# steps as with 700, with 75 half as many again.
_PRODUCTS: Final = 10.0
# Relative residual of a solve that is asked for as one with a factor, what is too far from it to be one, and
# products allowed for it.
_RESIDUAL, _FAILED, _PATIENCE = 1e-6, 1e-2, 3000


class ConjugateGradients:
    """Solves without a factor: memory grows with the mesh only.

    Parameters
    ----------
    nodes : Nodes
        Where the unknowns are.

    Attributes
    ----------
    products : int
        Products with the matrix so far.
    """

    name = "cg"

    def __init__(self, nodes: Nodes) -> None:
        self.nodes, self.products = nodes, 0

    def analyse(self, indptr: IntArray, indices: IntArray) -> None:
        """See `LinearSolver`."""
        self._pattern = BlockPattern(indptr, indices, self.nodes)

    def matrix(self, data: FloatArray) -> BlockMatrix:
        """Matrix of these values on the analysed pattern."""
        return self._pattern.matrix(data)

    def solve(
        self, matrix: BlockMatrix, right: FloatArray, share: float, watch: Callable[[], None] = lambda: None
    ) -> Ended:
        """Solve to a relative residual, or up to the first direction of negative curvature."""
        precondition, most = block_diagonal(matrix), math.ceil(_PRODUCTS * right.size ** (1.0 / 3.0))
        found = conjugate_gradients(matrix.__matmul__, right, precondition, share, most, watch)
        self.products += found.iterations
        return found

    def modes(self, data: FloatArray, mass: FloatArray) -> Modes:
        """Lowest modes of a matrix against a mass (n_unknowns,)."""
        matrix = self.matrix(data)
        return lowest_modes(matrix, mass, strongest(matrix))

    def factorise(self, data: FloatArray) -> Indefinite:
        """See `LinearSolver`."""
        return Indefinite(self.matrix(data))

    def factorise_definite(self, data: FloatArray) -> Indefinite | None:
        """See `LinearSolver`."""
        found = self.factorise(data)
        return found if found.n_negative == 0 else None


class Indefinite:
    """Solves with a matrix that need not be definite, by minimal residuals; see `gyrify.solve.linear.Factor`.

    Parameters
    ----------
    matrix : BlockMatrix
        The matrix.
    """

    def __init__(self, matrix: BlockMatrix) -> None:
        self._matrix = matrix

    @cached_property
    def n_negative(self) -> int:
        """Number of negative eigenvalues, at most `gyrify.solve.iterative.lowest.MOST_MODES`."""
        unit = np.ones(self._matrix.pattern.nodes.place.size)
        values = lowest_modes(self._matrix, unit, strongest(self._matrix)).eigenvalues
        return int(np.count_nonzero(values < 0.0))

    def solve(self, right: FloatArray) -> FloatArray:
        """See `Factor`.

        Raises
        ------
        SolveError
            If the residual does not fall: the matrix is singular.
        """
        nodes, n = self._matrix.pattern.nodes, 3 * self._matrix.pattern.nodes.n_nodes
        full = nodes.expand(right)
        operator = sla.LinearOperator((n, n), matvec=self._matrix.__matmul__, dtype=np.float64)
        inverse = sla.LinearOperator((n, n), matvec=block_diagonal(self._matrix), dtype=np.float64)
        x, _ = sla.minres(operator, full, M=inverse, rtol=_RESIDUAL, maxiter=_PATIENCE)
        if not norm(full - self._matrix @ x) <= _FAILED * norm(full):
            raise SolveError("Minimal residuals could not solve with the stiffness: it is close to singular.")
        return np.asarray(x[nodes.place])
