"""Sections of a closed surface by parallel planes, and their gyrification index."""

from __future__ import annotations

from typing import Final

import numpy as np
import shapely

from gyrify.metrics.surface import FloatArray

# Planes that cut the body, evenly spaced from end to end.
N_SECTIONS: Final = 12


def sections(corners: FloatArray, axis: int = 0, n: int = N_SECTIONS) -> list[shapely.Geometry]:
    """Regions that a closed surface bounds in planes normal to an axis.

    Parameters
    ----------
    corners : (n_faces, 3, 3) float array
        Corners of the triangles [mm].
    axis : {0, 1, 2}
        Which axis.
    n : int
        Number of planes; the body is cut into slabs of equal thickness, and each in its middle.

    Returns
    -------
    list of shapely geometries
        In the plane of the other two axes [mm].
    """
    low, high = corners[:, :, axis].min(), corners[:, :, axis].max()
    places = low + (high - low) * (np.arange(n) + 0.5) / n
    return [section(corners, axis, float(place)) for place in places]


def section(corners: FloatArray, axis: int, place: float) -> shapely.Geometry:
    """Region that a closed surface bounds in one plane; see `sections`."""
    height = corners[:, :, axis] - place
    # no point lies in the plane itself: it then counts as above
    is_above = height >= 0.0
    cut = is_above.any(axis=1) & ~is_above.all(axis=1)
    crossing, height, above = corners[cut], height[cut], is_above[cut]
    others = [k for k in range(3) if k != axis]
    points = np.full((crossing.shape[0], 3, 2), np.nan)
    for k in range(3):
        j = (k + 1) % 3
        split = above[:, k] != above[:, j]
        # from the corner above, so that both triangles at an edge find the same bits
        first = np.where(above[:, k], k, j)
        rows = np.arange(crossing.shape[0])
        second = np.where(above[:, k], j, k)
        h1, h2 = height[rows, first], height[rows, second]
        part = (h1 / np.where(split, h1 - h2, 1.0))[:, None]
        a, b = crossing[rows, first][:, others], crossing[rows, second][:, others]
        points[split, k] = (a + part * (b - a))[split]
    lines = points[~np.isnan(points[:, :, 0])].reshape(-1, 2, 2)
    rings = shapely.polygonize(list(shapely.linestrings(lines))).geoms
    region: shapely.Geometry = shapely.Polygon()
    # a ring within another one is a hole: what an even number of rings contains lies outside
    for ring in sorted(rings, key=lambda polygon: -polygon.area):
        region = region.symmetric_difference(shapely.Polygon(ring.exterior))
    return region


def section_index(region: shapely.Geometry, radius: float) -> float:
    """Length of a section's outline over that of its closing by a disc (Zilles et al. 1988).

    Parameters
    ----------
    region : shapely geometry
        The section [mm].
    radius : float
        Radius of the disc [mm].
    """
    closing = region.buffer(radius, quad_segs=32).buffer(-radius, quad_segs=32)
    outer = sum(polygon.exterior.length for polygon in _polygons(closing))
    return float(region.length / outer) if outer > 0.0 else 1.0


def _polygons(region: shapely.Geometry) -> list[shapely.Polygon]:
    return [part for part in getattr(region, "geoms", [region]) if isinstance(part, shapely.Polygon)]
