"""Sparse symmetric linear systems: factors with their inertia by two libraries, or conjugate gradients."""

from __future__ import annotations

from typing import Literal, Protocol, TypeGuard

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla

from gyrify.errors import ConfigError, SolveError
from gyrify.solve.iterative.blocks import Nodes
from gyrify.solve.iterative.krylov import ConjugateGradients
from gyrify.solve.types import FloatArray, IntArray

SolverName = Literal["auto", "pardiso", "superlu", "cg"]


class Inverse(Protocol):
    """What solves with a matrix."""

    def solve(self, right: FloatArray) -> FloatArray:
        """Solution of A x = right, (n,) or (n, k)."""
        ...


class Factor(Inverse, Protocol):
    """A factorised symmetric matrix."""

    @property
    def n_negative(self) -> int:
        """Number of negative pivots, that is of negative eigenvalues."""
        ...


class LinearSolver(Protocol):
    """Factorises matrices that share a sparsity pattern.

    Attributes
    ----------
    name : str
        Name of the library.
    """

    name: str

    def analyse(self, indptr: IntArray, indices: IntArray) -> None:
        """Order a pattern, given as the upper triangle in compressed rows with a full diagonal."""
        ...

    def factorise(self, data: FloatArray) -> Factor:
        """Factorise the matrix with these values on the analysed pattern, and count its inertia."""
        ...

    def factorise_definite(self, data: FloatArray) -> Factor | None:
        """Factorise where no pivot is found negative, else None.

        Never dearer than `factorise`, but next to a singular matrix a negative pivot may be overlooked: to be
        used where that does no harm.
        """
        ...


def linear_solver(name: SolverName = "auto", nodes: Nodes | None = None) -> LinearSolver:
    """Solver by name; ``auto`` is PARDISO where it is installed, else SuperLU.

    ``cg`` needs to know where the unknowns are.

    Raises
    ------
    ConfigError
        If PARDISO is asked for and not installed.
    """
    if name == "cg":
        if nodes is None:
            raise ValueError("conjugate gradients need the nodes of the unknowns")
        return ConjugateGradients(nodes)
    if name == "superlu":
        return SuperLU()
    try:
        from gyrify.solve.pardiso import Pardiso

        return Pardiso()
    except ImportError as missing:
        if name == "pardiso":
            raise ConfigError(
                "solver.linear_solver = 'pardiso', but PARDISO is not installed.",
                "Install it with: pip install mkl (x86-64 only), or choose 'superlu' or 'auto'.",
            ) from missing
        return SuperLU()


def is_available(name: str) -> TypeGuard[SolverName]:
    """Whether this is the name of a solver that is installed."""
    if name == "pardiso":
        return linear_solver("auto").name == name
    return name in ("superlu", "cg")


class SuperLU:
    """SciPy's SuperLU in symmetric mode: diagonal pivots only, so that their signs are the inertia.

    The fill-reducing order is found once per pattern; later matrices are permuted beforehand.
    """

    name = "superlu"

    def analyse(self, indptr: IntArray, indices: IntArray) -> None:
        """See `LinearSolver`."""
        n = indptr.size - 1
        rows = np.repeat(np.arange(n), np.diff(indptr))
        # A diagonally dominant matrix of this pattern: its order depends on the pattern alone.
        off = rows != indices
        ones = sp.coo_matrix((np.full(int(off.sum()), -1.0), (rows[off], indices[off])), shape=(n, n)).tocsc()
        ones = ones + ones.T
        dominant = (ones + sp.diags_array(1.0 - np.asarray(ones.sum(axis=0)).ravel())).tocsc()
        order = _splu(dominant, "MMD_AT_PLUS_A").perm_c
        rows, cols = order[rows], order[indices]
        entry = np.arange(indices.size) + 1.0
        lower_and_upper = sp.coo_matrix(
            (
                np.concatenate([entry, entry[off]]),
                (np.concatenate([rows, cols[off]]), np.concatenate([cols, rows[off]])),
            ),
            shape=(n, n),
        ).tocsc()
        lower_and_upper.sort_indices()
        self._order = order
        self._source = lower_and_upper.data.astype(np.int64) - 1
        self._matrix = lower_and_upper

    def factorise(self, data: FloatArray) -> SuperLUFactor:
        """See `LinearSolver`."""
        self._matrix.data = data[self._source]
        return SuperLUFactor(self._matrix, self._order)

    def factorise_definite(self, data: FloatArray) -> SuperLUFactor | None:
        """See `LinearSolver`."""
        factor = self.factorise(data)
        return factor if factor.n_negative == 0 else None


class SuperLUFactor:
    """See `Factor`."""

    def __init__(self, matrix: sp.csc_matrix, order: IntArray) -> None:
        self._order = order
        try:
            self._lu = _splu(matrix, "NATURAL")
        except RuntimeError as singular:
            raise SolveError(f"SuperLU could not factorise the stiffness matrix ({singular}).") from singular
        if not np.array_equal(self._lu.perm_r, self._lu.perm_c):
            raise SolveError("SuperLU left the diagonal while pivoting, so that its inertia would be wrong.")
        self.n_negative = int(np.count_nonzero(self._lu.U.diagonal() < 0.0))

    def solve(self, right: FloatArray) -> FloatArray:
        """See `Factor`."""
        permuted = np.empty_like(right)
        permuted[self._order] = right
        return np.asarray(self._lu.solve(permuted)[self._order])


def _splu(matrix: sp.csc_matrix, order: str) -> sla.SuperLU:
    return sla.splu(
        matrix,
        permc_spec=order,
        diag_pivot_thresh=0.0,
        # the fastest for planar meshes
        relax=2,
        panel_size=1,
        options={"SymmetricMode": True},
    )
