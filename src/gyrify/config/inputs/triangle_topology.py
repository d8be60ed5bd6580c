"""How triangles of a surface hang together: welded points, edges, orientation, closed parts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order, connected_components
from scipy.spatial import cKDTree

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def welded(points: FloatArray, tolerance: float) -> IntArray:
    """(n_points,) the first of the points that lie at the same place as each, within a tolerance."""
    n = points.shape[0]
    pairs = cKDTree(points).query_pairs(tolerance, output_type="ndarray")
    if pairs.size == 0:
        return np.arange(n)
    _, label = _parts(n, pairs[:, 0], pairs[:, 1])
    first = np.full(label.max() + 1, n, dtype=np.int64)
    np.minimum.at(first, label, np.arange(n))
    return first[label]


def single(triangles: IntArray) -> tuple[IntArray, int, int]:
    """Each triangle once; two of opposite sides, back to back, are a wall without thickness, and go.

    Returns
    -------
    triangles : (n, 3) int array
    n_repeated : int
        How many were there before, with the same side.
    n_walls : int
        How many pairs were back to back.
    """
    ordered = np.sort(triangles, axis=1)
    _, number = np.unique(ordered, axis=0, return_inverse=True)
    number = number.ravel()
    # the sign of the permutation tells the side
    turned = np.array([triangles[:, 0], triangles[:, 1], triangles[:, 2]])
    inversions = (turned[0] > turned[1]) ^ (turned[1] > turned[2]) ^ (turned[0] > turned[2])
    side = np.where(inversions, -1, 1)
    sums = np.bincount(number, side).astype(np.int64)
    wanted = np.sign(sums)[number] == side
    order = np.flatnonzero(wanted)
    _, first = np.unique(number[order], return_index=True)
    kept = np.sort(order[first])
    n_walls = int(((np.bincount(number) - np.abs(sums)) // 2).sum())
    return triangles[kept], triangles.shape[0] - kept.size - 2 * n_walls, n_walls


def edges_of(triangles: IntArray) -> tuple[IntArray, IntArray]:
    """(n_edges, 2) edges, the smaller point first, and (3 n,) the edge of each side 01, 12, 20 in turn."""
    sides = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    edges, number = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True)
    return edges, number.ravel()


def pairs_of_sides(triangles: IntArray) -> IntArray:
    """(n_edges, 2) the two sides, counted as by `edges_of`, of each edge of a surface without a border."""
    _, number = edges_of(triangles)
    return np.argsort(number, kind="stable").reshape(-1, 2)


def parts_of(triangles: IntArray) -> IntArray:
    """(n,) closed part that each triangle belongs to, by the lowest triangle of each."""
    sides = pairs_of_sides(triangles) // 3
    _, label = _parts(triangles.shape[0], sides[:, 0], sides[:, 1])
    return label


def oriented(triangles: IntArray) -> tuple[IntArray, int] | None:
    """Triangles turned so that neighbours have the same side outwards, and how many were turned.

    Returns
    -------
    tuple or None
        None where that is not possible, as on a Klein bottle. Which side is out is not known yet.
    """
    n = triangles.shape[0]
    sides = pairs_of_sides(triangles)
    directed = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    same_way = directed[sides[:, 0], 0] == directed[sides[:, 1], 0]  # then one of both must be turned
    if not same_way.any():
        return triangles, 0
    f, g = sides[:, 0] // 3, sides[:, 1] // 3
    graph = coo_array((np.ones(2 * f.size), (np.append(f, g), np.append(g, f))), shape=(n, n)).tocsr()
    conflict = {(min(a, b), max(a, b)): bool(c) for a, b, c in zip(f, g, same_way, strict=True)}
    turned = np.zeros(n, dtype=bool)
    _, label = connected_components(graph, directed=False)
    for start in np.unique(label, return_index=True)[1]:
        order, before = breadth_first_order(graph, int(start), directed=False)
        for face in order[1:]:
            other = before[face]
            turned[face] = turned[other] ^ conflict[min(face, other), max(face, other)]
    if np.any(turned[f] ^ turned[g] != same_way):
        return None
    # the fewer of each part
    share = np.bincount(label, turned) / np.bincount(label)
    turned ^= share[label] > 0.5
    return np.where(turned[:, None], triangles[:, ::-1], triangles), int(turned.sum())


def pinched_points(triangles: IntArray, n_points: int) -> IntArray:
    """Points at which a surface touches itself: the triangles around are not one fan."""
    sides = pairs_of_sides(triangles)
    directed = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    # a side k of a triangle runs from its corner k to the next; corners are counted like sides
    start, end = np.arange(directed.shape[0]), np.arange(directed.shape[0])
    end = end - end % 3 + (end + 1) % 3
    a, b = sides[:, 0], sides[:, 1]
    rows = np.concatenate([start[a], end[a]])
    cols = np.concatenate([end[b], start[b]])
    n_fans, label = _parts(directed.shape[0], rows, cols)
    point = np.zeros(n_fans, dtype=np.int64)
    point[label] = triangles.ravel()
    return np.flatnonzero(np.bincount(point, minlength=n_points) > 1)


def _parts(n: int, rows: IntArray, cols: IntArray) -> tuple[int, IntArray]:
    graph = coo_array((np.ones(rows.size, dtype=np.int8), (rows, cols)), shape=(n, n))
    count, label = connected_components(graph.tocsr(), directed=False)
    return int(count), label.astype(np.int64)
