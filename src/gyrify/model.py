"""From a configuration to the problem that is solved: mesh, tissue fields, energy terms."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from gyrify.config import Config
from gyrify.energy.contact import ContactEnergy, ContactSurface
from gyrify.energy.elastic import CellPattern, ElasticEnergy
from gyrify.energy.kinematics import ElasticKinematics, Simplices
from gyrify.energy.term import EnergyTerm, FloatArray, IntArray
from gyrify.energy.total import TotalEnergy
from gyrify.energy.viscous import DragEnergy, KelvinVoigtEnergy, green_lagrange
from gyrify.errors import ConfigError
from gyrify.mesh import GREY, Mesh
from gyrify.mesh.ring import elliptic_ring
from gyrify.mesh.sheet import Layers
from gyrify.mesh.strip import periodic_strip
from gyrify.physics.growth import growth_stretch, growth_tensor, out_of_plane_growth
from gyrify.physics.neo_hookean import lame_parameters
from gyrify.solve.linear import linear_solver
from gyrify.solve.newton import Criterion
from gyrify.solve.quasistatic import State, Stepping
from gyrify.solve.stability import Tangent
from gyrify.solve.system import System

# Barrier stiffness over Young's modulus of the cortex: sulci then rest at about half the activation distance.
AUTO_BARRIER = 0.1


def build_mesh(config: Config) -> Mesh:
    """Mesh of a configuration.

    Raises
    ------
    ConfigError
        If the geometry or element is not available.
    MeshError
        If the geometry cannot be meshed well.
    """
    geometry, mesh = config.geometry, config.mesh
    _refuse("mesh.element", mesh.element, ("linear",))
    _refuse("mesh.refine", mesh.refine, (0,))
    _refuse("mesh.refine_cortex", mesh.refine_cortex, (0,))
    layers = Layers(
        n_around=mesh.n_around,
        n_layers=mesh.n_layers,
        n_cortex_layers=mesh.n_cortex_layers,
        grading=mesh.grading,
        split=mesh.split,
        node_jitter=mesh.node_jitter,
        seed=config.seed,
    )
    if geometry.shape == "strip":
        return periodic_strip(geometry.length, geometry.depth, geometry.cortical_thickness, layers)
    return elliptic_ring(geometry.semi_axes, geometry.hole_fraction, geometry.cortical_thickness, layers)


def _refuse(field: str, value: object, available: tuple[object, ...]) -> None:
    if value not in available:
        choices = ", ".join(repr(choice) for choice in available)
        raise ConfigError(
            f"{field} = {value!r} is not available in this version.", f"Choose one of: {choices}."
        )


class Slice:
    """A growing slice of brain tissue: the problem that `gyrify.solve.quasistatic.grow` solves.

    Parameters
    ----------
    config : Config
        Every number of the run.
    mesh : Mesh, optional
        Mesh to use instead of the configured one.

    Attributes
    ----------
    mesh : Mesh
        The reference mesh.
    rate : (n_cells,) float array
        Growth rate of each cell [1/time].
    mu, kappa : (n_cells,) float array
        Shear and bulk modulus of each cell [Pa].
    """

    def __init__(self, config: Config, mesh: Mesh | None = None) -> None:
        _refuse("growth.out_of_plane", config.growth.out_of_plane, ("blocked", "none"))
        self.config = config
        self.mesh = build_mesh(config) if mesh is None else mesh
        grey = self.mesh.region == GREY
        growth, material = config.growth, config.material
        self.rate = np.where(grey, growth.rate, growth.rate_white)
        self.tangential = grey & (growth.law == "tangential")
        grey_moduli = lame_parameters(material.young_modulus, material.poisson_ratio)
        white_moduli = lame_parameters(material.young_modulus_white, material.poisson_ratio_white)
        self.mu, self.kappa = (np.where(grey, g, w) for g, w in zip(grey_moduli, white_moduli, strict=True))

    def varied(self, config: Config) -> Slice:
        """Slice of another configuration on the same mesh; what depends on the mesh alone is shared."""
        other = Slice(config, self.mesh)
        shared = ("simplices", "pattern", "surface", "lumped_area", "free", "free_mass")
        other.__dict__.update({name: getattr(self, name) for name in shared})
        return other

    @cached_property
    def simplices(self) -> Simplices:
        """Cells and their shape-function gradients."""
        return Simplices.of(self.mesh.cell_points, self.mesh.cells, self.mesh.n_points)

    @cached_property
    def pattern(self) -> CellPattern:
        """Sparsity of the cells."""
        return CellPattern(self.mesh.cells, self.mesh.n_dim)

    @cached_property
    def surface(self) -> ContactSurface:
        """Outer contour, for contact."""
        return ContactSurface(self.mesh.points, self.mesh.contour, self.mesh.is_closed, self.mesh.period)

    @cached_property
    def lumped_area(self) -> FloatArray:
        """(n_points,) reference area of each point [mm^2]."""
        n_nodes = self.mesh.cells.shape[1]
        area = np.zeros(self.mesh.n_points)
        np.add.at(area, self.mesh.cells, self.simplices.volumes[:, None] / n_nodes)
        return area

    @cached_property
    def free_mass(self) -> FloatArray:
        """(n_free,) lumped reference area of each free degree of freedom [mm^2]."""
        return np.asarray(np.repeat(self.lumped_area, self.mesh.n_dim)[self.free])

    @cached_property
    def free(self) -> IntArray:
        """Free degrees of freedom."""
        is_free = np.ones(self.mesh.n_points, dtype=bool)
        is_free[self.mesh.clamped] = False
        return np.flatnonzero(np.repeat(is_free, self.mesh.n_dim))

    @cached_property
    def mean_cortical_edge(self) -> float:
        """Mean length of the edges of grey cells [mm]."""
        corners = self.mesh.cell_points[self.mesh.region == GREY]
        return float(np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).mean())

    @property
    def stepping(self) -> Stepping:
        """Increments and tolerance in physical units."""
        solver, E = self.config.solver, self.config.material.young_modulus
        criterion = Criterion(solver.tolerance * E * self.mean_cortical_edge, solver.max_newton)
        return Stepping(solver.increments, solver.min_increment, criterion)

    @property
    def is_conservative(self) -> bool:
        """Whether nothing dissipates, so that an accepted state is an equilibrium of the tissue itself."""
        dissipation = self.config.dissipation
        return dissipation.kind == "none" or dissipation.number == 0.0

    @property
    def shift_mass(self) -> FloatArray | None:
        """See `gyrify.solve.quasistatic.Problem`: the mass, unless a projection is asked for."""
        return self.free_mass if self.config.solver.regularisation == "shift" else None

    @property
    def is_path_kept(self) -> bool:
        """See `gyrify.solve.quasistatic.Problem`: a bifurcation is to be seen, and nothing unfolds it."""
        stability, is_perfect = self.config.stability, self.config.mesh.node_jitter == 0.0
        return self.is_conservative and stability.detect and (stability.follow_branch or is_perfect)

    @property
    def barrier_stiffness(self) -> float:
        """Stiffness of the contact barrier [Pa]."""
        chosen = self.config.contact.barrier_stiffness
        return AUTO_BARRIER * self.config.material.young_modulus if chosen == "auto" else float(chosen)

    def compile(self) -> None:
        """Compile the kernels, or load them from their cache, so that no increment has to wait for it."""
        u = np.zeros_like(self.mesh.points)
        energy = self.elastic_energy(self.kinematics(0.0))
        energy.evaluate(u, order=2, project_psd=True)
        energy.max_step(u, u)
        self.simplices.volume_ratio(u)

    def kinematics(self, time: float) -> ElasticKinematics:
        """Cells in their grown state at a growth time."""
        stretch = growth_stretch(self.rate, time, self.config.growth.stretch)
        out_of_plane = out_of_plane_growth(stretch, self.config.growth.out_of_plane)
        return ElasticKinematics.of(
            self.simplices, growth_tensor(stretch, self.tangential, self.mesh.across), out_of_plane
        )

    def volume_growth(self, time: float) -> FloatArray:
        """(n_cells,) J_g = det F_g at a growth time, the 33 entry included."""
        stretch = growth_stretch(self.rate, time, self.config.growth.stretch)
        out_of_plane = out_of_plane_growth(stretch, self.config.growth.out_of_plane)
        across = np.where(self.tangential, 1.0, stretch)
        return np.asarray(stretch ** (self.mesh.n_dim - 1) * across * out_of_plane)

    def tissue_energy(self, fraction: float, start_u: FloatArray) -> TotalEnergy:
        """Energy of elasticity and contact alone, for an increment that starts at a displacement."""
        terms: list[EnergyTerm] = [
            self.elastic_energy(self.kinematics(fraction * self.config.growth.duration))
        ]
        if self.config.contact.enabled:
            terms.append(self.contact_energy(start_u))
        return TotalEnergy(terms)

    def tangent(self, fraction: float, u: FloatArray, start_u: FloatArray, system: System) -> Tangent:
        """Exact stiffness of elasticity and contact alone at a state."""
        evaluations = self.tissue_energy(fraction, start_u).evaluate(u, project_psd=False)
        return Tangent(evaluations, system, self.free_mass, lambda: self.candidates(u))

    def is_stable(self, fraction: float, u: FloatArray) -> bool:
        """Whether elastic and contact energy alone have a positive definite Hessian at a state."""
        return self.tangent(fraction, u, u, self.system(np.empty((0, 2), dtype=np.int64))).is_stable

    def elastic_energy(self, kinematics: ElasticKinematics) -> ElasticEnergy:
        """Hyperelastic energy of grown cells."""
        return ElasticEnergy(kinematics, self.mu, self.kappa, self._weight(kinematics), self.pattern)

    def contact_energy(self, u: FloatArray) -> ContactEnergy:
        """Contact barrier for an increment that starts at a state u."""
        contact, T = self.config.contact, self.config.geometry.cortical_thickness
        d_hat = min(contact.activation_fraction * T, 0.5 * self.surface.shortest_edge(u))
        return ContactEnergy(self.surface, d_hat, self.barrier_stiffness)

    def energy(self, fraction: float, start: State, start_fraction: float) -> TotalEnergy:
        """See `gyrify.solve.quasistatic.Problem`."""
        duration = self.config.growth.duration
        kinematics = self.kinematics(fraction * duration)
        terms: list[EnergyTerm] = [self.elastic_energy(kinematics)]
        terms += self._dissipation(kinematics, start, start_fraction * duration, fraction - start_fraction)
        if self.config.contact.enabled:
            terms.append(self.contact_energy(start.u))
        return TotalEnergy(terms)

    def system(self, couplings: IntArray) -> System:
        """See `gyrify.solve.quasistatic.Problem`."""
        n_dofs = self.mesh.n_points * self.mesh.n_dim
        solver = linear_solver(self.config.solver.linear_solver)
        return System(self.free, n_dofs, self.mesh.n_dim, self.pattern.pattern, solver, couplings)

    def candidates(self, u: FloatArray) -> IntArray:
        """Point pairs of the contour closer than its shortest edge."""
        return self.surface.couplings(u, 0.5 * self.surface.shortest_edge(u))

    def is_path_admissible(self, u: FloatArray, u_end: FloatArray) -> bool:
        """See `gyrify.solve.quasistatic.Problem`."""
        return not self.config.contact.enabled or self.surface.is_path_collision_free(u, u_end)

    def _weight(self, kinematics: ElasticKinematics) -> FloatArray:
        """Volume that energy densities are counted by [mm^2]; rule 7: grown, so det F_g is not lost."""
        if self.config.growth.energy_per == "grown":
            return kinematics.volumes * kinematics.J_g
        return kinematics.volumes

    def _dissipation(
        self, kinematics: ElasticKinematics, start: State, start_time: float, span: float
    ) -> list[EnergyTerm]:
        """Energy of the increment's dissipation; ``span`` is a fraction of the duration."""
        if self.is_conservative:
            return []
        kind, number = self.config.dissipation.kind, self.config.dissipation.number
        rate = number * self.config.material.young_modulus / span
        if kind == "drag":
            return [DragEnergy(rate / self.config.geometry.drag_length**2, self.lumped_area, start.u)]
        strain = green_lagrange(self.kinematics(start_time).deformation(start.u))
        return [KelvinVoigtEnergy(kinematics, rate, self._weight(kinematics), strain, self.pattern)]
