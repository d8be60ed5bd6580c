"""Quadratic tetrahedra: a node in the middle of each edge of linear ones, in the order of VTK."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np

from gyrify.mesh.mesh import FloatArray, IntArray
from gyrify.mesh.shells import Shells

# Ends of the edges of a tetrahedron (01, 12, 20, 03, 13, 23) and of a triangle.
_OF_CELL: Final = np.array([[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]])
_OF_FACE: Final = np.array([[0, 1], [1, 2], [2, 0]])
# Four triangles between the corners 012 and the middles 345 of a face.
_PARTS: Final = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]])


def with_midsides(shells: Shells, between: Callable[[FloatArray, FloatArray], FloatArray]) -> Shells:
    """Shells of quadratic cells.

    Middles are taken in the parameters, so that edges follow the curved layers and those of the outer surface
    and of the interface lie on them. Each triangle of a surface becomes four, with corners at all nodes.

    Parameters
    ----------
    shells : Shells
        Of linear cells.
    between : callable
        Parameters in the middle between two (n, k) arrays of them.

    Returns
    -------
    Shells
    """
    n_points = shells.depth.size
    ends = np.sort(shells.cells[:, _OF_CELL].reshape(-1, 2), axis=1)
    edges, edge_of = np.unique(ends, axis=0, return_inverse=True)
    first, second = edges.T
    # edges are sorted, so that a pair of points is found by its place among them
    key = first * n_points + second

    def middles(triangles: IntArray) -> IntArray:
        pairs = np.sort(triangles[:, _OF_FACE], axis=2)
        return n_points + np.searchsorted(key, pairs[..., 0] * n_points + pairs[..., 1])

    return replace(
        shells,
        places=np.concatenate([shells.places, between(shells.places[first], shells.places[second])]),
        depth=np.concatenate([shells.depth, 0.5 * (shells.depth[first] + shells.depth[second])]),
        cells=np.concatenate([shells.cells, n_points + edge_of.reshape(-1, 6)], axis=1),
        surfaces=tuple(
            np.concatenate([surface, middles(surface)], axis=1)[:, _PARTS].reshape(-1, 3)
            for surface in shells.surfaces
        ),
    )
