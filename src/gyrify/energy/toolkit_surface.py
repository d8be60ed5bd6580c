"""Contact of a surface in space by the IPC Toolkit (ipctk): vertex-face and edge-edge pairs."""

from __future__ import annotations

import ipctk
import numpy as np

from gyrify.energy.term import FloatArray, IntArray
from gyrify.energy.toolkit import ToolkitContour


class ToolkitSurface(ToolkitContour):
    """See `gyrify.energy.collision.CollisionContour`.

    Parameters
    ----------
    reference, edges, faces, n_own, source
        As of `gyrify.energy.contact_libraries.collision_contour`.
    """

    def __init__(
        self,
        reference: FloatArray,
        edges: IntArray,
        faces: IntArray,
        n_own: int | None,
        source: IntArray,
    ) -> None:
        self.n_own, self.edges, self.faces, self._source = n_own, edges, faces, source
        self.mesh = ipctk.CollisionMesh(
            np.asfortranarray(reference),
            np.asfortranarray(edges.astype(np.int32)),
            np.asfortranarray(faces.astype(np.int32)),
        )
        if n_own is not None:
            # Images do not meet each other.
            self.mesh.can_collide = ipctk.make_static_obstacle_filter(n_own)

    def coupled(self, pairs: ipctk.Candidates) -> IntArray:
        """See `gyrify.energy.collision.CollisionContour`."""
        corners = _ids([(c.vertex_id, c.face_id) for c in pairs.fv_candidates])
        crossed = _ids([(c.edge0_id, c.edge1_id) for c in pairs.ee_candidates])
        below = np.stack([np.repeat(corners[:, 0], 3), self.faces[corners[:, 1]].ravel()], axis=1)
        first, second = self.edges[crossed[:, 0]], self.edges[crossed[:, 1]]
        across = [np.stack([first[:, i], second[:, j]], axis=1) for i in (0, 1) for j in (0, 1)]
        return np.concatenate([below, *across])

    def share(self, collisions: ipctk.NormalCollisions) -> None:
        """Weigh the pairs of a periodic surface so that each one, modulo the periods, counts once.

        Among the copies of a pair, that one counts whose vertex, or whose lower-numbered edge, is the
        surface's own; two copies count by half where a thing meets its own image.
        """
        if self.n_own is None:
            return
        vertices = [(pair.vertex0_id, pair.vertex1_id) for pair in collisions.vv_collisions]
        single = [pair.vertex_id for pair in collisions.ev_collisions]
        edges = [(pair.edge0_id, pair.edge1_id) for pair in collisions.ee_collisions]
        corners = [pair.vertex_id for pair in collisions.fv_collisions]
        number, is_own = self._edge_numbers()
        shares = np.concatenate(
            [
                _shares(_ids(vertices), self._source, np.arange(self._source.size) < self.n_own),
                np.array(single, dtype=np.int64) < self.n_own,
                _shares(_ids(edges), number, is_own),
                np.array(corners, dtype=np.int64) < self.n_own,
            ]
        ).astype(np.float64)
        for pair in np.flatnonzero(shares < 1.0).tolist():
            collisions[pair].weight *= shares[pair]

    def _edge_numbers(self) -> tuple[IntArray, np.ndarray[tuple[int], np.dtype[np.bool_]]]:
        """A number that images of an edge share, and whether its lower-numbered end is the surface's own."""
        ends = self._source[self.edges]
        low = np.argmin(ends, axis=1)[:, None]
        number = np.sort(ends, axis=1) @ np.array([int(self._source.max()) + 1, 1])
        return number, np.take_along_axis(self.edges, low, axis=1)[:, 0] < (self.n_own or 0)


def _shares(
    pairs: IntArray, number: IntArray, is_own: np.ndarray[tuple[int], np.dtype[np.bool_]]
) -> FloatArray:
    """Weight of pairs of things of one kind, by the numbers that images share."""
    numbers, own = number[pairs], is_own[pairs].astype(np.float64)
    low = np.argmin(numbers, axis=1)[:, None]
    of_low = np.take_along_axis(own, low, axis=1)[:, 0]
    return np.asarray(np.where(numbers[:, 0] == numbers[:, 1], own.mean(axis=1), of_low))


def _ids(pairs: list[tuple[int, int]]) -> IntArray:
    return np.array(pairs, dtype=np.int64).reshape(-1, 2)
