"""From a configuration to the problem that is solved: tissue, contact, dissipation, increments."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property

import numpy as np

from gyrify.base.force_units import force_unit
from gyrify.config import Config
from gyrify.energy.contact import ContactEnergy, ContactSurface
from gyrify.energy.contact_libraries import LibraryName
from gyrify.energy.plane_contact import PlaneContact
from gyrify.energy.term import FloatArray, IntArray
from gyrify.energy.total import TotalEnergy
from gyrify.energy.unknowns import Unknowns
from gyrify.errors import SolveError
from gyrify.mesh.symmetry import representatives
from gyrify.model.internal import INTERNAL
from gyrify.model.meshing import build_mesh
from gyrify.model.rigid import rigid_modes
from gyrify.model.solver_choice import chosen_solver
from gyrify.model.terms import CONSERVATIVE, GrowthStep, terms_of
from gyrify.model.tissue import Tissue
from gyrify.solve.iterative.blocks import Nodes
from gyrify.solve.linear import SolverName, linear_solver
from gyrify.solve.newton import Criterion
from gyrify.solve.problem import State, Stepping
from gyrify.solve.quasi_newton import STEPS
from gyrify.solve.stability import Tangent
from gyrify.solve.system import System

__all__ = ["Slice", "build_mesh"]

# Barrier stiffness over Young's modulus of the cortex: sulci then rest at about half the activation distance.
AUTO_BARRIER = 0.1
# Distance over the shortest edge within which points enter the sparsity pattern together: far enough that few
# new symbolic analyses are needed, near enough that the factor stays sparse.
REACH = 3.0
# The same in space over the smallest height of a triangle: near it, all neighbours are within reach.
REACH_IN_SPACE = 0.6
# Edge of the contour over the shortest undeformed one below which it has collapsed; regular folds stay above.
# Between the integration points of a quadratic cell no elastic energy resists that, so that contact has to:
# were its distance to follow the edge further, both would halve until no increment is left.
COLLAPSED = 0.1


class Slice(Tissue):
    """A growing slice of brain tissue: the problem that `gyrify.solve.quasistatic.grow` solves.

    Parameters
    ----------
    config : Config
        Every number of the run.
    mesh : Mesh, optional
        Mesh to use instead of the configured one.

    Attributes
    ----------
    contact_library : str
        What searches pairs and follows paths; see `gyrify.energy.contact_libraries.contact_library`.
    """

    contact_library: LibraryName = "auto"

    def use_contact_library(self, name: LibraryName) -> None:
        """Have contact computed by another library."""
        self.contact_library = name
        self.__dict__.pop("surface", None)

    @cached_property
    def linear_solver(self) -> SolverName:
        """What solves the linear systems, ``auto`` resolved."""
        return chosen_solver(self.config, self.unknowns, self.state_shape)

    def use_linear_solver(self, name: SolverName) -> None:
        """Have linear systems solved by another library."""
        self.__dict__["linear_solver"] = name

    def varied(self, config: Config) -> Slice:
        """Slice of another configuration on the same mesh; what depends on the mesh alone is shared."""
        other = Slice(config, self.mesh)
        other.contact_library = self.contact_library
        if config.solver.linear_solver == self.config.solver.linear_solver:
            other.use_linear_solver(self.linear_solver)
        shared = (
            "simplices",
            "pattern",
            "patches",
            "surface",
            "lumped_area",
            "free",
            "supported",
            "free_mass",
            "unknowns",
        )
        other.__dict__.update({name: getattr(self, name) for name in shared})
        return other

    @cached_property
    def surface(self) -> ContactSurface:
        """Outer contour, for contact."""
        mesh, library = self.mesh, self.contact_library
        line = (mesh.points, mesh.contour, mesh.is_closed, mesh.period, library)
        try:
            return ContactSurface(*line, mesh.faces, mesh.period_y)
        except ImportError as missing:
            raise SolveError(
                "Contact in space needs the IPC Toolkit (ipctk), which is not installed here.",
                "Install it with pip install ipctk, or set contact.enabled = false to compare without.",
            ) from missing

    @cached_property
    def free_mass(self) -> FloatArray:
        """(n_supported,) lumped reference area of what moves in `system` [mm^2]; all of it for F33."""
        return np.asarray(self._mass[self.supported])

    @property
    def _mass(self) -> FloatArray:
        """(n_dofs,) lumped reference area of each degree of freedom [mm^2]."""
        area = np.where(self.lumped_area > 0.0, self.lumped_area, self.lumped_area.sum())
        return np.repeat(area, self.mesh.n_dim)

    @property
    def _moving(self) -> IntArray:
        """Degrees of freedom that increments move: drag holds a free body by itself."""
        is_dragged = self.config.dissipation.kind == "drag" and not self.is_conservative
        return self.free if is_dragged else self.supported

    @cached_property
    def unknowns(self) -> Unknowns | None:
        """What the free degrees of freedom follow in an increment: half or a quarter of a symmetric mesh."""
        mirrors = self.mesh.mirrors
        if not mirrors:
            return None
        n_rows, n_dim = self.state_shape
        source, sign = representatives(mirrors, self.mesh.n_points, n_dim)
        own = np.arange(source.size, n_rows * n_dim)  # the axial unknown
        return Unknowns.of(
            np.concatenate([source, own]), np.concatenate([sign, np.ones(own.size)]), self._moving
        )

    @property
    def stepping(self) -> Stepping:
        """Increments and tolerance in physical units."""
        solver, E = self.config.solver, self.config.material.young_modulus
        size = self.mean_cortical_edge ** (self.mesh.n_dim - 1)
        criterion = Criterion(solver.tolerance * E * size, solver.max_newton)
        return Stepping(solver.increments, solver.min_increment, criterion, force_unit(self.mesh.n_dim))

    @property
    def is_conservative(self) -> bool:
        """Whether nothing dissipates, so that an accepted state is an equilibrium of the tissue itself."""
        dissipation = self.config.dissipation
        return dissipation.kind == "none" or dissipation.number == 0.0

    @property
    def shift_mass(self) -> FloatArray | None:
        """See `gyrify.solve.problem.Problem`: the mass, unless a projection is asked for."""
        if self.config.solver.regularisation != "shift":
            return None
        if self.unknowns is None:
            return np.asarray(self._mass[self._moving])
        mass = np.zeros(self.unknowns.number.size)
        mass[self._moving] = self._mass[self._moving]
        return self.unknowns.gather_mass(mass)

    @property
    def old_steps(self) -> int:
        """See `gyrify.solve.problem.Problem`: without dissipation they might end on a saddle.

        Without a factor there is none to use again.
        """
        return 0 if self.is_conservative or self.linear_solver == "cg" else STEPS

    @property
    def may_jump(self) -> bool:
        """See `gyrify.solve.problem.Problem`: without dissipation tissue snaps from state to state."""
        return self.is_conservative

    @property
    def is_path_kept(self) -> bool:
        """See `gyrify.solve.problem.Problem`: a bifurcation is to be seen, and nothing unfolds it."""
        stability = self.config.stability
        return self.is_conservative and stability.detect and (stability.follow_branch or self.is_perfect)

    @property
    def is_perfect(self) -> bool:
        """Whether no imperfection pushes to either side of a bifurcation that breaks the symmetry."""
        return self.config.mesh.node_jitter == 0.0 or self.unknowns is not None

    @property
    def barrier_stiffness(self) -> float:
        """Stiffness of the contact barrier [Pa]."""
        chosen = self.config.contact.barrier_stiffness
        return AUTO_BARRIER * self.config.material.young_modulus if chosen == "auto" else float(chosen)

    def reference_state(self) -> State:
        """The undeformed state, with its internal variables."""
        return State.reference(*self.state_shape, self.internal_at_start())

    def internal_at_start(self) -> dict[str, FloatArray]:
        """Internal variables of the reference state, by name."""
        return {variable.name: variable.at_start(self) for variable in INTERNAL}

    def evolved(self, before: State, after: State) -> State:
        """See `gyrify.solve.problem.Problem`."""
        if not INTERNAL:
            return after
        return replace(after, internal={v.name: v.after(self, before, after) for v in INTERNAL})

    def compile(self) -> None:
        """Compile the kernels, or load them from their cache, so that no increment has to wait for it."""
        start = self.reference_state()
        total = self.energy(1.0, start, 0.0)
        total.evaluate(start.u, project_psd=True)
        total.max_step(start.u, start.u)
        self.simplices.volume_ratio(start.u)

    def tissue_energy(
        self, fraction: float, start_u: FloatArray, internal: Mapping[str, FloatArray] | None = None
    ) -> TotalEnergy:
        """Energy of the body without dissipation, for an increment that starts at a displacement.

        Internal variables are those of the reference state unless they are given.
        """
        own = self.internal_at_start() if internal is None else internal
        step = GrowthStep(self, start_u, fraction, fraction, own)
        return TotalEnergy([term for _, term in terms_of(step, CONSERVATIVE)])

    def tangent(self, fraction: float, u: FloatArray, start_u: FloatArray, system: System) -> Tangent:
        """Exact stiffness of a state, dissipation left out."""
        evaluations = self.tissue_energy(fraction, start_u).evaluate(u, project_psd=False)
        return Tangent(evaluations, system, self.free_mass, lambda: self.candidates(u))

    def is_stable(self, fraction: float, u: FloatArray) -> bool:
        """Whether the energy without dissipation has a positive definite Hessian at a state."""
        return self.tangent(fraction, u, u, self.system(np.empty((0, 2), dtype=np.int64))).is_stable

    def contact_energy(self, u: FloatArray) -> ContactEnergy:
        """Contact barrier for an increment that starts at a state u."""
        spacing = self._spacing(u)
        return ContactEnergy(self.surface, self._activation(spacing), self.barrier_stiffness, 0.25 * spacing)

    def contacts(self, u: FloatArray) -> list[ContactEnergy | PlaneContact]:
        """Every barrier of contact for an increment that starts at a state u."""
        own = self.contact_energy(u)
        return [own, self.plane_contact(u)] if self.mesh.on_plane.size else [own]

    def plane_contact(self, u: FloatArray) -> PlaneContact:
        """Barrier before a plane of symmetry, half as far as that before an image as far behind it."""
        facing = self.facing
        d_hat = 0.5 * min(self._activation(self._spacing(u)), float(facing.gap.min(initial=np.inf)))
        return PlaneContact(facing, d_hat, self.barrier_stiffness)

    def _activation(self, spacing: float) -> float:
        """Distance at which contact sets in [mm]."""
        contact, T = self.config.contact, self.config.geometry.cortical_thickness
        return min(contact.activation_fraction * T, 0.5 * spacing)

    def energy(self, fraction: float, start: State, start_fraction: float) -> TotalEnergy:
        """See `gyrify.solve.problem.Problem`."""
        step = GrowthStep(self, start.u, start_fraction, fraction, start.internal)
        return TotalEnergy([term for _, term in terms_of(step)])

    def system(self, couplings: IntArray) -> System:
        """See `gyrify.solve.problem.Problem`."""
        return self._system(self.supported, couplings, None)

    def increment_system(self, couplings: IntArray) -> System:
        """See `gyrify.solve.problem.Problem`."""
        return self._system(self._moving, couplings, self.unknowns)

    def _system(self, moving: IntArray, couplings: IntArray, unknowns: Unknowns | None) -> System:
        pattern = self.pattern.pattern if self.patches is None else self.patches.pattern
        n_dofs = int(np.prod(self.state_shape))
        nodes = Nodes.of(moving, rigid_modes(self.mesh.points)) if self.linear_solver == "cg" else None
        solver = linear_solver(self.linear_solver, nodes)
        return System(moving, n_dofs, self.mesh.n_dim, pattern, solver, couplings, unknowns)

    def candidates(self, u: FloatArray) -> IntArray:
        """Point pairs of the contour that contact may couple before long."""
        reach = REACH if self.mesh.n_dim == 2 else REACH_IN_SPACE
        return self.surface.couplings(u, reach * self._spacing(u))

    def _spacing(self, u: FloatArray) -> float:
        """Shortest edge of the contour (height of a triangle in space), but of none that collapsed [mm]."""
        return max(self.surface.spacing(u), COLLAPSED * self.surface.spacing(np.zeros_like(u)))

    def is_path_admissible(self, u: FloatArray, u_end: FloatArray) -> bool:
        """See `gyrify.solve.problem.Problem`; in space folds slide along each other, on no straight path.

        There each step of a descent is free of collisions, and states are checked: no two places meet where
        cells are positive inside a boundary that crosses itself nowhere (Ball 1981).
        """
        if self.mesh.n_dim == 3 or not self.config.contact.enabled:
            return True
        return self.surface.is_path_collision_free(u, u_end)
