"""A surface that is periodic in x and y, with its eight images around it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def tiled(
    points: FloatArray, faces: IntArray, periods: tuple[float, float]
) -> tuple[IntArray, IntArray, IntArray]:
    """Vertices and triangles of a surface and its images.

    Parameters
    ----------
    points : (n, 3) float array
        Reference coordinates of the surface's points [mm]; each is a corner of a triangle.
    faces : (n_faces, 3) int array
        Its triangles, whose corners may lie at opposite ends of a period.
    periods : (float, float)
        Periods in x and y [mm].

    Returns
    -------
    source : (n_vertices,) int array
        Point that each vertex is, or is the image of; the surface's own come first, in their order.
    turns : (n_vertices, 2) int array
        Periods in x and y from the point to the vertex.
    triangles : (9 n_faces, 3) int array
        Vertices of the triangles.

    Raises
    ------
    ValueError
        If a point is no corner.
    """
    corners = points[faces, :2]
    # how many periods bring each corner next to the first one
    nearest = -np.round((corners - corners[:, :1]) / np.array(periods)).astype(np.int64)
    shifts = [(i, j) for i in (0, -1, 1) for j in (0, -1, 1)]
    turns = np.concatenate([nearest + shift for shift in shifts])
    keys = np.concatenate([turns, np.tile(faces, (len(shifts), 1))[:, :, None]], axis=2).reshape(-1, 3)
    kept, number = np.unique(keys, axis=0, return_inverse=True)
    is_image = np.any(kept[:, :2] != 0, axis=1)
    order = np.lexsort((kept[:, 1], kept[:, 0], kept[:, 2], is_image))
    if not np.array_equal(kept[order][: points.shape[0], 2], np.arange(points.shape[0])):
        raise ValueError("every point of a periodic surface must be a corner of a triangle")
    place = np.empty(order.size, dtype=np.int64)
    place[order] = np.arange(order.size)
    return kept[order, 2], kept[order, :2], place[number.ravel()].reshape(-1, 3)
