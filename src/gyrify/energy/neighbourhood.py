"""Pairs of a contour that can touch while it moves little: searched for once, looked through often."""

from __future__ import annotations

import ipctk
import numpy as np

from gyrify.energy.term import FloatArray


class Neighbourhood:
    """Vertex-edge pairs that can come close while no vertex leaves a square about where it was.

    Two elements that come closer than a distance, after moving by at most the reach each, were closer than
    the distance and twice the reach before.

    Parameters
    ----------
    mesh : ipctk.CollisionMesh
        The contour.
    distance : float
        How close counts [mm].
    reach : float
        Half the side of the squares [mm].
    """

    def __init__(self, mesh: ipctk.CollisionMesh, distance: float, reach: float) -> None:
        self.mesh, self.distance, self.reach = mesh, distance, reach
        self._centre: FloatArray | None = None
        self._pairs = ipctk.Candidates()

    def holds(self, vertices: FloatArray) -> bool:
        """Whether no vertex has left its square."""
        return self._centre is not None and float(np.abs(vertices - self._centre).max()) <= self.reach

    def pairs(self, vertices: FloatArray) -> ipctk.Candidates:
        """All pairs that may be close at (n_vertices, 2) deformed vertices [mm]; new squares if need be."""
        if not self.holds(vertices):
            self._centre = vertices
            self._pairs.build(self.mesh, vertices, 0.5 * self.distance + self.reach)
        return self._pairs

    def collision_free_step(self, start: FloatArray, end: FloatArray) -> float:
        """Fraction of the way between two deformed states, at most 1, along which nothing meets."""
        if self.holds(start) and self.holds(end):
            return float(self._pairs.compute_collision_free_stepsize(self.mesh, start, end))
        return float(ipctk.compute_collision_free_stepsize(self.mesh, start, end))
