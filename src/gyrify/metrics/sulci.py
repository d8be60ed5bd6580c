"""Sulci: whether a contour has any at all (a bump of a convex outline is no gyrus), and how deep they are."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import ArrayLike

from gyrify.metrics.contour import (
    FloatArray,
    as_points,
    closing_of,
    distance_to_line,
    filled,
    fitting_radius,
    offset_outline,
    require_positive,
    ring_vertices,
)
from gyrify.metrics.order import ordered_contour


def has_sulcus(fundi: FloatArray, hull: shapely.Polygon, prominence: float) -> bool:
    """Whether a fundus lies below the convex hull by at least the prominence of a gyrus.

    The slow waves of a thick cortex leave the outline convex, or nearly so: crowns stand out above the
    overall shape, but there is nothing between them.

    Parameters
    ----------
    fundi : (n, 2) float array
        Positions of the fundi [mm].
    hull : shapely.Polygon
        Convex hull of the contour.
    prominence : float
        Smallest prominence of a gyrus [mm].

    Returns
    -------
    bool
    """
    if len(fundi) == 0:
        return False
    return bool(distance_to_line(fundi, ring_vertices(hull.exterior)).max() >= prominence)


def sulcal_depth(points: ArrayLike, contour: ArrayLike, closing_radius: float = 10.0) -> FloatArray:
    """Depth of points below the outline of the closing.

    Parameters
    ----------
    points : (k, 2) array_like
        Points on or inside the outline [mm], such as `Folds.fundus_points`.
    contour : (n, 2) array_like
        Vertices of the closed contour in order [mm].
    closing_radius : float
        Radius of the closing [mm], > 0.

    Returns
    -------
    (k,) float array
        Shortest distance to the outline [mm]; 0 on it.

    Raises
    ------
    ConfigError
        If the radius is not positive.
    MeshError
        If the contour is malformed.
    """
    closing_radius = require_positive("closing_radius", closing_radius)
    tissue = filled(ordered_contour(contour))
    radius = fitting_radius(tissue, closing_radius)
    return depth_below(as_points(points), offset_outline(tissue, radius), radius)


def depth_below(points: FloatArray, offset: shapely.LinearRing, radius: float) -> FloatArray:
    """`sulcal_depth` from the offset outline: the closing's outline lies one radius inside it."""
    return np.maximum(distance_to_line(points, ring_vertices(offset)) - radius, 0.0)


def closing_outline(contour: ArrayLike, closing_radius: float = 10.0) -> FloatArray:
    """Outline of the morphological closing of the tissue: sulci bridged by arcs of the closing radius.

    Parameters
    ----------
    contour : (n, 2) array_like
        Vertices of the closed contour in order [mm].
    closing_radius : float
        Radius of the disc that rolls around the tissue [mm], > 0.

    Returns
    -------
    (m, 2) float array
        Vertices of the outline [mm], the first one not repeated.

    Raises
    ------
    MeshError
        If the contour is malformed.
    ConfigError
        If the radius is not positive.
    """
    closing_radius = require_positive("closing_radius", closing_radius)
    return closing_of(ordered_contour(contour), closing_radius)
