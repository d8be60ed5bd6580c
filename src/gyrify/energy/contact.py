r"""Frictionless self-contact of a polyline by the incremental potential contact barrier.

.. math::
   E(u) = \sum_k \tfrac12 A_k \, k_b \, \hat d \; b(d_k^2 / \hat d^2), \quad
   b(s) = -(s - 1)^2 \ln s \; (s < 1), \; 0 \text{ otherwise}

over vertex-edge pairs at distance d_k with the vertex's reference length A_k (Li et al. 2020; area
weights and the improved maximum approximation of Li et al. 2023). The barrier is infinite at contact, so
a state of finite energy reached by collision-free steps never interpenetrates.
"""

from __future__ import annotations

from functools import cached_property

import ipctk
import numpy as np

from gyrify.energy.images import Polyline, share_pairs
from gyrify.energy.neighbourhood import Neighbourhood
from gyrify.energy.term import Evaluation, FloatArray, Hessian, IntArray, Pattern

# ipctk sums over threads; one thread makes the sum, and so the run, reproducible.
ipctk.set_num_threads(1)
ipctk.set_logger_level(ipctk.LoggerLevel.error)

# Steps stop short of contact, so that the barrier stays finite.
SAFETY = 0.9


class ContactSurface:
    """Outer contour as a collision mesh.

    Parameters
    ----------
    points : (n_points, 2) float array
        Reference coordinates of the whole mesh [mm].
    contour : (n_contour,) int array
        Points of the contour in order.
    is_closed : bool
        Whether the last point joins the first.
    period : float, optional
        Period in x [mm]: the last point joins the first one period further, and the contour meets its
        images on both sides.

    Attributes
    ----------
    source : (n_vertices,) int array
        Point of the whole mesh that each vertex of the collision mesh moves with.
    is_periodic : bool
        Whether there are images.
    """

    def __init__(
        self, points: FloatArray, contour: IntArray, is_closed: bool = True, period: float | None = None
    ) -> None:
        line = Polyline.of(contour.size, is_closed, period)
        self.contour, self.source = contour, contour[line.vertices]
        self.n_points = points.shape[0]
        self.is_periodic = period is not None
        self.edges = np.asfortranarray(line.edges.astype(np.int32))
        self.reference = np.asfortranarray(points[self.source] + line.offset)
        self.mesh = ipctk.CollisionMesh(self.reference, self.edges)
        if self.is_periodic:
            # Images do not meet each other.
            self.mesh.can_collide = ipctk.make_static_obstacle_filter(contour.size)

    def vertices(self, u: FloatArray) -> FloatArray:
        """(n_vertices, 2) deformed vertices [mm] in the Fortran order that ipctk wants."""
        return np.asfortranarray(self.reference + u[self.source])

    def is_path_collision_free(self, u: FloatArray, u_end: FloatArray) -> bool:
        """Whether the straight path between two states is free of crossings."""
        return bool(ipctk.is_step_collision_free(self.mesh, self.vertices(u), self.vertices(u_end)))

    def shortest_edge(self, u: FloatArray) -> float:
        """Length of the shortest deformed edge [mm]."""
        x = self.vertices(u)
        return float(np.linalg.norm(x[self.edges[:, 1]] - x[self.edges[:, 0]], axis=1).min())

    def couplings(self, u: FloatArray, distance: float) -> IntArray:
        """(n_pairs, 2) point indices of vertices and edge ends closer than a distance [mm]."""
        candidates = ipctk.Candidates()
        candidates.build(self.mesh, self.vertices(u), distance)
        found = [(c.vertex_id, c.edge_id) for c in candidates.ev_candidates]
        pairs = np.array(found, dtype=np.int64).reshape(-1, 2)
        ends = self.edges[pairs[:, 1]]
        vertices = np.repeat(pairs[:, :1], 2, axis=1)
        both = self.source[np.stack([vertices.ravel(), ends.ravel()], axis=1)]
        return np.asarray(np.unique(np.sort(both, axis=1), axis=0))


class ContactEnergy:
    """Barrier of one contour; see the module's equation.

    Parameters
    ----------
    surface : ContactSurface
        The contour.
    d_hat : float
        Activation distance [mm]; below the shortest edge, so that neighbours do not repel.
    barrier_stiffness : float
        k_b [Pa].
    reach : float, optional
        Motion of a vertex for which pairs are searched in advance [mm]; what costs least is a part of the
        shortest edge. By default the activation distance.
    """

    is_barrier = True

    def __init__(
        self, surface: ContactSurface, d_hat: float, barrier_stiffness: float, reach: float | None = None
    ) -> None:
        self.surface = surface
        self.d_hat = d_hat
        self._near = Neighbourhood(surface.mesh, d_hat, d_hat if reach is None else reach)
        self._barrier = ipctk.BarrierPotential(d_hat, barrier_stiffness, True)

    def _collisions(self, vertices: FloatArray) -> ipctk.NormalCollisions:
        collisions = ipctk.NormalCollisions()
        collisions.use_area_weighting = True
        collisions.collision_set_type = ipctk.NormalCollisions.IMPROVED_MAX_APPROX
        collisions.build(self._near.pairs(vertices), self.surface.mesh, vertices, self.d_hat)
        if self.surface.is_periodic:
            share_pairs(collisions, self.surface.contour.size)
        return collisions

    def evaluate(self, u: FloatArray, order: int, project_psd: bool = False) -> Evaluation:
        """Energy [Pa mm^2], gradient [Pa mm], Hessian [Pa]; see `EnergyTerm`."""
        mesh, vertices = self.surface.mesh, self.surface.vertices(u)
        collisions = self._collisions(vertices)
        gradient = np.zeros_like(u) if order >= 1 else None
        if len(collisions) == 0:
            return Evaluation(0.0, gradient, self._no_hessian if order >= 2 else None)
        value = float(self._barrier(collisions, mesh, vertices))
        if not np.isfinite(value):
            return Evaluation(np.inf)
        if gradient is not None:
            forces = self._barrier.gradient(collisions, mesh, vertices).reshape(-1, 2)
            np.add.at(gradient, self.surface.source, forces)
        hessian = self._hessian(collisions, vertices, project_psd) if order >= 2 else None
        return Evaluation(value, gradient, hessian)

    def max_step(self, u: FloatArray, du: FloatArray) -> float:
        """Largest safe fraction of du, at most 1: the path up to it is free of crossings."""
        start = self.surface.vertices(u)
        step = self._near.collision_free_step(start, np.asfortranarray(start + du[self.surface.source]))
        return 1.0 if step >= 1.0 else SAFETY * step

    def _hessian(
        self, collisions: ipctk.NormalCollisions, vertices: FloatArray, project_psd: bool
    ) -> Hessian:
        method = ipctk.PSDProjectionMethod.CLAMP if project_psd else ipctk.PSDProjectionMethod.NONE
        matrix = self._barrier.hessian(collisions, self.surface.mesh, vertices, method).tocoo()
        upper = matrix.row <= matrix.col
        row, col, data = matrix.row[upper], matrix.col[upper], matrix.data[upper]
        rows, cols = self._dofs(row), self._dofs(col)
        pattern, position = Pattern.of(rows, cols)
        values = np.zeros(pattern.rows.size)
        # The two entries of a vertex and its own image meet on the diagonal.
        np.add.at(values, position, np.where((rows == cols) & (row != col), 2.0 * data, data))
        return Hessian(pattern, values)

    def _dofs(self, local: IntArray) -> IntArray:
        """Degrees of freedom of the mesh of those of the collision mesh (vertex-major, two each)."""
        return self.surface.source[local // 2] * 2 + local % 2

    @cached_property
    def _no_hessian(self) -> Hessian:
        empty = np.empty(0, dtype=np.int64)
        return Hessian(Pattern(empty, empty), np.empty(0))
