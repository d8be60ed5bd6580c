"""The narrowest sulcus: the smallest distance between pieces of the contour that are no neighbours."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from gyrify.metrics.contour import BLOCK, FloatArray, edge_lengths, following, self_intersecting
from gyrify.metrics.order import ordered_contour

# Two points are neighbours unless the way along the contour is this many times their distance. Every closed
# curve has pairs at a ratio of π/2 or more (a circle reaches just that), so that a gap always exists.
DETOUR = 1.5
# Length of the close pairs looked at first, in edges.
_REACH = 4.0
# Relative to the length of the contour.
_ROUNDING = 1e-9
# Keeps an edge of no length from dividing by zero.
_TINY = 1e-300

IntArray = NDArray[np.int64]


def min_gap(contour: ArrayLike) -> float:
    """Smallest distance between two non-neighbouring pieces of a closed contour.

    The smallest distance between a vertex and a point of an edge it does not belong to, over the pairs for
    which the shorter way along the contour is at least 1.5 times that distance. This leaves out pieces that
    are close only because they follow each other; what remains are the walls of sulci, or the width of the
    body where there are none.

    Parameters
    ----------
    contour : (n, 2) array_like
        Vertices in order [mm].

    Returns
    -------
    float
        Gap [mm]; 0 if the contour crosses itself, infinite if no pair qualifies (polygons of a few vertices
        only).

    Raises
    ------
    MeshError
        If the contour is malformed, has a point twice or is not in order.
    """
    vertices = ordered_contour(contour)
    return 0.0 if self_intersecting(vertices) else simple_gap(vertices)


def simple_gap(contour: FloatArray) -> float:
    """`min_gap` of a contour known not to cross itself."""
    ring = _Ring(contour)
    longest = float(ring.lengths.max())
    # A narrow sulcus is found among close vertices; the nearest end of an edge is half an edge from any point
    # of it.
    one, other = cKDTree(contour).query_pairs(_REACH * longest, output_type="ndarray").T
    vertex = np.concatenate([one, one, other, other])
    edge = np.concatenate([other, other - 1, one, one - 1]) % len(contour)
    gap = ring.closest(vertex, edge)
    if gap <= (_REACH - 0.5) * longest:
        return gap
    every = np.arange(len(contour))
    blocks = np.array_split(every, 1 + len(every) ** 2 // BLOCK)
    return min(ring.closest(block[:, None], every) for block in blocks)


class _Ring:
    """A closed contour prepared for distances between its vertices and its edges."""

    def __init__(self, contour: FloatArray) -> None:
        self.lengths = edge_lengths(contour)
        self.arc = np.concatenate([[0.0], np.cumsum(self.lengths)])
        self.plane = contour[:, 0] + 1j * contour[:, 1]
        self.backwards = np.conj(following(self.plane) - self.plane) / np.maximum(self.lengths, _TINY)

    def closest(self, vertex: IntArray, edge: IntArray) -> float:
        """Return the smallest distance over (broadcast) pairs of no neighbours, infinite if none."""
        local = (self.plane[vertex] - self.plane[edge]) * self.backwards[edge]
        along = np.clip(local.real, 0.0, self.lengths[edge])
        distance = np.sqrt((local.real - along) ** 2 + local.imag**2)
        way = np.abs(self.arc[edge] + along - self.arc[vertex])
        way = np.minimum(way, self.arc[-1] - way)
        # The margin drops a vertex paired with its own edges, at zero distance.
        apart = way > DETOUR * distance + _ROUNDING * self.arc[-1]
        return float(np.min(distance[apart], initial=np.inf))
