r"""Frictionless self-contact of a contour, or a surface in space, by the barrier of incremental potential
contact.

.. math::
   E(u) = \sum_k \tfrac12 A_k \, k_b \, \hat d \; b(d_k^2 / \hat d^2), \quad
   b(s) = -(s - 1)^2 \ln s \; (s < 1), \; 0 \text{ otherwise}

over vertex-edge pairs (in space vertex-face and edge-edge pairs) at distance d_k, with the reference length
(area) A_k of what meets (Li et al. 2020; area weights and the improved maximum approximation of Li et al.
2023). The barrier is infinite at contact, so a state of finite energy reached by collision-free steps never
interpenetrates.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from gyrify.energy.contact_libraries import LibraryName, collision_contour
from gyrify.energy.neighbourhood import Neighbourhood
from gyrify.energy.periodic_line import Polyline
from gyrify.energy.term import Evaluation, FloatArray, Hessian, IntArray, Pattern
from gyrify.energy.triangle_sheet import TriangleSheet, smallest_height

# Steps stop short of contact, so that the barrier stays finite.
SAFETY = 0.9


class ContactSurface:
    """Outer contour or surface as a collision mesh.

    Parameters
    ----------
    points : (n_points, n_dim) float array
        Reference coordinates of the whole mesh [mm].
    contour : (n_contour,) int array
        Points of the contour in order, or those of the surface.
    is_closed : bool
        Whether the last point joins the first; of no meaning in space.
    period : float, optional
        Period in x [mm]: the last point joins the first one period further, and the contour meets its
        images on both sides.
    library : str
        What searches pairs and follows paths; see `gyrify.energy.contact_libraries.contact_library`.
    faces : (n_faces, 3) int array, optional
        In space, the triangles of the surface, in points of the whole mesh.
    period_y : float, optional
        Period in y [mm] of a surface.

    Attributes
    ----------
    collisions : CollisionContour
        The contour as the library sees it.
    source : (n_vertices,) int array
        Point of the whole mesh that each vertex of the collision mesh moves with.
    faces : (n_faces, 3) int array
        Vertices of the collision mesh at the corners of each triangle; none in the plane.
    is_periodic : bool
        Whether there are images.
    """

    def __init__(
        self,
        points: FloatArray,
        contour: IntArray,
        is_closed: bool = True,
        period: float | None = None,
        library: LibraryName = "auto",
        faces: IntArray | None = None,
        period_y: float | None = None,
    ) -> None:
        line: Polyline | TriangleSheet
        if faces is None or faces.size == 0:
            line, self.faces = Polyline.of(contour.size, is_closed, period), np.empty((0, 3), dtype=np.int64)
        else:
            periods = None if period is None or period_y is None else (period, period_y)
            line = TriangleSheet.of(points[contour], np.searchsorted(contour, faces), periods)
            self.faces = line.faces
        self.contour, self.source = contour, contour[line.vertices]
        self.n_points, self.n_dim = points.shape
        self.is_periodic = period is not None
        self.edges = line.edges
        self.reference = np.asfortranarray(points[self.source] + line.offset)
        n_own = contour.size if self.is_periodic else None
        self.collisions = collision_contour(
            self.reference, self.edges, n_own, library, self.faces, self.source
        )

    def vertices(self, u: FloatArray) -> FloatArray:
        """(n_vertices, n_dim) deformed vertices [mm], in Fortran order."""
        return np.asfortranarray(self.reference + u[self.source])

    def is_path_collision_free(self, u: FloatArray, u_end: FloatArray) -> bool:
        """Whether the straight path between two states is free of crossings."""
        return self.collisions.is_path_free(self.vertices(u), self.vertices(u_end))

    def shortest_edge(self, u: FloatArray) -> float:
        """Length of the shortest deformed edge [mm]."""
        x = self.vertices(u)
        return float(np.linalg.norm(x[self.edges[:, 1]] - x[self.edges[:, 0]], axis=1).min())

    def spacing(self, u: FloatArray) -> float:
        """Length of the shortest edge of a contour, smallest height of a triangle of a surface [mm]."""
        if self.faces.size == 0:
            return self.shortest_edge(u)
        return smallest_height(self.vertices(u)[self.faces])

    def couplings(self, u: FloatArray, distance: float) -> IntArray:
        """(n_pairs, 2) point indices of what is closer than a distance [mm]."""
        pairs = self.collisions.coupled(self.collisions.pairs(self.vertices(u), distance))
        both = np.unique(np.sort(self.source[pairs], axis=1), axis=0)
        return np.asarray(both[both[:, 0] != both[:, 1]] if self.n_dim == 3 else both)


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
        self._near = Neighbourhood(surface.collisions, d_hat, d_hat if reach is None else reach)
        self._barrier = surface.collisions.barrier(d_hat, barrier_stiffness)

    def evaluate(self, u: FloatArray, order: int, project_psd: bool = False) -> Evaluation:
        """Energy [Pa mm^2], gradient [Pa mm], Hessian [Pa]; see `EnergyTerm`."""
        vertices = self.surface.vertices(u)
        found = self._barrier.evaluate(self._near.pairs(vertices), vertices, order, project_psd)
        gradient = np.zeros_like(u) if order >= 1 else None
        if found is None:
            return Evaluation(0.0, gradient, self._no_hessian if order >= 2 else None)
        if not np.isfinite(found.value):
            return Evaluation(np.inf)
        if gradient is not None and found.gradient is not None:
            np.add.at(gradient, self.surface.source, found.gradient)
        hessian = None if found.entries is None else self._hessian(*found.entries)
        return Evaluation(found.value, gradient, hessian)

    def max_step(self, u: FloatArray, du: FloatArray) -> float:
        """Largest safe fraction of du, at most 1: the path up to it is free of crossings."""
        start = self.surface.vertices(u)
        step = self._near.collision_free_step(start, np.asfortranarray(start + du[self.surface.source]))
        return 1.0 if step >= 1.0 else SAFETY * step

    def _hessian(self, row: IntArray, col: IntArray, data: FloatArray) -> Hessian:
        rows, cols = self._dofs(row), self._dofs(col)
        pattern, position = Pattern.of(rows, cols)
        values = np.zeros(pattern.rows.size)
        # The two entries of a vertex and its own image meet on the diagonal.
        np.add.at(values, position, np.where((rows == cols) & (row != col), 2.0 * data, data))
        return Hessian(pattern, values)

    def _dofs(self, local: IntArray) -> IntArray:
        """Degrees of freedom of the mesh of those of the collision mesh (vertex-major, n_dim each)."""
        n_dim = self.surface.n_dim
        return np.asarray(self.surface.source[local // n_dim] * n_dim + local % n_dim)

    @cached_property
    def _no_hessian(self) -> Hessian:
        empty = np.empty(0, dtype=np.int64)
        return Hessian(Pattern(empty, empty), np.empty(0))
