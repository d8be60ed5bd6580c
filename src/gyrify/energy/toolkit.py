"""Contact by the IPC Toolkit (ipctk), which has no installable package for some platforms."""

from __future__ import annotations

import ipctk
import numpy as np

from gyrify.energy.collision import PairSum, vertex_and_ends
from gyrify.energy.term import FloatArray, IntArray

# ipctk sums over threads; one thread makes the sum, and so the run, reproducible.
ipctk.set_num_threads(1)
ipctk.set_logger_level(ipctk.LoggerLevel.error)


class ToolkitContour:
    """See `gyrify.energy.collision.CollisionContour`; arrays have the Fortran order that ipctk wants."""

    def __init__(self, reference: FloatArray, edges: IntArray, n_own: int | None) -> None:
        self.n_own, self.edges = n_own, edges
        self.mesh = ipctk.CollisionMesh(
            np.asfortranarray(reference), np.asfortranarray(edges.astype(np.int32))
        )
        if n_own is not None:
            # Images do not meet each other.
            self.mesh.can_collide = ipctk.make_static_obstacle_filter(n_own)

    def pairs(self, vertices: FloatArray, inflation: float) -> ipctk.Candidates:
        """See `gyrify.energy.collision.CollisionContour`."""
        candidates = ipctk.Candidates()
        candidates.build(self.mesh, vertices, inflation)
        return candidates

    def coupled(self, pairs: ipctk.Candidates) -> IntArray:
        """See `gyrify.energy.collision.CollisionContour`."""
        found = [(c.vertex_id, c.edge_id) for c in pairs.ev_candidates]
        return vertex_and_ends(np.array(found, dtype=np.int64).reshape(-1, 2), self.edges)

    def is_path_free(self, start: FloatArray, end: FloatArray) -> bool:
        """See `gyrify.energy.collision.CollisionContour`."""
        return bool(ipctk.is_step_collision_free(self.mesh, start, end))

    def free_step(self, start: FloatArray, end: FloatArray, pairs: ipctk.Candidates | None = None) -> float:
        """See `gyrify.energy.collision.CollisionContour`."""
        if pairs is not None:
            return float(pairs.compute_collision_free_stepsize(self.mesh, start, end))
        return float(ipctk.compute_collision_free_stepsize(self.mesh, start, end))

    def share(self, collisions: ipctk.NormalCollisions) -> None:
        """Weigh pairs with images, which are found twice."""
        if self.n_own is not None:
            share_pairs(collisions, self.n_own)

    def barrier(self, d_hat: float, stiffness: float) -> ToolkitBarrier:
        """See `gyrify.energy.collision.CollisionContour`."""
        return ToolkitBarrier(self, d_hat, stiffness)


class ToolkitBarrier:
    """See `gyrify.energy.collision.Barrier`."""

    def __init__(self, contour: ToolkitContour, d_hat: float, barrier_stiffness: float) -> None:
        self._contour, self._d_hat = contour, d_hat
        self._barrier = ipctk.BarrierPotential(d_hat, barrier_stiffness, True)

    def evaluate(
        self, pairs: ipctk.Candidates, vertices: FloatArray, order: int, project_psd: bool
    ) -> PairSum | None:
        """See `gyrify.energy.collision.Barrier`."""
        mesh, collisions = self._contour.mesh, self._collisions(pairs, vertices)
        if len(collisions) == 0:
            return None
        value = float(self._barrier(collisions, mesh, vertices))
        if not np.isfinite(value) or order == 0:
            return PairSum(value)
        gradient = self._barrier.gradient(collisions, mesh, vertices).reshape(vertices.shape)
        if order == 1:
            return PairSum(value, gradient)
        method = ipctk.PSDProjectionMethod.CLAMP if project_psd else ipctk.PSDProjectionMethod.NONE
        matrix = self._barrier.hessian(collisions, mesh, vertices, method).tocoo()
        upper = matrix.row <= matrix.col
        return PairSum(value, gradient, (matrix.row[upper], matrix.col[upper], matrix.data[upper]))

    def _collisions(self, pairs: ipctk.Candidates, vertices: FloatArray) -> ipctk.NormalCollisions:
        collisions = ipctk.NormalCollisions()
        collisions.use_area_weighting = True
        collisions.collision_set_type = ipctk.NormalCollisions.IMPROVED_MAX_APPROX
        collisions.build(pairs, self._contour.mesh, vertices, self._d_hat)
        self._contour.share(collisions)
        return collisions


def share_pairs(collisions: ipctk.NormalCollisions, n_own: int) -> None:
    """Weigh the pairs of a periodic contour so that each one, modulo the period, counts once.

    A pair with an image is found twice, with the contour's own vertices on either side: a vertex and an edge
    count where the vertex is the contour's own, two vertices by half for each of them that is.

    Parameters
    ----------
    collisions : ipctk.NormalCollisions
        Pairs with at least one vertex of the contour itself; their weights are changed.
    n_own : int
        Number of vertices of the contour itself, which come first.
    """
    vertex_pairs = [(pair.vertex0_id, pair.vertex1_id) for pair in collisions.vv_collisions]
    vertices = [(pair.vertex_id, pair.vertex_id) for pair in collisions.ev_collisions]
    ends = np.array(vertex_pairs + vertices).reshape(-1, 2)
    share = np.mean(ends < n_own, axis=1)
    # An element is a reference into the collisions and must not outlive them.
    for number in np.flatnonzero(share < 1.0).tolist():
        collisions[number].weight *= share[number]
