"""The tissue of a configuration: mesh, growth and stiffness over space, elastic energy."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from gyrify.config import Config
from gyrify.energy.axial import AxialElasticEnergy, axial_pattern
from gyrify.energy.elastic import CellPattern, ElasticEnergy
from gyrify.energy.kinematics import ElasticKinematics, Simplices
from gyrify.energy.mean_dilatation import MeanDilatationEnergy, PatchPattern
from gyrify.energy.plane_contact import FacingPoints
from gyrify.energy.term import FloatArray, IntArray
from gyrify.errors import InvertedCellError
from gyrify.mesh import GREY, Mesh
from gyrify.mesh.shapes import SolidShape, shape_of
from gyrify.model.body import Places, growth_of, material_of, parameters_of
from gyrify.model.meshing import build_mesh
from gyrify.model.rigid import isostatic_supports, kept_modes, rigid_modes


class Tissue:
    """Growing elastic tissue, without contact or dissipation.

    Parameters
    ----------
    config : Config
        Every number of the run.
    mesh : Mesh, optional
        Mesh to use instead of the configured one.

    Raises
    ------
    InvertedCellError
        If a cell of the mesh is inverted, anywhere in it.

    Attributes
    ----------
    mesh : Mesh
        The reference mesh.
    simplices : Simplices
        Integration points of the cells; fields over space have one value for each of them.
    growth : Growth
        Growth of each integration point.
    material : Material
        Which solid.
    parameters : (n_parameters, n) float array
        Its parameters; the last one is the bulk modulus [Pa].
    """

    def __init__(self, config: Config, mesh: Mesh | None = None) -> None:
        self.config = config
        self.mesh = build_mesh(config) if mesh is None else mesh
        places = self._places()
        self.growth = growth_of(config, places)
        self.material, self.parameters = material_of(config), parameters_of(config, places)

    def _places(self) -> Places:
        """Where the integration points are."""
        cell, shape = self.simplices.cell, shape_of(self.config.geometry)
        if self.simplices.curved is not None and isinstance(shape, SolidShape):
            return Places.within(self.mesh, cell, shape)
        return Places.of(self.mesh, cell)

    @property
    def bulk_modulus(self) -> FloatArray:
        """(n,) bulk modulus [Pa]."""
        return np.asarray(self.parameters[-1])

    @property
    def has_axial_unknown(self) -> bool:
        """Whether F33 is an unknown: then the state has one row more than the mesh has points."""
        return self.config.growth.out_of_plane == "generalised"

    @property
    def state_shape(self) -> tuple[int, int]:
        """Shape of a state."""
        return self.mesh.n_points + self.has_axial_unknown, self.mesh.n_dim

    @property
    def axial_length(self) -> float:
        """Length L that makes a displacement of the axial unknown: F33 = 1 + w / L [mm]."""
        return self.config.geometry.drag_length

    @cached_property
    def simplices(self) -> Simplices:
        """Integration points and their shape-function gradients."""
        simplices = Simplices.of(self.mesh.cell_points, self.mesh.cells, self.mesh.n_points)
        cell = simplices.first_inverted(np.zeros_like(self.mesh.points))
        if cell is not None:
            middle = ", ".join(f"{x:.4g}" for x in self.mesh.cell_points[cell].mean(axis=0))
            raise InvertedCellError(
                f"Cell {cell} of the mesh, at ({middle}) mm, is inverted; it must be positive everywhere.",
                "List its corners counter-clockwise; keep nodes between them near the middles of the sides.",
            )
        return simplices

    @cached_property
    def pattern(self) -> CellPattern:
        """Sparsity of the cells."""
        if self.has_axial_unknown:
            return axial_pattern(self.simplices.cells, self.mesh.n_points)
        return CellPattern(self.simplices.cells, self.mesh.n_dim)

    @cached_property
    def patches(self) -> PatchPattern | None:
        """Cells that share a volume ratio, where the element averages it."""
        if self.config.mesh.element != "mean_dilatation":
            return None
        return PatchPattern(self.simplices.cells, self.mesh.patch, self.mesh.n_dim, self.pattern.pattern)

    @cached_property
    def lumped_area(self) -> FloatArray:
        """(n_rows,) reference area of each point [mm^2]; none for the axial unknown."""
        area = np.zeros(self.state_shape[0])
        area[: self.mesh.n_points] = self.simplices.lumped_volumes
        return area

    @property
    def is_clamped(self) -> bool:
        """Whether a hole or a lower side is held."""
        return self.mesh.clamped.size > 0 and self.config.boundary.clamp == "hole"

    @property
    def plane_axis(self) -> int:
        """Axis that a plane of symmetry lies across."""
        return int(np.argmax(np.abs(self.config.boundary.plane.normal)))

    @cached_property
    def supported(self) -> IntArray:
        """Free degrees of freedom without as many as hold the body where nothing else does.

        Held there, a body cannot move as a whole, and is not strained: in equilibrium nothing pulls at a
        support, since the forces of the tissue balance. The stiffness keeps its inertia but for the rigid
        motions, whose curvature is zero.
        """
        if self.is_clamped:
            return self.free
        modes = rigid_modes(self.mesh.points)
        if self.mesh.on_plane.size:
            modes = kept_modes(modes, self.mesh.on_plane * self.mesh.n_dim + self.plane_axis)
        return np.setdiff1d(self.free, isostatic_supports(modes), assume_unique=True)

    @cached_property
    def free(self) -> IntArray:
        """Free degrees of freedom."""
        is_free = np.ones(self.state_shape, dtype=bool)
        if self.is_clamped:
            is_free[self.mesh.clamped] = False
        if self.mesh.on_plane.size:
            is_free[self.mesh.on_plane, self.plane_axis] = False
        if self.has_axial_unknown:
            is_free[-1] = (True, False)
        return np.flatnonzero(is_free)

    @property
    def held(self) -> IntArray:
        """Degrees of freedom that nothing moves."""
        return np.setdiff1d(np.arange(int(np.prod(self.state_shape))), self.free, assume_unique=True)

    @cached_property
    def facing(self) -> FacingPoints:
        """What of the outer surface faces a plane of symmetry."""
        mesh, axis = self.mesh, self.plane_axis
        sign = float(np.sign(self.config.boundary.plane.normal[axis]))
        return FacingPoints.of(mesh.points, mesh.faces, mesh.on_plane, axis, sign)

    @cached_property
    def mean_cortical_edge(self) -> float:
        """Mean length of the edges of grey cells [mm]."""
        n_dim = self.mesh.n_dim
        corners = self.mesh.cell_points[self.mesh.region == GREY, : n_dim + 1]
        if n_dim == 3:
            i, j = np.triu_indices(4, 1)
            return float(np.linalg.norm(corners[:, i] - corners[:, j], axis=2).mean())
        return float(np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).mean())

    def kinematics(self, time: float) -> ElasticKinematics:
        """Cells in their grown state at a growth time."""
        return ElasticKinematics.of(self.simplices, self.growth.tensor(time), self.growth.out_of_plane(time))

    def volume_growth(self, time: float) -> FloatArray:
        """(n,) J_g = det F_g at a growth time, the 33 entry included."""
        return self.growth.volume(time)

    def axial_stretch(self, u: FloatArray) -> float:
        """Total out-of-plane stretch F33 of a state: 1 in plane strain."""
        return 1.0 + float(u[-1, 0]) / self.axial_length if self.has_axial_unknown else 1.0

    def volume_ratio(self, u: FloatArray) -> FloatArray:
        """(n,) J = det F of a state at the integration points, the 33 entry included."""
        return self.simplices.volume_ratio(u) * self.axial_stretch(u)

    def least_volume_ratios(self, u: FloatArray, time: float) -> tuple[FloatArray, FloatArray]:
        """(n_cells,) least J of a state over the whole of each cell, and least J_e = J / J_g at a time.

        Where J varies inside a cell both are bounds from below; see `gyrify.energy.curved`.
        """
        J = self.simplices.least_volume_ratio(u) * self.axial_stretch(u)
        return J, J / self.simplices.largest_of_cells(self.volume_growth(time))

    def volumetric_pressure(self, u: FloatArray, time: float) -> FloatArray | None:
        """(n,) kappa (mean J_e - 1) [Pa] where the element averages the volume ratio, else None."""
        if self.patches is None:
            return None
        J_g = self.volume_growth(time)
        weight = self._counted(self.simplices.volumes, J_g)
        mean = self.patches.sums(weight * self.volume_ratio(u) / J_g) / self.patches.sums(weight)
        return np.asarray(self.bulk_modulus * (mean[self.patches.patch] - 1.0))

    def elastic_energy(self, kinematics: ElasticKinematics) -> ElasticEnergy:
        """Hyperelastic energy of grown cells."""
        cells = (kinematics, self.parameters, self.weight(kinematics), self.pattern)
        if self.has_axial_unknown:
            return AxialElasticEnergy(*cells, self.axial_length, self.material)
        if self.patches is not None:
            return MeanDilatationEnergy(*cells, self.patches, self.material)
        return ElasticEnergy(*cells, self.material)

    def weight(self, kinematics: ElasticKinematics) -> FloatArray:
        """Volume that energy densities are counted by [mm^2]."""
        return self._counted(kinematics.volumes, kinematics.J_g)

    def _counted(self, volumes: FloatArray, J_g: FloatArray) -> FloatArray:
        """Grown or reference volume, as the reading wants; grown, so that det F_g is not lost."""
        return volumes * J_g if self.config.growth.energy_per == "grown" else volumes
