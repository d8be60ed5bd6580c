"""What conjugate gradients are preconditioned by: blocks of the diagonal, or multigrid with rigid modes."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from typing import Any, Final

import numpy as np

from gyrify.energy.symmetric_product import invert_positive, multiply_blocks
from gyrify.errors import SolveError
from gyrify.solve.iterative.blocks import BlockMatrix
from gyrify.solve.types import FloatArray

Preconditioner = Callable[[FloatArray], FloatArray]
# Unknowns of the coarsest level, which is solved by a dense eigendecomposition.
_COARSEST: Final = 300
# An eigenvalue of that level below this share of the largest one is rounding: of a candidate without content.
_NOTHING: Final = 1e-12


def block_diagonal(matrix: BlockMatrix) -> Preconditioner:
    """Inverse of the blocks on the diagonal, by the absolute values of their eigenvalues.

    A state past buckling may have a block that is not positive, which would be no preconditioner.

    Raises
    ------
    SolveError
        If a block is singular.
    """
    inverse = np.empty_like(matrix.diagonal)
    rest = np.flatnonzero(~invert_positive(matrix.diagonal, inverse))
    values, vectors = np.linalg.eigh(matrix.diagonal[rest])
    if not np.abs(values).min(initial=1.0) > 0.0:
        raise SolveError("A point of the mesh has no stiffness.", "Check that all stiffnesses are positive.")
    inverse[rest] = np.einsum("nij,nj,nkj->nik", vectors, 1.0 / np.abs(values), vectors)

    def apply(x: FloatArray) -> FloatArray:
        product = np.empty_like(x)
        multiply_blocks(inverse, x, product)
        return product

    return apply


def strongest(matrix: BlockMatrix) -> Preconditioner:
    """Multigrid where PyAMG is installed, else blocks of the diagonal: for what drag does not help with."""
    return multigrid(matrix) if has_multigrid() else block_diagonal(matrix)


def has_multigrid() -> bool:
    """Whether PyAMG is installed."""
    return find_spec("pyamg") is not None


def multigrid(matrix: BlockMatrix) -> Preconditioner:
    """One V-cycle of smoothed aggregation that keeps the rigid modes (PyAMG).

    Weights are bounds by the sums of rows, not the spectral radii that PyAMG estimates from random vectors:
    the same matrix gives the same bytes.
    """
    import pyamg

    hierarchy = pyamg.smoothed_aggregation_solver(
        matrix.whole(),
        B=matrix.pattern.nodes.modes,
        symmetry="symmetric",
        strength=("symmetric", {"theta": 0.0}),
        smooth=("jacobi", {"omega": 4.0 / 3.0, "filter_entries": False, "weighting": "local"}),
        presmoother=("gauss_seidel", {"sweep": "forward"}),
        postsmoother=("gauss_seidel", {"sweep": "backward"}),
        improve_candidates=None,
        max_coarse=_COARSEST,
        coarse_solver=_Coarsest(),
    )
    cycle = hierarchy.aspreconditioner(cycle="V")
    return lambda x: np.asarray(cycle @ x)


class _Coarsest:
    """Inverse of the coarsest level by the absolute values of its eigenvalues, those of no size left out.

    Buckling is long-waved, so that negative curvature is seen there: a preconditioner must be positive.
    """

    def __init__(self) -> None:
        self._inverse: FloatArray | None = None

    def __call__(self, A: Any, b: FloatArray) -> FloatArray:
        """Solution of the coarsest level."""
        if self._inverse is None:
            values, vectors = np.linalg.eigh(A.toarray())
            sizes = np.abs(values)
            kept = sizes > _NOTHING * sizes.max()
            self._inverse = (vectors[:, kept] / sizes[kept]) @ vectors[:, kept].T
        return self._inverse @ np.ravel(b)
