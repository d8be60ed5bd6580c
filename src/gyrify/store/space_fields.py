"""Fields of a state of a body in space; see `gyrify.store.fields` for names, shapes and units."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from gyrify.mesh.whole import whole_surface
from gyrify.metrics.surface import mean_curvature
from gyrify.metrics.surface_pairs import distances_to
from gyrify.physics.stress import cauchy
from gyrify.solve.types import FloatArray, IntArray
from gyrify.store.state_fields import StateFields


class SpaceFields(StateFields):
    """Fields of one state, computed when asked for.

    Arrays over the integration points have these first: (n, 3, 3).
    """

    @cached_property
    def _F(self) -> FloatArray:
        """(n, 3, 3) total deformation gradient."""
        simplices = self._problem.simplices
        return np.asarray(
            np.einsum("cai,caj->cij", self._u[simplices.cells], simplices.gradients) + np.eye(3)
        )

    @cached_property
    def _J(self) -> FloatArray:
        return np.asarray(np.linalg.det(self._F))

    @cached_property
    def _tensor(self) -> FloatArray:
        """(n, 3, 3) Cauchy stress [Pa]."""
        problem = self._problem
        F_e = self._F @ problem.growth.inverse(self._time)
        pressure = problem.volumetric_pressure(self._state, self._time)
        return cauchy(problem.material, F_e, problem.parameters, pressure)

    @property
    def stress(self) -> tuple[FloatArray, ...]:
        """Cauchy stress components 11, 22, 33, 12, 23, 13, each (n,) [Pa]."""
        places = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))
        return tuple(self._tensor[:, i, j] for i, j in places)

    def _cauchy_stress(self) -> FloatArray:
        return self._tensor

    def _mean_stress(self) -> FloatArray:
        return np.asarray(np.trace(self._tensor, axis1=1, axis2=2) / 3.0)

    def _von_mises(self) -> FloatArray:
        """sqrt(3/2 s:s) of the deviator s [Pa]."""
        deviator = self._tensor - self._mean_stress()[:, None, None] * np.eye(3)
        return np.asarray(np.sqrt(1.5 * np.einsum("cij,cij->c", deviator, deviator)))

    def _circumferential_stress(self) -> FloatArray:
        """Mean normal stress along the layers as they lie now, (tr s - n s n) / 2 [Pa].

        The normal n is that of the deformed layer, F^{-T} N.
        """
        across = self._problem.mesh.across[self._problem.simplices.cell]
        n = np.linalg.solve(np.swapaxes(self._F, 1, 2), across[:, :, None])[:, :, 0]
        n /= np.linalg.norm(n, axis=1, keepdims=True)
        normal = np.einsum("ci,cij,cj->c", n, self._tensor, n)
        return np.asarray(0.5 * (3.0 * self._mean_stress() - normal))

    def _curvature(self) -> FloatArray:
        """Mean curvature of the outer surface, positive where it bulges outwards [1/mm]."""
        mesh = self._problem.mesh
        points, faces = whole_surface(mesh, mesh.points + self._u, mesh.contour, mesh.faces)
        # across a period, corners of a triangle lie next to each other
        corners = points[faces] if mesh.period is None else self._corners(mesh.faces)
        return self._on_contour(mean_curvature(points, faces, corners)[: mesh.contour.size])

    def _thickness(self) -> FloatArray:
        mesh = self._problem.mesh
        return self._on_contour(distances_to(self._contour, self._corners(mesh.interface_faces)))

    def _corners(self, faces: IntArray) -> FloatArray:
        """(n, 3, 3) corners of triangles now, those of one next to each other [mm]."""
        return np.asarray(self._problem.mesh.unwrapped(faces) + self._u[faces])
