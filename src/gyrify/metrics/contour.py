"""Closed contours as plain arrays: outline of the tissue, its offset and its closing, distances to a line."""

from __future__ import annotations

import math
from typing import TypeVar

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from gyrify.base.arguments import real_number
from gyrify.errors import ConfigError, MeshError

FloatArray = NDArray[np.float64]
Scalar = TypeVar("Scalar", bound=np.generic)

# Segments per quarter circle of an offset curve: its length is then true to 1e-4 of its arcs. Discs larger
# than the body get more, so that it is true to 1e-4 of the body.
QUARTER_SEGMENTS = 32
# Radius over that of a circle of the body's outline, above which closing and hull differ by less than 1e-6.
LARGEST_RADIUS = 1000.0
# The same, above which the hull is drawn: an erosion smooths what is smaller than a hundredth of the radius.
WIDEST_DRAWN = 100.0

# Entries of a dense distance matrix handled at once: the temporaries stay in the cache.
BLOCK = 16_000


def as_contour(contour: ArrayLike) -> FloatArray:
    """Return the vertices of a closed contour as an array, the repeated last vertex dropped.

    Parameters
    ----------
    contour : (n, 2) array_like
        Vertices in order [mm], in either direction, with or without the first one repeated at the end.

    Returns
    -------
    (n, 2) float array

    Raises
    ------
    MeshError
        If it is not a list of at least three finite points of the plane.
    """
    try:
        vertices = np.ascontiguousarray(contour, dtype=np.float64)
    except (TypeError, ValueError):
        vertices = np.empty(0)
    if vertices.ndim == 2 and len(vertices) > 1 and np.array_equal(vertices[0], vertices[-1]):
        vertices = vertices[:-1]
    if vertices.ndim != 2 or vertices.shape[1] != 2 or len(vertices) < 3:
        raise MeshError(
            f"A contour needs an (n, 2) array of three or more vertices, not shape {np.shape(contour)}.",
            "Pass the deformed positions of the contour points.",
        )
    if not np.isfinite(vertices).all():
        raise MeshError("The contour has vertices that are not finite.", "Check the state it was taken from.")
    return vertices


def as_points(points: ArrayLike) -> FloatArray:
    """Return (k, 2) finite points of the plane [mm] as an array.

    Raises
    ------
    MeshError
        If they are none.
    """
    try:
        found = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    except (TypeError, ValueError):
        found = np.full((1, 2), np.nan)
    if not np.isfinite(found).all():
        raise MeshError("The points are not finite points of the plane.", "Pass a (k, 2) array of numbers.")
    return found


def require_positive(name: str, value: object, unit: str = "mm") -> float:
    """Return a positive finite number as a float, or raise `ConfigError`."""
    number = real_number(name, value)
    if not (math.isfinite(number) and number > 0):
        raise ConfigError(
            f"{name} = {number:g} {unit} is out of range: it must be > 0.", f"Give {name} in {unit}."
        )
    return number


def self_intersecting(contour: ArrayLike) -> bool:
    """Whether a closed contour crosses or touches itself.

    Parameters
    ----------
    contour : (n, 2) array_like
        Vertices in order [mm].

    Returns
    -------
    bool

    Raises
    ------
    MeshError
        If the contour is malformed.
    """
    return not shapely.linearrings(as_contour(contour)).is_simple


def filled(contour: FloatArray) -> shapely.Polygon:
    """Return all that a closed contour encloses, without holes, as one polygon.

    A simple contour is its own boundary. Where it crosses itself, every enclosed face counts as tissue and
    the outline runs along the outside of their union: overlapping sulcal walls are hidden in it.
    """
    ring = shapely.linearrings(contour)
    if ring.is_simple:
        return shapely.Polygon(ring)
    faces = shapely.polygonize([shapely.node(ring)])
    return shapely.Polygon(_largest(shapely.union_all(faces.geoms)).exterior)


def mean_radius(polygon: shapely.Polygon) -> float:
    """Radius [mm] of the circle whose circumference is the length of the outline."""
    return float(polygon.exterior.length) / (2 * math.pi)


def fitting_radius(polygon: shapely.Polygon, radius: float) -> float:
    """Return the radius [mm]; one far larger than the body is cut, as its closing is the hull anyway."""
    return min(radius, LARGEST_RADIUS * mean_radius(polygon))


def offset_outline(
    polygon: shapely.Polygon, radius: float, segments: int | None = None
) -> shapely.LinearRing:
    """Return the outer boundary of everything within ``radius`` [mm] of the polygon.

    The arcs have so many segments a quarter, by default as many as the length of the closing needs.
    """
    return polygon.buffer(radius, quad_segs=segments or _segments(polygon, radius)).exterior


def _segments(polygon: shapely.Polygon, radius: float) -> int:
    """Segments of a quarter circle.

    The closing's outline is the difference of two lengths that grow with the radius: the chords of a disc
    much larger than the body would miss more of the arcs than the body has of outline.
    """
    return math.ceil(QUARTER_SEGMENTS * math.sqrt(max(1.0, radius / mean_radius(polygon))))


def closing_of(vertices: FloatArray, closing_radius: float) -> FloatArray:
    """`closing_outline` of a contour that is known to be one, such as that of a stored state."""
    tissue = filled(vertices)
    if closing_radius > WIDEST_DRAWN * mean_radius(tissue):
        return ring_vertices(tissue.convex_hull.exterior)
    dilated = shapely.Polygon(offset_outline(tissue, closing_radius))
    closed = dilated.buffer(-closing_radius, quad_segs=_segments(tissue, closing_radius))
    return ring_vertices(_largest(closed).exterior)


def resample(contour: FloatArray, samples: int, *, keep_vertices: bool = False) -> FloatArray:
    """Return points at equal arc length along a closed polygon, if asked together with its vertices."""
    ring = np.concatenate([contour, contour[:1]])
    arc = np.concatenate([[0.0], np.cumsum(edge_lengths(contour))])
    at = np.arange(samples) * (arc[-1] / samples)
    if keep_vertices:
        at = np.sort(np.concatenate([at, arc[1:-1]]))
    return np.column_stack([np.interp(at, arc, ring[:, 0]), np.interp(at, arc, ring[:, 1])])


def vertex_numbers(contour: FloatArray, samples: int) -> FloatArray:
    """Return where the points of `resample` with vertices lie, counted in vertices from the first one."""
    arc = np.concatenate([[0.0], np.cumsum(edge_lengths(contour))])
    at = np.sort(np.concatenate([np.arange(samples) * (arc[-1] / samples), arc[1:-1]]))
    return np.asarray(np.interp(at, arc, np.arange(len(arc))), dtype=np.float64)


def ring_vertices(ring: shapely.LinearRing) -> FloatArray:
    """Return the (n, 2) vertices of a ring, the first one not repeated."""
    vertices: FloatArray = shapely.get_coordinates(ring)[:-1]
    return vertices


def following(values: NDArray[Scalar]) -> NDArray[Scalar]:
    """Return ``np.roll(values, -1, axis=0)``, the next entry along a closed contour, several times faster."""
    return np.concatenate([values[1:], values[:1]])


def edge_lengths(contour: FloatArray) -> FloatArray:
    """Return the (n,) lengths of the edges of a closed polygon; edge i starts at vertex i."""
    edges = following(contour) - contour
    lengths: FloatArray = np.hypot(edges[:, 0], edges[:, 1])
    return lengths


def distance_to_line(points: FloatArray, line: FloatArray, *, closed: bool = True) -> FloatArray:
    """Return the (m,) shortest distances from (m, 2) points to a polyline with (k, 2) vertices.

    Dense: for the few hundred points and edges of a slice this beats building a search tree.
    """
    start = line[:, 0] + 1j * line[:, 1]
    edge = following(start) - start
    if not closed:
        start, edge = start[:-1], edge[:-1]
    keep = edge != 0
    start, edge = start[keep], edge[keep]
    inverse, squared_length = 1 / edge, edge.real**2 + edge.imag**2
    position = points[:, 0] + 1j * points[:, 1]
    nearest = np.empty(len(points))
    block = max(1, BLOCK // len(edge))
    for first in range(0, len(points), block):
        # Along the edge (real) and across it (imaginary), both in edge lengths.
        local = (position[first : first + block, None] - start) * inverse
        beyond = local.real - np.clip(local.real, 0.0, 1.0)
        squared = (beyond**2 + local.imag**2) * squared_length
        nearest[first : first + block] = squared.min(axis=1)
    return np.sqrt(nearest)


def _largest(geometry: shapely.Geometry) -> shapely.Polygon:
    """Return the polygon itself, or the largest part of several."""
    return max(shapely.get_parts(geometry), key=shapely.area)
