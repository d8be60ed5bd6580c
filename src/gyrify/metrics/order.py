"""Contours that a user gives: whether their points are a closed curve in order, and lengths that fit it."""

from __future__ import annotations

import math
import warnings
from typing import Final

import numpy as np
import shapely
from numpy.typing import ArrayLike
from scipy.spatial import cKDTree

from gyrify.errors import MeshError
from gyrify.metrics.contour import FloatArray, as_contour, edge_lengths

# Points in order are about as far from the next one as from the nearest one; in any other order much farther,
# and the whole is many times longer than its convex hull. Walls of sulci that overlap are neither.
_MEDIAN_JUMP: Final = 5.0
_LONGEST: Final = 3.0
# A jump: an edge this many times longer than the median one. Points out of their order make at least two.
_JUMP: Final = 10.0
_JUMPS: Final = 2
# Least width over length, squared: below it, points lie on a line.
_FLAT: Final = 1e-20
# Edges that are all this many times longer than the radius: what the disc sees are the corners.
_COARSE: Final = 4.0
_ADVICE: Final = "Give every point once, in the order in which they follow each other along the contour."


def ordered_contour(points: ArrayLike, name: str = "The contour", *, closed: bool = True) -> FloatArray:
    """Return the vertices of a contour, after making sure that they are one, in order.

    Parameters
    ----------
    points : (n, 2) array_like
        Vertices [mm], in either direction, with or without the first one repeated at the end.
    name : str
        What to call it in a message.
    closed : bool
        Whether it is closed; otherwise it is one period of a strip, which may be straight.

    Returns
    -------
    (n, 2) float array

    Raises
    ------
    MeshError
        If there are fewer than three points, some are not finite or given twice, all lie on a line, or their
        order is not that along a curve. A curve in order that crosses itself is let pass.
    """
    vertices = as_contour(points)
    _require_distinct(vertices, name)
    if closed and _is_flat(vertices):
        raise MeshError(f"{name} encloses nothing: all {len(vertices)} points lie on a line.", _ADVICE)
    line = shapely.linearrings(vertices) if closed else shapely.linestrings(vertices)
    if line.is_simple:
        return vertices
    edges = edge_lengths(vertices) if closed else np.hypot(*np.diff(vertices, axis=0).T)
    if _is_unordered(vertices, edges):
        raise MeshError(
            f"{name} is not in order: it crosses itself, and points that follow each other lie up to "
            f"{float(edges.max()):.3g} mm apart, while the nearest point is {_nearest(vertices):.3g} mm off.",
            _ADVICE,
        )
    if closed and (rounds := _rounds(vertices)) > 1:
        raise MeshError(f"{name} goes round {rounds} times, and a contour goes round once.", _ADVICE)
    return vertices


def notice_unfit(vertices: FloatArray, closing_radius: float) -> None:
    """Warn of a radius that makes an index a number about something else than the folds of a contour.

    Parameters
    ----------
    vertices : (n, 2) float array
        Closed contour [mm].
    closing_radius : float
        Radius of the closing [mm].
    """
    edges = edge_lengths(vertices)
    size = float(edges.sum()) / (2 * math.pi)
    if closing_radius > size:
        _notice(
            f"closing_radius = {closing_radius:g} mm is larger than the whole body (mean radius about "
            f"{size:.3g} mm): the closing is nearly its convex hull. Give positions in mm, or a radius "
            f"in the unit of the contour; about {size / 4:.2g} sees sulci."
        )
    elif float(edges.min()) > _COARSE * closing_radius:
        _notice(
            f"closing_radius = {closing_radius:g} mm is much smaller than every edge of the contour "
            f"(at least {float(edges.min()):.3g} mm): no sulcus is bridged. Give positions in mm, or a "
            f"radius in the unit of the contour; about {size / 4:.2g} sees sulci."
        )


def notice_crossing(vertices: FloatArray) -> None:
    """Warn of a contour that crosses itself, where what is returned does not say so."""
    if not shapely.linearrings(vertices).is_simple:
        _notice("The contour crosses itself: its index is a number about an impossible state.")


def _notice(text: str) -> None:
    warnings.warn(text, UserWarning, stacklevel=4)


def _require_distinct(vertices: FloatArray, name: str) -> None:
    """Refuse points that are given twice."""
    plane = vertices[:, 0] + 1j * vertices[:, 1]
    order = np.argsort(plane, kind="stable")
    equal = np.flatnonzero(plane[order[1:]] == plane[order[:-1]])
    if equal.size:
        first, second = sorted(order[equal[0] : equal[0] + 2].tolist())
        x, y = vertices[first]
        raise MeshError(
            f"{name} holds a point twice: points {first} and {second} are both at ({x:.6g}, {y:.6g}) mm "
            f"({equal.size} such pairs).",
            _ADVICE,
        )


def _is_flat(vertices: FloatArray) -> bool:
    """Whether all points lie on a line, up to rounding."""
    spread = vertices - vertices.mean(axis=0)
    least, most = np.linalg.eigvalsh(spread.T @ spread)
    return bool(least <= _FLAT * most)


def _is_unordered(vertices: FloatArray, edges: FloatArray) -> bool:
    """Whether consecutive points lie much farther apart than points in order do."""
    median = float(np.median(edges))
    if np.count_nonzero(edges > _JUMP * median) >= _JUMPS:
        return True
    hull = float(shapely.multipoints(vertices).convex_hull.length)
    return float(edges.sum()) > _LONGEST * hull and median > _MEDIAN_JUMP * _nearest(vertices)


def _nearest(vertices: FloatArray) -> float:
    """Median distance from a point to the nearest other one."""
    apart, _ = cKDTree(vertices).query(vertices, k=2)
    return float(np.median(apart[:, 1]))


def _rounds(vertices: FloatArray) -> int:
    """How many times a closed contour goes round the mean of its points, in either direction."""
    plane = vertices[:, 0] + 1j * vertices[:, 1]
    ray = plane - plane.mean()
    return abs(round(float(np.angle(np.roll(ray, -1) * np.conj(ray)).sum()) / (2 * math.pi)))
