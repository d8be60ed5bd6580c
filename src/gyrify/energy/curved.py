"""Cells whose volume ratio varies inside them: whether they are positive all over, and for how long."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from types import ModuleType
from typing import Final

import numpy as np

from gyrify.energy import bernstein, bernstein_space
from gyrify.energy.term import FloatArray, IntArray

# How far the least volume ratio of a cell may lie above what is given for it, over the larger of it and 1.
RATIO_TOLERANCE: Final = 1e-6
# A step stops short of an inversion, as it does of contact.
SAFETY: Final = 0.9


@dataclass(frozen=True, eq=False)
class CurvedCells:
    """Quadratic triangles or tetrahedra, with bounds over the whole of each.

    Attributes
    ----------
    cells : (n_cells, n_nodes) int array
        Point indices; 6 nodes in the plane, 10 in space.
    points : (n_cells, n_nodes, n_dim) float array
        Reference coordinates of the nodes of each cell [mm].
    """

    cells: IntArray
    points: FloatArray

    @staticmethod
    def of(cell_points: FloatArray, cells: IntArray) -> CurvedCells | None:
        """Cells with (n_cells, n_nodes, n_dim) node coordinates [mm]; None where F is constant in each."""
        _, n_nodes, n_dim = cell_points.shape
        if n_nodes == n_dim + 1:
            return None
        return CurvedCells(np.ascontiguousarray(cells), np.ascontiguousarray(cell_points))

    @property
    def _bounds(self) -> ModuleType:
        """Compiled bounds of cells of this dimension."""
        return bernstein if self.points.shape[2] == 2 else bernstein_space

    @cached_property
    def areas(self) -> FloatArray:
        """(n_cells,) reference areas of triangles [mm^2]."""
        return np.asarray(0.5 * self._coefficients(np.zeros((int(self.cells.max()) + 1, 2)))[1])

    def smaller_than(self, u: FloatArray, ratio: float) -> IntArray:
        """Triangles that may somewhere be smaller than a ratio of their reference size in a state u [mm]."""
        return np.flatnonzero(~(self._coefficients(u)[0] >= ratio * 2.0 * self.areas))

    def _coefficients(self, u: FloatArray) -> FloatArray:
        """(2, n_cells) least and mean Bernstein coefficient of det(dx/dxi) of each cell."""
        found = np.empty((2, self.cells.shape[0]))
        bernstein.least_coefficients(u, self.cells, self.points, found[0], found[1])
        return found

    def first_inverted(self, u: FloatArray) -> int | None:
        """Number of the first cell not proven positive all over in a state u [mm]; None if all are."""
        found = int(self._bounds.first_inverted(u, self.cells, self.points))
        return None if found < 0 else found

    def largest_step(self, u: FloatArray, du: FloatArray) -> float:
        """Largest safe fraction of du, at most 1: no cell is inverted anywhere on the path up to it."""
        step = float(self._bounds.largest_step(u, du, self.cells, self.points))
        return 1.0 if step >= 1.0 else SAFETY * step

    def least_ratio(self, u: FloatArray) -> FloatArray:
        """(n_cells,) least det F over each cell, from below, within `RATIO_TOLERANCE`."""
        ratio = np.empty(self.cells.shape[0])
        self._bounds.least_ratios(u, self.cells, self.points, RATIO_TOLERANCE, ratio)
        return ratio
