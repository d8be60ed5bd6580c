"""All metrics of one state of a body in space, sharing what they have in common."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar

import numpy as np
from scipy.spatial import ConvexHull

from gyrify.base.tiling import tiled
from gyrify.metrics.surface import (
    FloatArray,
    IntArray,
    enclosed_volume,
    face_areas,
    laplacian,
    mean_curvature,
    roughness,
    vertex_areas,
)
from gyrify.metrics.surface_closing import SurfaceClosing
from gyrify.metrics.surface_folds import SurfaceFolds
from gyrify.metrics.surface_pairs import crosses_itself, distances_to, smallest_gap
from gyrify.metrics.surface_sections import section_index, sections

# Wavelength that is smoothed away by half, over the radius of the closing: about the size of the body.
_CUTOFF = 8.0


@dataclass(frozen=True, eq=False)
class DeformedSurface:
    """Outer surface of a deformed body with its interface; each part is computed when it is first read.

    Attributes
    ----------
    points : (n, 3) float array
        Points of the outer surface [mm].
    faces : (n_faces, 3) int array
        Its triangles, counter-clockwise seen from outside.
    inner : (m, 3) float array
        Points of the grey-white interface [mm].
    inner_faces : (m_faces, 3) int array
        Its triangles.
    closing_radius, gyrus_prominence : float
        Radius of the closing, smallest prominence of gyri and sulci [mm].
    periods : (float, float) or None
        Periods in x and y of a patch [mm].
    reference : (n, 3) float array
        Points before growth: which corners of a patch lie across a period is told from them.
    """

    points: FloatArray
    faces: IntArray
    inner: FloatArray
    inner_faces: IntArray
    closing_radius: float
    gyrus_prominence: float
    periods: tuple[float, float] | None = None
    reference: FloatArray = field(default_factory=lambda: np.empty((0, 3)))
    n_dim: ClassVar[int] = 3

    @cached_property
    def corners(self) -> FloatArray:
        """(n_faces, 3, 3) corners of the triangles, those of one triangle next to each other [mm]."""
        if self.periods is None:
            return self.points[self.faces]
        points, triangles = self._whole
        return points[triangles[: self.faces.shape[0]]]

    @cached_property
    def area(self) -> float:
        """Of the surface [mm^2]."""
        return float(face_areas(self.corners).sum())

    @cached_property
    def volume(self) -> float | None:
        """Within a closed surface [mm^3]."""
        return enclosed_volume(self.corners) if self.periods is None else None

    @cached_property
    def hull_area(self) -> float:
        """Of the convex hull; of a patch, of its two periods [mm^2]."""
        if self.periods is not None:
            return self.periods[0] * self.periods[1]
        return float(ConvexHull(self.points).area)

    @cached_property
    def closing(self) -> SurfaceClosing:
        """Closing by a ball."""
        return SurfaceClosing(self.corners, self.closing_radius, self.periods)

    @cached_property
    def section_index(self) -> float | None:
        """Mean index of the sections along x."""
        if self.periods is not None:
            return None
        found = [section_index(region, self.closing_radius) for region in sections(self.corners)]
        return float(np.mean(found))

    @cached_property
    def depth(self) -> FloatArray:
        """(n,) depth of the points below the outline of the closing [mm]."""
        return self.closing.depth(self.points)

    @cached_property
    def folds(self) -> SurfaceFolds:
        """Crowns and fundi."""
        return SurfaceFolds.of(self.depth, self.faces, self.gyrus_prominence)

    @cached_property
    def fundus_depth(self) -> FloatArray:
        """(n,) depth of each fundus [mm]; one zero without folds."""
        return self.depth[self.folds.fundi] if self.folds.fundi.size else np.zeros(1)

    @cached_property
    def thickness(self) -> tuple[float, float]:
        """Mean cortical thickness on gyri and at fundi, or all over without folds [mm].

        Crowns are ridges: what lies no deeper below the closing than the prominence counts.
        """
        shallow = np.flatnonzero(self.depth <= self.depth.min() + self.gyrus_prominence)
        fundi = self.folds.fundi if self.folds.fundi.size else shallow
        places = (shallow, fundi)
        inner = self.inner[self.inner_faces]
        if self.periods is not None:
            step = inner[:, :, :2] - inner[:, :1, :2]
            inner[:, :, :2] -= np.array(self.periods) * np.round(step / np.array(self.periods))
        return tuple(float(distances_to(self.points[at], inner).mean()) for at in places)  # type: ignore[return-value]

    @cached_property
    def mean_curvature(self) -> float:
        """Mean of |H| over the surface [1/mm]."""
        areas = vertex_areas(self.points.shape[0], self.faces, self.corners)
        return float(areas @ np.abs(mean_curvature(self.points, self.faces, self.corners)) / areas.sum())

    @cached_property
    def wavelength(self) -> float:
        """Wavelength 2 pi rms(h) / rms(grad h) of the height h above the smoothed surface [mm].

        0 without folds.
        """
        if self.folds.fundi.size == 0:
            return 0.0
        n, areas = self.points.shape[0], vertex_areas(self.points.shape[0], self.faces, self.corners)
        origin = self.reference if self.periods is not None else None
        cutoff = _CUTOFF * self.closing_radius
        height = roughness(self.points, self.faces, self.corners, cutoff, origin)
        slope = height @ (laplacian(n, self.faces, self.corners) @ height)
        return float(2.0 * np.pi * np.sqrt(areas @ height**2 / slope))

    @cached_property
    def crosses_itself(self) -> bool:
        """Whether the surface does."""
        return crosses_itself(*self._whole)

    @cached_property
    def _whole(self) -> tuple[FloatArray, IntArray]:
        """Points and triangles; of a patch with its images around."""
        if self.periods is None:
            return self.points, self.faces
        source, turns, triangles = tiled(self.reference, self.faces, self.periods)
        points = self.points[source]
        points[:, :2] += turns * np.array(self.periods)
        return points, triangles

    @cached_property
    def gap(self) -> float:
        """Smallest way across a sulcus; 0 where the surface crosses itself [mm]."""
        if self.crosses_itself:
            return 0.0
        return smallest_gap(*self._whole)
