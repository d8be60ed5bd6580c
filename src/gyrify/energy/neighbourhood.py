"""Pairs of a contour that can touch while it moves little: searched for once, looked through often."""

from __future__ import annotations

from typing import Any

import numpy as np

from gyrify.energy.collision import CollisionContour
from gyrify.energy.term import FloatArray


class Neighbourhood:
    """Vertex-edge pairs that can come close while no vertex leaves a square about where it was.

    Two elements that come closer than a distance, after moving by at most the reach each, were closer than
    the distance and twice the reach before.

    Parameters
    ----------
    contour : CollisionContour
        The contour.
    distance : float
        How close counts [mm].
    reach : float
        Half the side of the squares [mm].
    """

    def __init__(self, contour: CollisionContour, distance: float, reach: float) -> None:
        self.contour, self.distance, self.reach = contour, distance, reach
        self._centre: FloatArray | None = None
        self._pairs: Any = None

    def holds(self, vertices: FloatArray) -> bool:
        """Whether no vertex has left its square."""
        return self._centre is not None and float(np.abs(vertices - self._centre).max()) <= self.reach

    def pairs(self, vertices: FloatArray) -> Any:
        """All pairs that may be close at (n_vertices, 2) deformed vertices [mm]; new squares if need be."""
        if not self.holds(vertices):
            self._centre = vertices
            self._pairs = self.contour.pairs(vertices, 0.5 * self.distance + self.reach)
        return self._pairs

    def collision_free_step(self, start: FloatArray, end: FloatArray) -> float:
        """Fraction of the way between two deformed states, at most 1, along which nothing meets."""
        is_known = self.holds(start) and self.holds(end)
        return self.contour.free_step(start, end, self._pairs if is_known else None)
