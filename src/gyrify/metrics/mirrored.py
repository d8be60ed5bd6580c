"""Half a surface and its mirror image as one."""

from __future__ import annotations

import numpy as np

from gyrify.metrics.surface import FloatArray, IntArray


def with_image(
    points: FloatArray, faces: IntArray, rim: IntArray, axis: int, place: float
) -> tuple[FloatArray, IntArray]:
    """A surface that ends in a plane, and its image behind it.

    Parameters
    ----------
    points : (n, 3) float array
        [mm].
    faces : (n_faces, 3) int array
        Triangles.
    rim : (n_rim,) int array
        Points in the plane, which both halves have.
    axis : int
        Axis that the plane lies across.
    place : float
        Where it lies along that axis [mm].

    Returns
    -------
    points : (2 n - n_rim, 3) float array
        Those given come first.
    faces : (2 n_faces, 3) int array
        Likewise; those of the image are turned.
    """
    n = points.shape[0]
    moves = np.ones(n, dtype=bool)
    moves[rim] = False
    image = points[moves].copy()
    image[:, axis] = 2.0 * place - image[:, axis]
    number = np.arange(n)
    number[moves] = n + np.arange(image.shape[0])
    return np.concatenate([points, image]), np.concatenate([faces, number[faces][:, ::-1]])
