"""Sparse linear system of the free degrees of freedom, on a pattern that only ever grows."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from gyrify.energy.term import Evaluation, Pattern
from gyrify.energy.total import FreePattern
from gyrify.energy.unknowns import Unknowns
from gyrify.errors import SolveError
from gyrify.solve.linear import Factor, LinearSolver
from gyrify.solve.types import FloatArray, IntArray


class System:
    """Assembles and factorises the Hessian of a sum of terms.

    The pattern is that of the cells and of a set of coupled point pairs (contact). A new coupling brings
    all nearby candidates in at once, so that the next ones need no new symbolic analysis.

    Parameters
    ----------
    free : (n_free,) int array
        Free degrees of freedom.
    n_dofs, n_dim : int
        Number of all degrees of freedom, and of those per point.
    base : Pattern
        Pattern of the cells.
    solver : LinearSolver
        Does the factorisation.
    couplings : (n_pairs, 2) int array
        Coupled pairs of points to start with.
    unknowns : Unknowns, optional
        What the free degrees of freedom follow; each is an unknown of its own by default.
    """

    def __init__(
        self,
        free: IntArray,
        n_dofs: int,
        n_dim: int,
        base: Pattern,
        solver: LinearSolver,
        couplings: IntArray,
        unknowns: Unknowns | None = None,
    ) -> None:
        self.free, self.n_dofs, self.n_dim, self.unknowns = free, n_dofs, n_dim, unknowns
        self.solver = solver
        self.analyses = self.factorizations = 0
        self._base = base
        self._set_couplings(couplings)

    def _set_couplings(self, couplings: IntArray) -> None:
        self.couplings = couplings
        rows, cols = self._coupling_entries(couplings)
        self.pattern = FreePattern(
            self.free,
            self.n_dofs,
            np.concatenate([self._base.rows, rows]),
            np.concatenate([self._base.cols, cols]),
            self.unknowns,
        )
        self.solver.analyse(self.pattern.indptr, self.pattern.cols)
        self.analyses += 1

    def _coupling_entries(self, couplings: IntArray) -> tuple[IntArray, IntArray]:
        """Upper-triangle entries of every pair of coupled points."""
        low, high = couplings.min(axis=1), couplings.max(axis=1)
        axis = np.arange(self.n_dim)
        shape = (couplings.shape[0], self.n_dim, self.n_dim)
        rows = np.broadcast_to(low[:, None, None] * self.n_dim + axis[:, None], shape)
        cols = np.broadcast_to(high[:, None, None] * self.n_dim + axis[None, :], shape)
        return rows.ravel(), cols.ravel()

    def gather(self, gradient: FloatArray) -> FloatArray:
        """(n_unknowns,) part of a gradient (n_points, n_dim) that the unknowns feel."""
        if self.unknowns is None:
            return gradient.ravel()[self.free]
        return self.unknowns.gather(gradient.ravel())

    def scatter(self, step: FloatArray) -> FloatArray:
        """(n_dofs,) change of all degrees of freedom, of a step (n_unknowns,)."""
        if self.unknowns is not None:
            return self.unknowns.scatter(step)
        full = np.zeros(self.n_dofs)
        full[self.free] = step
        return full

    def largest_force(self, gradient: FloatArray) -> float:
        """Largest Euclidean norm of the force on a free point, of a gradient (n_points, n_dim) [Pa mm]."""
        forces = np.zeros(self.n_dofs)
        forces[self.free] = gradient.ravel()[self.free]
        by_point = forces.reshape(-1, self.n_dim)
        return float(np.sqrt(np.einsum("pi,pi->p", by_point, by_point).max()))

    def assemble(self, evaluations: Sequence[Evaluation], candidates: Callable[[], IntArray]) -> FloatArray:
        """Values of the summed Hessian on the pattern; ``candidates`` gives couplings it lacks."""
        hessians = [e.hessian for e in evaluations if e.hessian is not None]
        if not all(self.pattern.holds(h.pattern) for h in hessians):
            needed = np.concatenate(
                [_pairs(h.pattern, self.n_dim) for h in hessians if h.pattern is not self._base]
            )
            merged = np.concatenate([self.couplings, candidates(), needed])
            self._set_couplings(np.unique(np.sort(merged, axis=1), axis=0))
        data = np.zeros(self.pattern.rows.size)
        for hessian in hessians:
            self.pattern.add(hessian.pattern, hessian.values, data)
        return data

    def factorise_data(self, data: FloatArray) -> Factor:
        """Factor, with its inertia, of a matrix given by its values on the pattern.

        Raises
        ------
        SolveError
            If the matrix is singular, or holds something that is no finite number.
        """
        self._begin(data)
        return self.solver.factorise(data)

    def factorise_definite(self, data: FloatArray) -> Factor | None:
        """Factor where no pivot is found negative, else None; see `LinearSolver` and `factorise_data`."""
        self._begin(data)
        return self.solver.factorise_definite(data)

    def _begin(self, data: FloatArray) -> None:
        """Count a factorisation, of numbers alone."""
        self.factorizations += 1
        self.require_numbers(data)

    def require_numbers(self, data: FloatArray) -> None:
        """Refuse values that are none: a NaN is no negative pivot, and would pass for stable.

        Raises
        ------
        SolveError
            If the matrix holds something that is no finite number.
        """
        if not np.isfinite(data).all():
            raise SolveError(
                "The stiffness matrix holds values that are not finite numbers.",
                "Raise solver.increments, or check that all stiffnesses are finite.",
            )


def _pairs(pattern: Pattern, n_dim: int) -> IntArray:
    """(n_pairs, 2) different points that a pattern couples."""
    pairs = np.stack([pattern.rows // n_dim, pattern.cols // n_dim], axis=1)
    return np.unique(pairs[pairs[:, 0] != pairs[:, 1]], axis=0)
