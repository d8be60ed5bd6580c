"""Fields of one state of a body in the plane; see `gyrify.store.fields` for names, shapes and units."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np

from gyrify.config.run_sections import ALL_FIELDS, OutputField
from gyrify.metrics.contour import distance_to_line
from gyrify.metrics.curvature import curvature
from gyrify.physics.stress import planar_cauchy
from gyrify.solve.types import FloatArray

if TYPE_CHECKING:
    from gyrify.store.fields import FieldMaker

# Fields with a value per point; the others have one per cell.
POINT_FIELDS: Final[frozenset[OutputField]] = frozenset(
    {"displacement", "thickness", "curvature", "contact_force"}
)
# Fields computed at integration points, whose means over the cells are given.
CELL_FIELDS: Final = frozenset(ALL_FIELDS) - POINT_FIELDS - {"region"}


class StateFields:
    """Fields of one state, computed when asked for; see `fields` for names, shapes and units."""

    def __init__(self, maker: FieldMaker, u: FloatArray, fraction: float, u_start: FloatArray) -> None:
        self._maker, self._problem = maker, maker.problem
        self._state, self._u_start = u, u_start
        self._u = u[: maker.problem.mesh.n_points]
        self._time = fraction * maker.problem.config.growth.duration
        self._getters: dict[OutputField, Callable[[], FloatArray]] = {
            "displacement": lambda: self._u,
            "region": lambda: self._problem.mesh.region.astype(np.float64),
            "growth_stretch": lambda: self._stretch,
            "J": lambda: self._J,
            "J_elastic": lambda: self._J_e,
            "J_growth": lambda: self._problem.volume_growth(self._time),
            "cauchy_stress": self._cauchy_stress,
            "von_mises": self._von_mises,
            "mean_stress": self._mean_stress,
            "circumferential_stress": self._circumferential_stress,
            "thickness": self._thickness,
            "curvature": self._curvature,
            "contact_force": self._contact_force,
        }

    def __getitem__(self, name: OutputField) -> FloatArray:
        values = self._getters[name]()
        return self._problem.simplices.cell_means(values) if name in CELL_FIELDS else values

    @cached_property
    def _stretch(self) -> FloatArray:
        """(n,) growth stretch of the tissue."""
        return self._problem.growth.stretch(self._time)

    @cached_property
    def _F(self) -> FloatArray:
        return self._maker.deformation(self._u)

    @cached_property
    def _J(self) -> FloatArray:
        axial = self._problem.axial_stretch(self._state)
        return np.asarray((self._F[0, 0] * self._F[1, 1] - self._F[0, 1] * self._F[1, 0]) * axial)

    @cached_property
    def _J_e(self) -> FloatArray:
        return np.asarray(self._J / self._problem.volume_growth(self._time))

    @cached_property
    def _F_e(self) -> FloatArray:
        """(2, 2, n) elastic deformation gradient in the plane."""
        growth, F = self._problem.growth, self._F
        if growth.is_isotropic:
            return np.asarray(F / self._stretch)
        return np.asarray(np.einsum("ikc,ckj->ijc", F, growth.inverse(self._time)))

    @cached_property
    def stress(self) -> tuple[FloatArray, ...]:
        """Cauchy stress components 11, 22, 33, 12, each (n,) [Pa]; 13 and 23 are zero."""
        problem, F = self._problem, self._F_e
        f33 = problem.axial_stretch(self._state) / problem.growth.out_of_plane(self._time)
        pressure = problem.volumetric_pressure(self._state, self._time)
        return planar_cauchy(problem.material, F, f33, self._J_e, problem.parameters, pressure)

    @property
    def cell_stress(self) -> tuple[FloatArray, ...]:
        """Means over the cells of `stress`, each (n_cells,) [Pa]."""
        return tuple(map(self._problem.simplices.cell_means, self.stress))

    def _cauchy_stress(self) -> FloatArray:
        s11, s22, s33, s12 = self.stress
        tensor = np.zeros((s11.size, 3, 3))
        tensor[:, 0, 0], tensor[:, 1, 1], tensor[:, 2, 2] = s11, s22, s33
        tensor[:, 0, 1] = tensor[:, 1, 0] = s12
        return tensor

    def _mean_stress(self) -> FloatArray:
        return (self.stress[0] + self.stress[1] + self.stress[2]) / 3.0

    def _von_mises(self) -> FloatArray:
        """sqrt(3/2 s:s) of the three-dimensional deviator s [Pa]."""
        s11, s22, s33, s12 = self.stress
        squares = (s11 - s22) ** 2 + (s22 - s33) ** 2 + (s33 - s11) ** 2
        return np.asarray(np.sqrt(0.5 * squares + 3.0 * s12 * s12))

    def _circumferential_stress(self) -> FloatArray:
        """Normal stress along the layers as they lie now [Pa].

        The direction is the pushed-forward tangent t = F T, T perpendicular to the reference direction N
        across the layers. In the plane it is also perpendicular to the pushed-forward normal F^{-T} N.
        """
        s11, s22, _, s12 = self.stress
        F, (T1, T2) = self._F, self._maker.along
        t1, t2 = F[0, 0] * T1 + F[0, 1] * T2, F[1, 0] * T1 + F[1, 1] * T2
        projected = s11 * t1 * t1 + s22 * t2 * t2 + 2.0 * s12 * t1 * t2
        return np.asarray(projected / (t1 * t1 + t2 * t2))

    @cached_property
    def _contour(self) -> FloatArray:
        mesh = self._problem.mesh
        return np.asarray(mesh.points[mesh.contour] + self._u[mesh.contour])

    def _on_contour(self, values: FloatArray) -> FloatArray:
        everywhere = np.full(self._problem.mesh.n_points, np.nan)
        everywhere[self._problem.mesh.contour] = values
        return everywhere

    @property
    def _shift(self) -> float:
        """Distance in x from the contour of a strip to its continuation [mm]; 0 for a ring."""
        mesh = self._problem.mesh
        start, after = mesh.points[mesh.contour[:2], 0]
        return 0.0 if mesh.period is None else float(np.copysign(mesh.period, after - start))

    def _curvature(self) -> FloatArray:
        # A strip's contour that runs to the right has the tissue on its right.
        outwards = -1.0 if self._shift > 0.0 else 1.0
        return self._on_contour(outwards * curvature(self._contour, self._shift))

    def _thickness(self) -> FloatArray:
        mesh, shift = self._problem.mesh, self._shift
        interface = mesh.points[mesh.interface] + self._u[mesh.interface]
        if shift == 0.0:
            return self._on_contour(distance_to_line(self._contour, interface))
        line = np.concatenate([np.add(interface, [images * shift, 0.0]) for images in (-1, 0, 1)])
        return self._on_contour(distance_to_line(self._contour, line, closed=False))

    def _contact_force(self) -> FloatArray:
        """Force of the barrier on each point, minus the gradient of the contact energy [Pa mm]."""
        if not self._problem.config.contact.enabled:
            return np.zeros_like(self._u)
        force = np.zeros_like(self._u)
        for term in self._problem.contacts(self._u_start):
            gradient = term.evaluate(self._u, 1).gradient
            force = force if gradient is None else force - gradient
        return force
