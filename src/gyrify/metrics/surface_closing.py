"""Morphological closing of a solid in space by a ball: the area of its outline, and depths below it.

The solid is dilated by the ball's radius, and what is dilated is eroded by it. Both outlines are level sets
of distances. These are read on a grid: roughly everywhere, and from points on the surface next to the level,
so that the error is of the order of the square of the grid's spacing (0.3 % of the area of a sphere).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
from scipy import ndimage
from scipy.spatial import cKDTree

from gyrify.metrics.surface import FloatArray, face_areas, sampled

# Spacings of the grid to a radius, and how far from a level distances are read exactly, in spacings.
PER_RADIUS: Final = 4.0
# The same for a patch, whose straight valleys are creases of the outline: there the grid cuts off most.
PER_RADIUS_OF_A_PATCH: Final = 6.0
_BAND: Final = 2.5
# Half the width over which a period's weight falls to nothing, in spacings.
_RAMP: Final = 2.0


@dataclass(frozen=True, eq=False)
class SurfaceClosing:
    """Closing of what a surface encloses, or of what lies below a periodic one.

    Attributes
    ----------
    corners : (n, 3, 3) float array
        Corners of the triangles of the surface, or of one period of it [mm].
    radius : float
        Radius of the ball [mm].
    periods : (float, float) or None
        Periods in x and y [mm].
    """

    corners: FloatArray
    radius: float
    periods: tuple[float, float] | None = None

    @property
    def spacing(self) -> float:
        """Spacing of the grid [mm]."""
        return self.radius / (PER_RADIUS if self.periods is None else PER_RADIUS_OF_A_PATCH)

    @property
    def _beyond(self) -> float:
        """How far the grid goes on beyond a period: what is weighed must not feel its end [mm]."""
        return self.radius + (_RAMP + 3.0) * self.spacing

    @cached_property
    def _grid(self) -> tuple[FloatArray, FloatArray]:
        """First place of the grid, and distances to the solid from its places, 0 inside [mm]."""
        h, points = self.spacing, sampled(self._around(self.corners), 0.5 * self.spacing)
        low, high = points.min(axis=0) - self.radius - 3.0 * h, points.max(axis=0) + self.radius + 3.0 * h
        if self.periods is not None:
            # within the images, so that the surface cuts the grid in two
            low[:2] = -self._beyond
            high[:2] = np.array(self.periods) + self._beyond
            low[2] += self.radius
        shape = np.ceil((high - low) / h).astype(int) + 1
        place = np.round((points - low) / h).astype(int)
        place = place[np.all((place >= 0) & (place < shape), axis=1)]
        is_surface = np.zeros(shape, dtype=bool)
        is_surface[tuple(place.T)] = True
        parts, _ = ndimage.label(~is_surface)
        distance = h * ndimage.distance_transform_edt(parts == parts[0, 0, -1])
        self._read_exactly(low, distance, _tree(points))
        return low, distance

    def _around(self, corners: FloatArray) -> FloatArray:
        """Triangles with their images next to them."""
        if self.periods is None:
            return corners
        extent = float(np.ptp(corners[:, :, :2], axis=1).max())
        margin, (x, y) = self._beyond + self.radius + extent, self.periods
        shifts = [
            (i * x, j * y, 0.0)
            for i in range(-int(np.ceil(margin / x)), int(np.ceil(margin / x)) + 1)
            for j in range(-int(np.ceil(margin / y)), int(np.ceil(margin / y)) + 1)
        ]
        images = np.concatenate([corners + shift for shift in shifts])
        middle = images.mean(axis=1)[:, :2]
        near = np.all((middle > -margin) & (middle < np.array([x, y]) + margin), axis=1)
        return np.asarray(images[near])

    def _read_exactly(self, origin: FloatArray, distance: FloatArray, points: cKDTree) -> None:
        """Replace distances next to the radius by those to points."""
        near = np.argwhere(np.abs(distance - self.radius) < _BAND * self.spacing)
        exact, _ = points.query(origin + self.spacing * near)
        distance[tuple(near.T)] = exact

    @cached_property
    def _offset_points(self) -> cKDTree:
        """Points on the outline of the dilated solid."""
        origin, distance = self._grid
        outline = _level_set(origin, distance, self.radius, self.spacing)
        return _tree(sampled(outline, 0.5 * self.spacing))

    @cached_property
    def area(self) -> float:
        """Area of the closing's outline, or of one period of it [mm^2]."""
        origin, distance = self._grid
        inwards = self.spacing * ndimage.distance_transform_edt(distance < self.radius)
        self._read_exactly(origin, inwards, self._offset_points)
        outline = _level_set(origin, inwards, self.radius, self.spacing)
        areas = face_areas(outline)
        if self.periods is not None:
            middle = outline.mean(axis=1)
            for axis, period in enumerate(self.periods):
                areas = areas * _share(middle[:, axis], period, _RAMP * self.spacing)
        return float(areas.sum())

    def depth(self, points: FloatArray) -> FloatArray:
        """(n,) depth of points of the solid below the closing's outline [mm], at least 0."""
        distance, _ = self._offset_points.query(points)
        return np.asarray(np.maximum(distance - self.radius, 0.0))


def _tree(points: FloatArray) -> cKDTree:
    """Search tree of points that lie dense on a surface, for places that are about as far from many of them.

    Leaves of a tree that is not balanced are cubes, which leave out more: a third of the time.
    """
    return cKDTree(points, leafsize=32, compact_nodes=False, balanced_tree=False)


def _share(x: FloatArray, period: float, width: float) -> FloatArray:
    """Weights that sum to 1 over a place and its images, without an edge that would cut triangles."""
    overlap = np.minimum(x + width, period) - np.maximum(x - width, 0.0)
    return np.asarray(np.maximum(overlap, 0.0) / (2.0 * width))


def _level_set(origin: FloatArray, values: FloatArray, level: float, spacing: float) -> FloatArray:
    """(n, 3, 3) triangles where values on a grid have a level."""
    from skimage.measure import marching_cubes

    found: Any = marching_cubes  # its library is not typed
    vertices, faces, _, _ = found(values, level, spacing=(spacing,) * 3)
    return np.asarray(origin + vertices.astype(np.float64)[faces])
