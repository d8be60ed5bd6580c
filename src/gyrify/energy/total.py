"""Total energy: the sum of terms restricted to the free degrees of freedom."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gyrify.energy.cell import scatter_add
from gyrify.energy.term import EnergyTerm, Evaluation, FloatArray, IntArray, Pattern
from gyrify.energy.unknowns import Unknowns


class FreePattern:
    """Superset of the sparsity of all terms, on the free degrees of freedom only.

    Parameters
    ----------
    free : (n_free,) int array
        Free degrees of freedom in increasing order, of ``n_dofs``.
    n_dofs : int
        Number of all degrees of freedom.
    rows, cols : int arrays
        Entries of the upper triangle, in all degrees of freedom, in any order and number.
    unknowns : Unknowns, optional
        What the free degrees of freedom follow; then the pattern is that of these unknowns.
    """

    def __init__(
        self, free: IntArray, n_dofs: int, rows: IntArray, cols: IntArray, unknowns: Unknowns | None = None
    ) -> None:
        self.free, self.n_dofs, self.unknowns = free, n_dofs, unknowns
        self.size = free.size if unknowns is None else unknowns.size
        if unknowns is None:
            self._number = np.full(n_dofs, -1, dtype=np.int64)
            self._number[free] = np.arange(free.size)
        else:
            self._number = unknowns.number
        diagonal = np.arange(self.size) * (self.size + 1)
        # Mostly sorted already, so that a stable sort is much faster than numpy.unique.
        codes = np.sort(np.concatenate([self._placed(rows, cols)[1], diagonal]), kind="stable")
        self._codes = codes[np.concatenate([[True], codes[1:] != codes[:-1]])]
        self.rows, self.cols = self._codes // self.size, self._codes % self.size
        self.indptr = np.searchsorted(self.rows, np.arange(self.size + 1))
        self._maps: dict[int, tuple[Pattern, IntArray, IntArray]] = {}

    def _placed(self, rows: IntArray, cols: IntArray) -> tuple[IntArray, IntArray]:
        """Which entries lie among the unknowns, and the code of each."""
        low, high = self._number[rows], self._number[cols]
        if self.unknowns is not None:
            low, high = np.minimum(low, high), np.maximum(low, high)
        source = np.flatnonzero((low >= 0) & (high >= 0))
        return source, low[source] * self.size + high[source]

    def holds(self, pattern: Pattern) -> bool:
        """Whether every free entry of a term's pattern is in this one."""
        return self._map(pattern) is not None

    def add(self, pattern: Pattern, values: FloatArray, data: FloatArray) -> None:
        """Add a term's values to the data of the whole; the pattern must be held."""
        mapped = self._map(pattern)
        if mapped is None:
            raise ValueError("the pattern of a term is not held by the pattern of the sum")
        scatter_add(*mapped, values if self.unknowns is None else values * self._weight(pattern), data)

    def _weight(self, pattern: Pattern) -> FloatArray:
        """Factor of each entry: the signs, and 2 where both triangles of it fall on one diagonal entry."""
        if self.unknowns is None:
            raise ValueError("free degrees of freedom are unknowns themselves")
        sign, rows, cols = self.unknowns.sign, pattern.rows, pattern.cols
        is_folded = (rows != cols) & (self._number[rows] == self._number[cols])
        return np.asarray(sign[rows] * sign[cols] * np.where(is_folded, 2.0, 1.0))

    def _map(self, pattern: Pattern) -> tuple[IntArray, IntArray] | None:
        """Which entries of a term go where; kept for as long as the term keeps its pattern."""
        known = self._maps.get(id(pattern))
        if known is not None and known[0] is pattern:
            return known[1], known[2]
        source, codes = self._placed(pattern.rows, pattern.cols)
        target = np.minimum(np.searchsorted(self._codes, codes), self._codes.size - 1)
        if not np.array_equal(self._codes[target], codes):
            return None
        if codes.size >= self.size:
            self._maps[id(pattern)] = (pattern, source, target)
        return source, target


class TotalEnergy:
    """Sum of energy terms; the solver sees nothing else.

    Parameters
    ----------
    terms : sequence of EnergyTerm
        The summands.
    """

    def __init__(self, terms: Sequence[EnergyTerm]) -> None:
        self.terms = tuple(terms)

    def value(self, u: FloatArray) -> float:
        """Total energy [Pa mm^2]; infinite where the state is not admissible."""
        total = 0.0
        for term in self.terms:
            total += term.evaluate(u, 0).value
            if not np.isfinite(total):
                return np.inf
        return total

    def slope(self, u: FloatArray) -> tuple[float, FloatArray]:
        """Total energy [Pa mm^2] and its gradient [Pa mm]; infinite and zero where not admissible."""
        total, gradient = 0.0, np.zeros_like(u)
        for term in self.terms:
            evaluation = term.evaluate(u, 1)
            total += evaluation.value
            if evaluation.gradient is None:
                return np.inf, np.zeros_like(u)
            gradient += evaluation.gradient
        return total, gradient

    def evaluate(self, u: FloatArray, project_psd: bool) -> list[Evaluation]:
        """Each term with its Hessian, for the solver to sum on a pattern that holds them all."""
        return [term.evaluate(u, 2, project_psd) for term in self.terms]

    def project_barriers(self, u: FloatArray, evaluations: Sequence[Evaluation]) -> list[Evaluation] | None:
        """The same with the Hessians of barriers projected; None where no barrier acts."""
        acting = [
            term.is_barrier and known.hessian is not None and known.hessian.values.size > 0
            for term, known in zip(self.terms, evaluations, strict=True)
        ]
        if not any(acting):
            return None
        both = zip(self.terms, evaluations, acting, strict=True)
        return [term.evaluate(u, 2, True) if acts else known for term, known, acts in both]

    def max_step(self, u: FloatArray, du: FloatArray) -> float:
        """Largest fraction of du, at most 1, that every term admits."""
        step = 1.0
        for term in self.terms:
            step = min(step, term.max_step(u, step * du) * step)
        return step

    def limiting(self, u: FloatArray, du: FloatArray) -> EnergyTerm:
        """The term that admits the least of du."""
        return min(self.terms, key=lambda term: term.max_step(u, du))
