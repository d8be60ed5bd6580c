"""A body inside a closed surface of triangles, with or without a hole."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gyrify.mesh.shapes.shape import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class SurfaceBody:
    """What lies between an outer surface and, if there is one, the surface of a hole.

    Attributes
    ----------
    points : (n_points, 3) float array
        Of the outer surface [mm].
    triangles : (n, 3) int array
        Outwards counter-clockwise.
    cortical_thickness : float
        Thickness T of the grey layer [mm].
    mean_radius : float
        Of the ball of equal volume [mm].
    hole : ((n, 3) float array, (n, 3) int array) or None
        Points [mm] and triangles of a hole.
    interface : (n_points, 3) float array or None
        Points of the interface under those of the surface; None where it is laid T below [mm].
    """

    points: FloatArray
    triangles: IntArray
    cortical_thickness: float
    mean_radius: float
    hole: tuple[FloatArray, IntArray] | None = None
    interface: FloatArray | None = None
    n_dim: ClassVar[int] = 3
    periods: ClassVar[None] = None

    @property
    def is_solid(self) -> bool:
        """Whether there is no hole."""
        return self.hole is None

    @property
    def wall(self) -> tuple[float, float]:
        """Thickness of white matter, that of the ball of equal volume, and of the cortex [mm]."""
        return self.mean_radius - self.cortical_thickness, self.cortical_thickness

    @property
    def narrowest_wall(self) -> float:
        """No wall is wider than half the smallest extent [mm]."""
        return float(0.5 * np.ptp(self.points, axis=0).min())
