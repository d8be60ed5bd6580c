"""Curvature of a contour."""

from __future__ import annotations

import numpy as np

from gyrify.metrics.contour import FloatArray


def curvature(contour: FloatArray, shift: float = 0.0) -> FloatArray:
    r"""Signed curvature at the vertices of a contour, of the circle through each and its neighbours.

    .. math:: k = \frac{2 \, a \times b}{|a| |b| |a + b|}

    with a and b the edges before and after the vertex: positive where a counter-clockwise contour bulges
    outwards (crowns), negative in sulci, and exactly 1/R for points on a circle of radius R.

    Parameters
    ----------
    contour : (n, 2) float array
        Vertices in order [mm]; the first follows the last.
    shift : float
        How far in x it follows it [mm]: the period of a periodic contour, 0 for a closed one.

    Returns
    -------
    (n,) float array
        k [1/mm].
    """
    z = contour[:, 0] + 1j * contour[:, 1]
    after = np.concatenate([z[1:], z[:1] + shift]) - z
    before = np.concatenate([after[-1:], after[:-1]])
    cross = (np.conj(before) * after).imag
    return np.asarray(2.0 * cross / (np.abs(before) * np.abs(after) * np.abs(before + after)))
