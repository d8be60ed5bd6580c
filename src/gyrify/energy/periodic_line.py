"""A contour as the polyline that contact works on; a periodic one with its images on both sides.

The images are the contour one period to the right and one to the left. Further ones cannot touch it: seen on
a cylinder, a curve that does not cross itself closes, at a point of contact, to loops without crossings, and
such a loop winds around the cylinder at most once. One vertex more at either end gives every vertex both of
its edges, so that the weight of a pair does not depend on where the period is cut.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gyrify.energy.term import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Polyline:
    """Vertices and edges of a contour for contact.

    Attributes
    ----------
    vertices : (n_vertices,) int array
        Position along the contour of each vertex; those of the contour itself come first.
    offset : (n_vertices, 2) float array
        Constant distance from the contour's point to the vertex [mm]: zero, or some periods.
    edges : (n_edges, 2) int array
        Vertices of each edge.
    """

    vertices: IntArray
    offset: FloatArray
    edges: IntArray

    @staticmethod
    def of(n_contour: int, is_closed: bool, period: float | None) -> Polyline:
        """Polyline of a contour of ``n_contour`` points; ``period`` [mm] is None where it is not periodic."""
        own = np.arange(n_contour)
        if period is None:
            start = own if is_closed else own[:-1]
            edges = np.stack([start, (start + 1) % n_contour], axis=1)
            return Polyline(own, np.zeros((n_contour, 2)), edges)
        right, left, after, before = n_contour, 2 * n_contour, 3 * n_contour, 3 * n_contour + 1
        order = np.concatenate([[before], left + own, own, right + own, [after]])
        periods = np.concatenate([np.repeat([0, 1, -1], n_contour), [2, -2]])
        return Polyline(
            np.concatenate([own, own, own, [0, n_contour - 1]]),
            np.stack([period * periods, np.zeros(periods.size)], axis=1),
            np.stack([order[:-1], order[1:]], axis=1),
        )
