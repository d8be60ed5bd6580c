"""Stiffness of repeating columns: a band between the layers, and what couples to the columns beyond."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky_banded, solve_banded

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Bands:
    """Lower bands of three matrices: within the columns, from them to the next ones, and its transpose.

    Entry (i, j), i >= j, stands at [i - j, j].

    Attributes
    ----------
    n : int
        Unknowns.
    width : int
        Largest distance of two coupled unknowns.
    """

    n: int
    width: int
    here: FloatArray = field(init=False)
    ahead: FloatArray = field(init=False)
    back: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        for name in ("here", "ahead", "back"):
            object.__setattr__(self, name, np.zeros((self.width + 1, self.n)))

    def add(
        self, rows: IntArray, columns: IntArray, image: IntArray, other: IntArray, values: FloatArray
    ) -> None:
        """Add blocks.

        Parameters
        ----------
        rows, columns : (n, p), (n, q) int arrays
            Unknowns of each block; negative where held.
        image, other : (n, p), (n, q) int arrays
            Whether each is one of the next columns (1) or not (0).
        values : (n, p, q) float array
            The blocks.
        """
        i, j = np.broadcast_arrays(rows[:, :, None], columns[:, None, :])
        step = other[:, None, :] - image[:, :, None]
        lower = (j >= 0) & (i >= j)
        for target, ahead in ((self.here, 0), (self.ahead, 1), (self.back, -1)):
            chosen = lower & (step == ahead)
            np.add.at(target, (i[chosen] - j[chosen], j[chosen]), values[chosen])

    def solve(self, right: FloatArray) -> FloatArray:
        """Solution where all columns move alike; the matrix need not be definite."""
        lower = self.here + self.ahead + self.back
        whole = np.zeros((2 * self.width + 1, self.n))
        whole[self.width :] = lower
        for distance in range(1, self.width + 1):
            whole[self.width - distance, distance:] = lower[distance, : self.n - distance]
        solution = solve_banded((self.width, self.width), whole, right, check_finite=False)
        return np.asarray(solution, dtype=np.float64)

    def is_definite(self, phase: float) -> bool:
        """Whether waves with a phase per period of the columns have a positive definite stiffness."""
        turn = np.exp(1j * phase)
        try:
            cholesky_banded(
                self.here + turn * self.ahead + np.conj(turn) * self.back, lower=True, check_finite=False
            )
        except np.linalg.LinAlgError:
            return False
        return True
