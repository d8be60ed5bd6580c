"""Tetrahedra in clusters of about five, for an element that averages the volume ratio over them."""

from __future__ import annotations

import numpy as np

from gyrify.mesh.mesh import FloatArray, IntArray
from gyrify.metrics.tetrahedra import EDGES, faces_by_cells


def edge_clusters(points: FloatArray, cells: IntArray) -> IntArray:
    """Cluster of each cell: the cells about an edge, long edges first.

    A mesh has about five and a half tetrahedra for each point: with one constraint of volume for each cluster
    of that size there are three unknowns to a constraint, as in the continuum.

    Parameters
    ----------
    points : (n_points, 3) float array
        [mm].
    cells : (n_cells, 4) int array

    Returns
    -------
    (n_cells,) int array
        Numbers from 0 without gaps.
    """
    n = cells.shape[0]
    sides = np.sort(cells[:, EDGES].reshape(-1, 2), axis=1)
    edges, number = np.unique(sides, axis=0, return_inverse=True)
    number = number.ravel()
    order = np.argsort(number, kind="stable")
    starts = np.searchsorted(number[order], np.arange(edges.shape[0] + 1))
    about = order // 6
    length = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
    ranked = np.argsort(-np.round(length / length.max(), 9), kind="stable")
    cluster, sizes = np.full(n, -1, dtype=np.int64), list[int]()
    for least in (4, 3):
        for edge in ranked:
            star = about[starts[edge] : starts[edge + 1]]
            free = star[cluster[star] < 0]
            if free.size >= least:
                cluster[free] = len(sizes)
                sizes.append(free.size)
    return _completed(cells, cluster, sizes)


def _completed(cells: IntArray, cluster: IntArray, sizes: list[int]) -> IntArray:
    """Cells that are left join the smallest cluster behind one of their faces."""
    neighbours = _neighbours(cells)
    left = list(np.flatnonzero(cluster < 0))
    while left:
        later = []
        for cell in left:
            near = [cluster[k] for k in neighbours[cell] if k >= 0 and cluster[k] >= 0]
            if near:
                best = min(near, key=lambda k: (sizes[k], k))
                cluster[cell] = best
                sizes[best] += 1
            else:
                later.append(cell)
        if len(later) == len(left):  # an island of its own
            cluster[later[0]] = len(sizes)
            sizes.append(1)
            later = later[1:]
        left = later
    return cluster


def _neighbours(cells: IntArray) -> IntArray:
    """(n_cells, 4) cell behind each face; -1 where there is none."""
    faces, order, first = faces_by_cells(cells)
    both = first[:-1][np.diff(first) == 2]
    a, b = order[both], order[both + 1]
    found = np.full(faces.shape[0], -1, dtype=np.int64)
    found[a], found[b] = b // 4, a // 4
    return found.reshape(-1, 4)
