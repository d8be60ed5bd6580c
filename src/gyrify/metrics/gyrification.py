"""The gyrification index: contour length over exposed length, in three definitions."""

from __future__ import annotations

import math
from typing import Literal, get_args

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from gyrify.errors import ConfigError, MeshError
from gyrify.metrics.contour import (
    FloatArray,
    edge_lengths,
    filled,
    fitting_radius,
    following,
    mean_radius,
    offset_outline,
    require_positive,
    ring_vertices,
)
from gyrify.metrics.order import notice_crossing, notice_unfit, ordered_contour

Definition = Literal["hull", "closing", "exposed"]

# A disc that enters the tissue by less than this fraction of its radius, or of the body's if that is smaller,
# is said to touch it.
_TOUCH = 1e-3
# Longest contour edge when looking for exposed parts, as a fraction of the radius; and most edges.
_FINEST = 0.2
_MOST_EDGES = 200_000
# By how much the closing's outline may come out shorter than the hull's, which it never is, for the chords.
_CHORDS = 1e-3
# Halvings of an edge to find where its exposed part ends.
_BISECTIONS = 4


def gyrification_index(
    contour: ArrayLike, definition: Definition = "closing", closing_radius: float = 10.0
) -> float:
    """Gyrification index GI = contour length / exposed length, in the state the contour is given in.

    Parameters
    ----------
    contour : (n, 2) array_like
        Vertices of the closed contour in order [mm], in either direction.
    definition : {"closing", "hull", "exposed"}
        What the exposed length is. ``"hull"``: perimeter of the convex hull. ``"closing"``: outline of the
        morphological closing with ``closing_radius``. ``"exposed"``: length of the part of the contour that
        lies on that outline, that is, where a disc of that radius can touch it from outside.
    closing_radius : float
        Radius of the closing [mm], > 0; not used by ``"hull"``.

    Returns
    -------
    float
        GI [-]; 1 for a convex contour. Infinite if no part of the contour is exposed.

    Raises
    ------
    ConfigError
        If the definition is unknown or the radius not positive.
    MeshError
        If the contour is malformed, has a point twice or is not in order.

    Warns
    -----
    UserWarning
        If the contour crosses itself, or the radius is larger than the body or much smaller than its edges.

    Notes
    -----
    The contour length counts the whole contour, also where it crosses itself; the exposed length is then that
    of the outer outline of everything the contour encloses.
    """
    if not isinstance(definition, str) or definition not in get_args(Definition):
        raise ConfigError(
            f"definition = {str(definition)[:60]!r} is not a gyrification index.",
            f"Choose one of {', '.join(get_args(Definition))}.",
        )
    closing_radius = require_positive("closing_radius", closing_radius)
    vertices = ordered_contour(contour)
    notice_crossing(vertices)
    if definition != "hull":
        notice_unfit(vertices, closing_radius)
    return index_of(vertices, definition, closing_radius)


def index_of(vertices: FloatArray, definition: Definition, closing_radius: float) -> float:
    """`gyrification_index` of a contour that is known to be one, such as that of a stored state."""
    tissue = filled(vertices)
    radius, hull = fitting_radius(tissue, closing_radius), float(tissue.convex_hull.length)
    if definition == "hull":
        exposed = hull
    elif definition == "closing":
        exposed = closing_length(offset_outline(tissue, radius), radius, hull)
    else:
        exposed = exposed_length(tissue, radius, mean_radius(tissue))
    length = float(edge_lengths(vertices).sum())
    return length / exposed if exposed > 0 else math.inf


def closing_length(offset: shapely.LinearRing, radius: float, hull: float = 0.0) -> float:
    """Length [mm] of the closing's outline, from the outline offset by the radius.

    The closing is the offset body eroded by the same radius. No arc of the offset outline is tighter than the
    radius, so the erosion shortens it by exactly 2π·radius (Steiner) and need not be constructed.

    The closing lies in the convex hull and touches it all round, so that its outline is never shorter than
    the hull's, of length ``hull`` [mm]; where arcs made of chords have it so, it is the hull's.

    Raises
    ------
    MeshError
        If it is shorter by more than chords explain: the measurement is wrong.
    """
    return at_least_hull(float(offset.length) - 2 * math.pi * radius, hull, radius)


def at_least_hull(length: float, hull: float, radius: float) -> float:
    """Length of the closing's outline [mm], which cannot be below that of the hull's.

    Raises
    ------
    MeshError
        If it is by more than chords explain: the measurement is wrong.
    """
    if length < (1 - _CHORDS) * hull:
        raise MeshError(
            f"The closing with radius {radius:g} mm has an outline of {length:.6g} mm, shorter than the "
            f"convex hull's of {hull:.6g} mm, which cannot be: the contour cannot be measured with this "
            "radius.",
            "Choose a closing radius of about a quarter of the body's radius.",
        )
    return max(length, hull)


def exposed_length(tissue: shapely.Polygon, radius: float, size: float = math.inf) -> float:
    """Length [mm] of the part of a polygon's outline that a disc of the radius can touch from outside.

    Whether it can is asked at the middle of each edge; where the answer changes between two neighbouring
    edges, the end of the exposed part is found by bisection. ``size`` is that of the body [mm], to which a
    touch is judged where the disc is larger.
    """
    start = _short_edges(tissue, max(radius * _FINEST, float(tissue.exterior.length) / _MOST_EDGES))
    edge = following(start) - start
    length = np.hypot(edge[:, 0], edge[:, 1])
    along = edge / length[:, None]
    outwards = np.column_stack([along[:, 1], -along[:, 0]])
    middle = start + 0.5 * edge
    outline = cKDTree(np.concatenate([start, middle]), balanced_tree=False, compact_nodes=False)

    def touches(points: FloatArray, normals: FloatArray) -> NDArray[np.bool_]:
        reach = radius * (1 - _TOUCH * min(1.0, size / radius))
        nearest, _ = outline.query(points + radius * normals, distance_upper_bound=reach)
        free: NDArray[np.bool_] = np.isinf(nearest)
        return free

    exposed = touches(middle, outwards)
    left = np.flatnonzero(exposed != following(exposed))
    right = (left + 1) % len(start)
    # Positions relative to the vertex both edges share, from the middle of one to the middle of the other.
    low, high = -0.5 * length[left], 0.5 * length[right]
    for _ in range(_BISECTIONS):
        at = 0.5 * (low + high)
        before = at < 0
        own = np.where(before, left, right)
        same = touches(start[right] + at[:, None] * along[own], outwards[own]) == exposed[left]
        low, high = np.where(same, at, low), np.where(same, high, at)
    end = 0.5 * (low + high)
    return float(length @ exposed + np.where(exposed[left], end, -end).sum())


def _short_edges(tissue: shapely.Polygon, longest: float) -> FloatArray:
    """Return the outline's vertices counter-clockwise, edges split until none is longer than ``longest``."""
    ring = tissue.exterior
    vertices = ring_vertices(ring)
    lengths = edge_lengths(vertices)
    if lengths.max() > longest:
        vertices = ring_vertices(shapely.segmentize(ring, longest))
        lengths = edge_lengths(vertices)
    vertices = vertices[lengths > 0]
    return vertices if ring.is_ccw else vertices[::-1]
