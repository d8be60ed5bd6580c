"""Contact in the plane by kernels of gyrify's own, for platforms without the IPC Toolkit."""

from __future__ import annotations

import numpy as np

from gyrify.energy import planar_kernels as kernels
from gyrify.energy.collision import PairSum, vertex_and_ends
from gyrify.energy.projection import project_all
from gyrify.energy.term import FloatArray, IntArray

# A step ends where a pair is at two of these parts of its distance, at the least.
GAP = 0.005
# Where a path is only asked to be free, pairs may come this near.
TOUCHING = 1e-5
# Boxes are larger than the paths in them by this part of the largest coordinate, for the sake of round-off.
ROUND_OFF = 1e-12


class PlanarContour:
    """See `gyrify.energy.collision.CollisionContour`; pairs are (n_pairs, 2) int arrays of vertex and edge.

    Parameters
    ----------
    reference : (n_vertices, 2) float array
        Undeformed vertices [mm].
    edges : (n_edges, 2) int array
        Vertices of each edge.
    n_own : int or None
        Number of vertices before the images of a periodic contour, or None.
    """

    def __init__(self, reference: FloatArray, edges: IntArray, n_own: int | None) -> None:
        n_vertices = reference.shape[0]
        self.edges = np.ascontiguousarray(edges, dtype=np.int64)
        self.n_own = n_vertices if n_own is None else n_own
        lengths = np.linalg.norm(reference[edges[:, 1]] - reference[edges[:, 0]], axis=1)
        self.neighbours = np.sort(self.edges, axis=1) @ [n_vertices, 1]
        # Half the length of the edges at each vertex [mm].
        self.share = np.bincount(self.edges.ravel(), 0.5 * np.repeat(lengths, 2), n_vertices)

    def pairs(self, vertices: FloatArray, inflation: float) -> IntArray:
        """See `gyrify.energy.collision.CollisionContour`."""
        return self._meeting(vertices - inflation, vertices + inflation)

    def coupled(self, pairs: IntArray) -> IntArray:
        """See `gyrify.energy.collision.CollisionContour`."""
        return vertex_and_ends(pairs, self.edges)

    def is_path_free(self, start: FloatArray, end: FloatArray) -> bool:
        """See `gyrify.energy.collision.CollisionContour`."""
        return self._free_step(start, end, self._swept(start, end), TOUCHING) >= 1.0

    def free_step(self, start: FloatArray, end: FloatArray, pairs: IntArray | None = None) -> float:
        """See `gyrify.energy.collision.CollisionContour`."""
        return self._free_step(start, end, self._swept(start, end) if pairs is None else pairs, GAP)

    def barrier(self, d_hat: float, stiffness: float) -> PlanarBarrier:
        """See `gyrify.energy.collision.CollisionContour`."""
        return PlanarBarrier(self, d_hat, stiffness)

    def _free_step(self, start: FloatArray, end: FloatArray, pairs: IntArray, gap: float) -> float:
        if not np.isfinite(end).all():
            return 0.0
        start, end = np.ascontiguousarray(start), np.ascontiguousarray(end)
        return float(kernels.free_step(start, end, self.edges, pairs, gap))

    def _swept(self, start: FloatArray, end: FloatArray) -> IntArray:
        """Pairs whose boxes around the whole path meet."""
        margin = ROUND_OFF * max(np.abs(start).max(), np.abs(end).max())
        return self._meeting(np.minimum(start, end) - margin, np.maximum(start, end) + margin)

    def _meeting(self, low: FloatArray, high: FloatArray) -> IntArray:
        low, high = np.ascontiguousarray(low), np.ascontiguousarray(high)
        order = np.argsort(low[self.edges, 0].min(axis=1), kind="stable")
        pairs = np.empty((16 * low.shape[0], 2), dtype=np.int64)
        found = kernels.meeting_boxes(low, high, self.edges, self.n_own, order, pairs)
        if found > pairs.shape[0]:
            pairs = np.empty((found, 2), dtype=np.int64)
            kernels.meeting_boxes(low, high, self.edges, self.n_own, order, pairs)
        return pairs[:found]


class PlanarBarrier:
    """See `gyrify.energy.collision.Barrier`.

    Every vertex p meets every edge that it is no end of, with half its share of the length. A vertex where
    such edges meet would count with each of them where it is the nearest point, so that the pair of p and it
    is taken away once (Li et al. 2023).
    """

    def __init__(self, contour: PlanarContour, d_hat: float, stiffness: float) -> None:
        self._contour = contour
        self._limit, self._scale = d_hat**2, stiffness * d_hat

    def evaluate(
        self, pairs: IntArray, vertices: FloatArray, order: int, project_psd: bool
    ) -> PairSum | None:
        """See `gyrify.energy.collision.Barrier`."""
        x = np.ascontiguousarray(vertices)
        vertex, vertex_weight, edge, edge_weight = self._close(pairs, x)
        gradient = np.zeros_like(x)
        n_blocks = (vertex.shape[0], edge.shape[0]) if order == 2 else (0, 0)
        blocks = np.empty((n_blocks[0], 4, 4)), np.empty((n_blocks[1], 6, 6))
        given = self._scale, self._limit, order, gradient
        value = kernels.vertex_pairs(x, vertex, vertex_weight, *given, blocks[0])
        value += kernels.edge_pairs(x, edge, edge_weight, *given, blocks[1])
        if not np.isfinite(value) or order == 0:
            return PairSum(float(value))
        if order == 1:
            return PairSum(float(value), gradient)
        # Without pairs too, so that everything is compiled before the first increment.
        parts = [
            _entries(ends, block, project_psd) for ends, block in zip((vertex, edge), blocks, strict=True)
        ]
        row, col, data = (np.concatenate(columns) for columns in zip(*parts, strict=True))
        return PairSum(float(value), gradient, (row, col, data)) if data.size else None

    def _close(self, pairs: IntArray, x: FloatArray) -> tuple[IntArray, FloatArray, IntArray, FloatArray]:
        """Close pairs of two vertices and of a vertex and an edge, each once, with their weights [mm]."""
        edges, half = self._contour.edges, 0.5 * self._contour.share
        kind, squared = np.empty(len(pairs), dtype=np.int64), np.empty(len(pairs))
        kernels.close_pairs(x, edges, pairs, self._limit, kind, squared)
        close = kind >= 0
        pairs, kind = pairs[close], kind[close]
        inside, own = kind == 2, self._contour.n_own
        edge = np.column_stack([pairs[inside, 0], edges[pairs[inside, 1]]])
        edge_weight = np.where(edge[:, 0] < own, half[edge[:, 0]], 0.0)
        at_end = np.column_stack([pairs[~inside, 0], edges[pairs[~inside, 1], kind[~inside]]])
        taken = self._near_ends(pairs, x)
        both = np.concatenate([at_end, taken])
        weight = np.concatenate([half[at_end[:, 0]], -half[taken[:, 0]]])
        codes, position = np.unique(both.min(axis=1) * x.shape[0] + both.max(axis=1), return_inverse=True)
        vertex = np.column_stack([codes // x.shape[0], codes % x.shape[0]])
        vertex_weight = np.bincount(position.ravel(), weight, codes.size) * np.mean(vertex < own, axis=1)
        counts = edge_weight != 0.0
        return vertex, vertex_weight, edge[counts], edge_weight[counts]

    def _near_ends(self, pairs: IntArray, x: FloatArray) -> IntArray:
        """(n, 2) vertices, and close ends of close edges that are no neighbours of theirs; each pair once."""
        ends = self._contour.edges[pairs[:, 1]]
        both = np.column_stack([np.repeat(pairs[:, 0], 2), ends.ravel()])
        both = both[((x[both[:, 0]] - x[both[:, 1]]) ** 2).sum(axis=1) < self._limit]
        both = both[~np.isin(np.sort(both, axis=1) @ [x.shape[0], 1], self._contour.neighbours)]
        codes = np.unique(both[:, 0] * x.shape[0] + both[:, 1])
        return np.column_stack([codes // x.shape[0], codes % x.shape[0]])


def _entries(ends: IntArray, blocks: FloatArray, project_psd: bool) -> tuple[IntArray, IntArray, FloatArray]:
    """Upper triangles of the matrices of all pairs, by rows and columns of the contour."""
    if project_psd:
        project_all(blocks)
    dofs = (2 * ends[:, :, None] + np.arange(2)).reshape(len(ends), 2 * ends.shape[1])
    i, j = np.triu_indices(blocks.shape[1])
    row, col = dofs[:, i].ravel(), dofs[:, j].ravel()
    return np.minimum(row, col), np.maximum(row, col), blocks[:, i, j].ravel()
