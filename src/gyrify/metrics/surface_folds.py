"""Gyri and sulci of a surface: extrema of the depth below its closing, by prominence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gyrify.base.compiled import njit
from gyrify.metrics.surface import FloatArray, IntArray


@dataclass(frozen=True)
class SurfaceFolds:
    """Where a surface folds.

    Attributes
    ----------
    crowns, fundi : (n,) int arrays
        Points of the least and of the greatest depth of each gyrus and of each sulcus; none without folds.
    """

    crowns: IntArray
    fundi: IntArray

    @classmethod
    def of(cls, depth: FloatArray, faces: IntArray, prominence: float) -> SurfaceFolds:
        """Extrema of a depth.

        Parameters
        ----------
        depth : (n,) float array
            Depth of the points of the surface [mm].
        faces : (n_faces, 3) int array
            Its triangles.
        prominence : float
            How far one must go down from a crown, or up from a fundus, on any way to a higher or deeper one
            [mm].
        """
        fundi = prominent_peaks(depth, faces, prominence)
        none = np.empty(0, dtype=np.int64)
        if fundi.size == 0:
            return cls(none, none)
        return cls(prominent_peaks(-depth, faces, prominence), fundi)


def prominent_peaks(heights: FloatArray, faces: IntArray, prominence: float) -> IntArray:
    """Maxima of heights on a surface, that of a plateau counted once, by their numbers.

    The prominence of the highest one is its height above the lowest point.

    Parameters
    ----------
    heights : (n,) float array
        Height of each point.
    faces : (n_faces, 3) int array
        Triangles.
    prominence : float
        Smallest prominence.
    """
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    ends = np.concatenate([ends, ends[:, ::-1]])
    ends = ends[np.argsort(ends[:, 0], kind="stable")]
    starts = np.searchsorted(ends[:, 0], np.arange(heights.size + 1))
    order = np.argsort(-heights, kind="stable")
    lowest = _merge_levels(heights, order, starts, ends[:, 1].copy())
    return np.flatnonzero(heights - lowest >= prominence)


@njit(cache=True)
def _merge_levels(heights, order, starts, neighbours):  # type: ignore[no-untyped-def]
    """Height at which each maximum's region meets that of a higher one; the own height where none is one."""
    n = heights.size
    parent, levels = np.full(n, -1), heights.copy()
    for point in order:
        parent[point] = point
        is_peak = True
        for k in range(starts[point], starts[point + 1]):
            other = neighbours[k]
            if parent[other] < 0:
                continue
            while parent[other] != other:
                parent[other] = parent[parent[other]]
                other = parent[other]
            own = point
            while parent[own] != own:
                own = parent[own]
            if own == other:
                continue
            if is_peak:
                parent[own] = other
                is_peak = False
                continue
            # the lower of two peaks ends here; of equal ones the later
            low, high = (own, other) if heights[own] < heights[other] else (other, own)
            levels[low] = heights[point]
            parent[low] = high
    levels[order[0]] = heights[order[n - 1]]
    return levels
