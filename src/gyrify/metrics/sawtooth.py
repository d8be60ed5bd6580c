"""Crowns that follow the points of a contour are no gyri: a pattern of the mesh, or noise of the outline."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# Edges from fundus to fundus that a gyrus needs: a crown between fundi at its two neighbours is a sawtooth.
# Extrema of the resampled contour may lie a little beside the vertices.
_LEAST_EDGES: Final = 2.5
# Points of the contour for each crown below which no crown is a gyrus.
LEAST_POINTS: Final = 4.0


def without_sawteeth(
    profile: FloatArray, vertex: FloatArray, n_vertices: int, crowns: IntArray, fundi: IntArray
) -> tuple[IntArray, IntArray, int]:
    """Drop the crowns that stand between neighbouring vertices of the contour.

    Parameters
    ----------
    profile : (n,) float array
        Normal displacement at the points of a resampled contour [mm].
    vertex : (n,) float array
        Where they lie, counted in vertices of the contour from its first one.
    n_vertices : int
        Vertices of the contour.
    crowns, fundi : (n_gyri,) int arrays
        Its extrema, ascending and alternating.

    Returns
    -------
    crowns, fundi : int arrays
        Those of gyri that span three edges or more: between two of them, the lowest fundus. None where there
        are fewer than four vertices for each crown.
    n_sawteeth : int
        Crowns that were dropped.
    """
    if crowns.size == 0:
        return crowns, fundi, 0
    after = np.searchsorted(fundi, crowns)
    left, right = fundi[after - 1], fundi[after % fundi.size]
    span = (vertex[right] - vertex[left]) % n_vertices
    # A single gyrus has one fundus on both sides, a whole turn apart.
    kept = (span >= _LEAST_EDGES) | (crowns.size == 1)
    if n_vertices < LEAST_POINTS * crowns.size:
        kept[:] = False
    n_sawteeth = int(np.count_nonzero(~kept))
    if n_sawteeth == 0:
        return crowns, fundi, 0
    chosen = crowns[kept]
    if chosen.size == 0:
        return chosen, chosen.copy(), n_sawteeth
    gap = np.searchsorted(chosen, fundi) % chosen.size
    lowest = [fundi[gap == number][np.argmin(profile[fundi[gap == number]])] for number in range(chosen.size)]
    return chosen, np.sort(np.array(lowest, dtype=np.int64)), n_sawteeth
