"""Ellipsoid, solid or hollow: grey on the outside, white inside."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from gyrify.mesh.nested_surface import NestedSurface, icosphere, nearest_frequency
from gyrify.mesh.shapes.shape import FloatArray, require_white_matter


@dataclass(frozen=True)
class Ellipsoid:
    """Wall between the ellipsoids h (a, b, c) and (a, b, c), with the interface on (a - T, b - T, c - T).

    Attributes
    ----------
    semi_axes : (float, float, float)
        Outer semi-axes along x, y, z [mm].
    hole_fraction : float
        Semi-axes of the hole over those of the outer surface, h; 0 for a solid body.
    cortical_thickness : float
        Thickness T of the grey layer on the axes [mm].

    Raises
    ------
    MeshError
        If no white matter is left.
    """

    semi_axes: tuple[float, float, float]
    hole_fraction: float
    cortical_thickness: float
    n_dim: ClassVar[int] = 3
    periods: ClassVar[None] = None

    def __post_init__(self) -> None:
        require_white_matter(self.cortical_thickness, self.narrowest_wall)

    @property
    def is_solid(self) -> bool:
        """See `SolidShape`."""
        return self.hole_fraction == 0.0

    @property
    def narrowest_wall(self) -> float:
        """See `SolidShape`."""
        return min(self.semi_axes) * (1.0 - self.hole_fraction)

    @property
    def wall(self) -> tuple[float, float]:
        """See `SolidShape`: that of the sphere of equal volume."""
        T = self.cortical_thickness
        return self._radius * (1.0 - self.hole_fraction) - T, T

    @property
    def _radius(self) -> float:
        return float(np.cbrt(np.prod(self.semi_axes)))

    def surface(self, edge: float, n_halvings: int) -> NestedSurface:
        """See `SolidShape`.

        On the sphere points are as dense as areas of the ellipsoid are large: exactly so about the axes.
        """
        surface = icosphere(nearest_frequency(edge / self._radius) * 2**n_halvings)
        axes = np.array(self.semi_axes)
        if np.ptp(axes) == 0.0:
            return surface
        places = surface.places / np.cbrt(axes)
        return replace(surface, places=places / np.linalg.norm(places, axis=1, keepdims=True))

    def edge(self, surface: NestedSurface, depth: float) -> float:
        """See `SolidShape`: of equilateral triangles that cover the sphere of equal volume."""
        axes = np.array([axis[0] for axis in self._axes(np.array([depth]))])
        n = surface.triangles[-1].shape[0]
        return float(np.cbrt(np.prod(axes)) * np.sqrt(16.0 * np.pi / (np.sqrt(3.0) * n)))

    def points(self, places: FloatArray, depth: FloatArray) -> FloatArray:
        """See `SolidShape`; parameters are directions on the unit sphere."""
        return np.stack(self._axes(depth), axis=1) * places

    def normals(self, points: FloatArray, depth: FloatArray) -> FloatArray:
        """See `SolidShape`: those of the ellipsoids through the places."""
        normal = points / np.square(np.stack(self._axes(depth), axis=1))
        return np.asarray(normal / np.linalg.norm(normal, axis=1, keepdims=True))

    def moved(self, places: FloatArray, depth: FloatArray, shift: FloatArray) -> FloatArray:
        """See `SolidShape`; what leaves the unit sphere is taken back to it."""
        axes = np.stack(self._axes(depth), axis=1)
        is_place = np.linalg.norm(places, axis=1) > 0.0
        moved = places + np.where(is_place[:, None], shift / np.where(axes > 0.0, axes, 1.0), 0.0)
        size = np.linalg.norm(moved, axis=1, keepdims=True)
        return np.asarray(np.where(size > 0.0, moved / np.where(size > 0.0, size, 1.0), 0.0))

    def _axes(self, depth: FloatArray) -> list[FloatArray]:
        """Semi-axes [mm] of the ellipsoid at a depth."""
        T, white, grey = self.cortical_thickness, np.minimum(depth, 1.0), np.maximum(depth - 1.0, 0.0)
        holes = [self.hole_fraction * axis for axis in self.semi_axes]
        return [
            hole + white * (axis - T - hole) + grey * T
            for axis, hole in zip(self.semi_axes, holes, strict=True)
        ]
