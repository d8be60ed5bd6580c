"""What an energy term offers to the solver, and the sparse form its Hessian takes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Pattern:
    """Upper triangle of a symmetric sparsity pattern over all degrees of freedom.

    Attributes
    ----------
    rows, cols : (n_entries,) int array
        Sorted by row, then column; row <= col; no entry twice.
    """

    rows: IntArray
    cols: IntArray

    @staticmethod
    def of(rows: IntArray, cols: IntArray) -> tuple[Pattern, IntArray]:
        """Pattern of a list of entries, and the position in it of each of them."""
        low, high = np.minimum(rows, cols).astype(np.int64), np.maximum(rows, cols).astype(np.int64)
        stride = int(high.max(initial=0)) + 1
        codes, position = np.unique(low * stride + high, return_inverse=True)
        return Pattern(codes // stride, codes % stride), position.reshape(low.shape).astype(np.int64)


@dataclass(frozen=True, eq=False)
class Hessian:
    """Values on a pattern; the matrix is symmetric."""

    pattern: Pattern
    values: FloatArray


@dataclass(frozen=True, eq=False)
class Evaluation:
    """Energy of a state and, as far as asked for, its derivatives.

    Energies are per unit thickness of the slice [Pa mm^2], forces [Pa mm]. The energy is infinite, and
    the derivatives are None, where the state is not admissible (an inverted cell, a crossed contour).
    """

    value: float
    gradient: FloatArray | None = None
    hessian: Hessian | None = None


class EnergyTerm(Protocol):
    """One summand of the total energy; what it keeps between calls saves time and changes no result.

    A state u is an (n_points, n_dim) float array of displacements [mm].

    Attributes
    ----------
    is_barrier : bool
        Whether it only keeps things apart: few entries, and a curvature that is negative where they turn
        about each other.
    """

    is_barrier: bool

    def evaluate(self, u: FloatArray, order: int, project_psd: bool = False) -> Evaluation:
        """Energy (order 0), with gradient (1), with Hessian (2), optionally projected per cell or pair."""
        ...

    def max_step(self, u: FloatArray, du: FloatArray) -> float:
        """Largest fraction of the step du, at most 1, that keeps the state admissible."""
        ...
