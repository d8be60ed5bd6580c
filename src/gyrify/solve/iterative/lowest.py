"""The lowest modes of a symmetric matrix, by LOBPCG (SciPy), where no factor counts negative pivots."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla

from gyrify.solve.iterative.blocks import BlockMatrix
from gyrify.solve.iterative.preconditioners import Preconditioner
from gyrify.solve.types import FloatArray

# Modes looked for at first, and at most: where more are negative, so many are told.
_FIRST: Final = 4
MOST_MODES: Final = 16
# Vectors that are iterated beside the modes asked for, which hold what would slow the last one down.
_BESIDE: Final = 2
_ITERATIONS: Final = 400
# Residual over the largest entry of the matrix: two orders below what an eigenpair is accepted with.
_TOLERANCE: Final = 1e-8


class Modes(NamedTuple):
    """Lowest modes of K v = lambda M v.

    Attributes
    ----------
    eigenvalues : (n,) float array
        In rising order; each is above the true one, if anything.
    vectors : (n_unknowns, n) float array
        Of unit mass.
    """

    eigenvalues: FloatArray
    vectors: FloatArray


def lowest_modes(matrix: BlockMatrix, mass: FloatArray, precondition: Preconditioner) -> Modes:
    """All negative modes and one more at least, or the `MOST_MODES` lowest ones.

    Parameters
    ----------
    matrix : BlockMatrix
        K.
    mass : (n_unknowns,) float array
        Diagonal of M.
    precondition : callable
        B x of x with B positive definite, near the inverse of K.
    """
    nodes = matrix.pattern.nodes
    weight = nodes.expand(mass)
    is_held = weight == 0.0
    # K is 1 there: of all eigenvalues theirs is the largest, and none that is looked for
    ratios = np.abs(np.einsum("nii->ni", matrix.diagonal)).ravel()[~is_held] / weight[~is_held]
    weight[is_held] = 1.0 / ratios.max()
    count = min(MOST_MODES + _BESIDE, mass.size // 5)  # LOBPCG wants five times as many unknowns
    start = nodes.expand(np.random.default_rng(0).standard_normal((mass.size, count)))
    scale = float(np.abs(matrix.blocks).max())
    wanted = min(_FIRST, count)
    while True:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what was reached is looked at by those who ask
            values, vectors = sla.lobpcg(
                _columns(matrix.__matmul__, weight.size),
                start[:, : min(wanted + _BESIDE, count)],
                B=sp.diags_array(weight),
                M=_columns(precondition, weight.size),
                tol=_TOLERANCE * scale,
                maxiter=_ITERATIONS,
                largest=False,
            )
        order = np.argsort(values, kind="stable")[:wanted]
        if wanted >= min(MOST_MODES, count) or values[order[-1]] > 0.0:
            return Modes(values[order], vectors[nodes.place][:, order])
        wanted = min(2 * wanted, MOST_MODES, count)


def _columns(function: Callable[[FloatArray], FloatArray], n: int) -> sla.LinearOperator:
    """Operator on several vectors of one on a single vector."""

    def matmat(X: FloatArray) -> FloatArray:
        return np.stack([function(x) for x in np.ascontiguousarray(X.T)], axis=1)

    return sla.LinearOperator((n, n), matvec=lambda x: function(np.ravel(x)), matmat=matmat, dtype=np.float64)
