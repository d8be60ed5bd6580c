"""Cortical thickness: the shortest way from the contour to the grey-white interface."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gyrify.metrics.contour import FloatArray, as_contour, distance_to_line


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
        If the contour or the interface is malformed.
    """
    points = as_contour(contour) if at is None else np.asarray(at, dtype=np.float64).reshape(-1, 2)
    return distance_to_line(points, as_contour(interface))
