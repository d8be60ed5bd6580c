"""Cortical thickness: the shortest way from the contour to the grey-white interface."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gyrify.metrics.contour import FloatArray, as_points, distance_to_line
from gyrify.metrics.folds import Folds
from gyrify.metrics.order import ordered_contour

# Where nothing is folded the thickness is averaged over about this many points along the contour.
_SMOOTH_POINTS = 50


def cortical_thickness(
    contour: ArrayLike, interface: ArrayLike, *, at: ArrayLike | None = None
) -> FloatArray:
    """Shortest distance from points of the contour to the interface.

    Parameters
    ----------
    contour : (n, 2) array_like
        Vertices of the outer contour [mm].
    interface : (m, 2) array_like
        Vertices of the closed grey-white interface in order [mm], in either direction.
    at : (k, 2) array_like, optional
        Points to measure at [mm], such as crowns and fundi; every vertex of the contour if left out.

    Returns
    -------
    (n,) or (k,) float array
        Thickness [mm].

    Raises
    ------
    MeshError
        If the contour or the interface is malformed, has a point twice or is not in order.
    """
    line = ordered_contour(interface, "The interface")
    return distance_to_line(ordered_contour(contour) if at is None else as_points(at), line)


def thickness_at_folds(folds: Folds, interface: FloatArray, *, closed: bool = True) -> tuple[float, float]:
    """Return the mean thickness at crowns and at fundi, or for both that along a contour without folds."""
    if folds.n_gyri == 0:
        every = max(1, len(folds.points) // _SMOOTH_POINTS)
        mean = float(distance_to_line(folds.points[::every], interface, closed=closed).mean())
        return mean, mean
    ends = np.concatenate([folds.crown_points, folds.fundus_points])
    at = distance_to_line(ends, interface, closed=closed)
    return float(at[: folds.n_gyri].mean()), float(at[folds.n_gyri :].mean())
