"""Conditions on what lies in space, and on what has a meaning there or in the plane alone."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from gyrify.config.body_sections import FROM_FILES, PERIODIC
from gyrify.config.inputs.named_files import FILE_KEYS
from gyrify.config.words import show

if TYPE_CHECKING:
    from gyrify.config.settings import Config

_SMALLEST_HOLE: Final = 0.1
# Edge on an outer surface over T, where none is given.
EDGE: Final = 1.5


def edge_length(config: Config) -> float:
    """Edge on the outer surface of a body in space, before refinement [mm]."""
    if config.geometry.shape in FROM_FILES:
        return config.geometry.surface.mean_edge
    return config.mesh.edge_length or EDGE * config.geometry.cortical_thickness


def finer(config: Config) -> str:
    """What makes the mesh of a body finer along its surface, as advice."""
    if config.geometry.n_dim == 2:
        return "raise mesh.n_around"
    further = f"set mesh.refine = {config.mesh.refine + 1}"
    return further if config.geometry.shape in FROM_FILES else f"lower mesh.edge_length, or {further}"


def n_cells(config: Config) -> float:
    """About how many tetrahedra a body in space has at most: three to a prism."""
    geometry, mesh = config.geometry, config.mesh
    if geometry.shape == "volume":
        return float(geometry.volume.cells.shape[0]) * 8.0**mesh.refine
    if geometry.shape in FROM_FILES:  # about as many white cells as two layers have
        layers = mesh.n_cortex_layers + 2
        n_triangles = int(geometry.surface.triangles.shape[0])
        return 3.0 * n_triangles * layers * 8.0 ** (mesh.refine + mesh.refine_cortex)
    if geometry.shape == "patch":
        area = geometry.length * geometry.width
    else:
        area = 4.0 * math.pi * geometry.mean_radius**2
    faces = area / (math.sqrt(3.0) / 4.0 * edge_length(config) ** 2)
    return 3.0 * faces * mesh.n_layers * 8.0 ** (mesh.refine + mesh.refine_cortex)


def hole(config: Config) -> str:
    """A hole in the plane has a size; in space there may be none."""
    geometry = config.geometry
    if geometry.shape in (*PERIODIC, *FROM_FILES) or geometry.hole_fraction >= _SMALLEST_HOLE:
        return ""
    if geometry.n_dim == 3 and geometry.hole_fraction == 0.0:
        return ""
    other = " or 0, a solid body" if geometry.n_dim == 3 else ""
    return (
        f"geometry.hole_fraction = {geometry.hole_fraction!r} is not allowed with geometry.shape = "
        f'"{geometry.shape}": it must be from 0.1 to 0.9{other}. Try 0.1.'
    )


def meaning(config: Config) -> str:
    """What has no meaning for a body must be as it is by default."""
    mesh, growth = config.mesh, config.growth
    given: dict[str, tuple[object, object]] = {"mesh.edge_length": (mesh.edge_length, 0.0)}
    where = "in the plane, where mesh.n_around counts"
    if config.geometry.n_dim == 3:
        where = "in space"
        given = {
            "mesh.split": (mesh.split, "alternating"),
            "growth.out_of_plane": (growth.out_of_plane, "blocked"),
            "growth.out_of_plane_exponent": (growth.out_of_plane_exponent, 1.0),
        }
    for key, (value, default) in given.items():
        if value != default:
            return (
                f"{key} = {show(value)} is not allowed {where}: it has no meaning there. "
                f"Try {key} = {show(default)}, the default."
            )
    return ""


def built(config: Config) -> str:
    """What is built in the plane alone is refused in space."""
    if config.geometry.n_dim == 2:
        return ""
    if config.mesh.inversion_resistance > 0.0:
        return (
            f"mesh.inversion_resistance = {config.mesh.inversion_resistance:g} is not allowed in space: "
            "it is built for triangles alone. Try mesh.inversion_resistance = 0."
        )
    return ""


def solver(config: Config) -> str:
    """Conjugate gradients are for bodies in space."""
    if config.geometry.n_dim == 3 or config.solver.linear_solver != "cg":
        return ""
    return (
        'solver.linear_solver = "cg" is not allowed in the plane, where a factor takes little memory and '
        'time. Try solver.linear_solver = "auto", the default.'
    )


def transition(config: Config) -> str:
    """A width belongs to a sigmoid profile."""
    growth = config.growth
    if growth.profile == "sigmoid" or growth.transition == 0.0:
        return ""
    return (
        f'growth.transition = {growth.transition:g} is not allowed with growth.profile = "sharp": a step has '
        'no width. Try growth.profile = "sigmoid", or growth.transition = 0.'
    )


def clamp(config: Config) -> str:
    """Periodic bodies are held below, and volumes alone end in a plane of symmetry."""
    if config.boundary.clamp == "plane":
        return _plane(config)
    if config.boundary.plane != type(config.boundary)().plane:
        return (
            f'boundary.plane is not allowed with boundary.clamp = "{config.boundary.clamp}", which does not '
            'use it. Try boundary.clamp = "plane".'
        )
    if config.boundary.clamp == "hole" or config.geometry.shape not in PERIODIC:
        return ""
    return (
        f'boundary.clamp = "{config.boundary.clamp}" is not allowed with geometry.shape = '
        f'"{config.geometry.shape}": its lower side stands for tissue that goes on. '
        'Try boundary.clamp = "hole".'
    )


def _plane(config: Config) -> str:
    if config.geometry.shape != "volume":
        return (
            f'boundary.clamp = "plane" is not allowed with geometry.shape = "{config.geometry.shape}": half '
            'a body is given as tetrahedra that end in the plane. Try geometry.shape = "volume", or the '
            'whole body with boundary.clamp = "none".'
        )
    normal = config.boundary.plane.normal
    if sorted(abs(x) for x in normal) == [0.0, 0.0, 1.0]:
        return ""
    return (
        f"boundary.plane.normal = {show(normal)} is not allowed: it must be a unit vector along an axis. Try "
        "[0, 1, 0], or turn the body."
    )


def files(config: Config) -> str:
    """Bodies from files alone have files, and their cells are those of the files."""
    geometry, cut = config.geometry, config.mesh
    if geometry.shape in FROM_FILES:
        if cut.element == "quadratic":
            return (
                f'mesh.element = "quadratic" is not allowed with geometry.shape = "{geometry.shape}": such '
                'cells are built in layers alone. Try mesh.element = "mean_dilatation".'
            )
        if cut.edge_length:
            return (
                f"mesh.edge_length = {cut.edge_length:g} is not allowed with geometry.shape = "
                f'"{geometry.shape}": the triangles are those of the file, with edges of '
                f"{geometry.surface.mean_edge:.3g} mm. Try mesh.edge_length = 0, and mesh.refine to halve "
                "them."
            )
        return _of_volume(config) or _parts(config)
    defaults = type(geometry)()
    for key in (*FILE_KEYS, "unit", "labels", "digest"):
        if getattr(geometry, key) != getattr(defaults, key):
            return (
                f"geometry.{key} = {show(getattr(geometry, key))} is not allowed with geometry.shape = "
                f'"{geometry.shape}", which has no files. Try geometry.shape = '
                f'"{"volume" if key == "labels" else "surface"}".'
            )
    return ""


def _of_volume(config: Config) -> str:
    """What a volume has none of, and a surface has alone."""
    geometry = config.geometry
    if geometry.shape == "surface":
        if geometry.labels == type(geometry)().labels:
            return ""
        return (
            'geometry.labels is not allowed with geometry.shape = "surface": triangles have no tissue. Try '
            'geometry.shape = "volume".'
        )
    for key in ("hole_file", "interface_file"):
        if getattr(geometry, key):
            return (
                f'geometry.{key} is not allowed with geometry.shape = "volume": what its tetrahedra leave '
                "empty inside is the hole, and geometry.labels tell the tissues. Leave it out."
            )
    if config.mesh.refine_cortex:
        return (
            f"mesh.refine_cortex = {config.mesh.refine_cortex} is not allowed with geometry.shape = "
            '"volume": its tetrahedra are refined together. Try mesh.refine.'
        )
    return ""


def _parts(config: Config) -> str:
    """Nothing but drag holds parts that hang together nowhere."""
    n, dissipation = config.geometry.surface.n_parts, config.dissipation
    is_held = dissipation.kind == "drag" and dissipation.number > 0.0
    if n == 1 or (is_held and not config.stability.detect):
        return ""
    return (
        f"geometry.file has {n} closed surfaces, and nothing but drag holds one beside the other. Try "
        'dissipation.kind = "drag" with dissipation.number = 0.2, and stability.detect = false.'
    )


CHECKS: Final = (files, hole, meaning, built, solver, transition, clamp)
