"""Conditions that tie fields to one another; each returns a sentence when it is broken."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from gyrify.config import space_checks
from gyrify.config.body_sections import FROM_FILES

if TYPE_CHECKING:
    from gyrify.config.settings import Config

MAX_WALL_SHARE: Final = 0.95
MAX_CELLS: Final = 4_000_000
FEWEST_COLUMNS: Final = 24
MAX_GROWTH: Final = 10.0


def faults(config: Config) -> list[str]:
    """Return every broken condition of a configuration, in words."""
    checks = (
        _layers,
        _white_matter,
        _cells,
        _growth,
        _increments,
        _branch,
        _axial,
        _transitions,
        _symmetry,
        *space_checks.CHECKS,
    )
    return [fault for check in checks if (fault := check(config))]


def _layers(config: Config) -> str:
    mesh = config.mesh
    if mesh.n_cortex_layers == 1 and config.geometry.n_dim == 2:
        return (
            "mesh.n_cortex_layers = 1 is not allowed in the plane: it must be at least 2, so that the layer "
            "can bend. Try mesh.n_cortex_layers = 2."
        )
    if mesh.n_cortex_layers < mesh.n_layers or config.geometry.shape in FROM_FILES:
        return ""
    return (
        f"mesh.n_cortex_layers = {mesh.n_cortex_layers} is not allowed: it must be below "
        f"mesh.n_layers = {mesh.n_layers}, which counts the white layers too. "
        f"Try at most {mesh.n_layers - 1}, or more layers."
    )


def _white_matter(config: Config) -> str:
    geometry = config.geometry
    # half a body may be cut where it is thickest
    wall = geometry.narrowest_wall * (2.0 if config.boundary.clamp == "plane" else 1.0)
    if geometry.cortical_thickness < MAX_WALL_SHARE * wall:
        return ""
    if geometry.shape in FROM_FILES:
        return (
            f"geometry.cortical_thickness = {geometry.cortical_thickness!r} is not allowed: the body of "
            f"geometry.file is {2.0 * wall:.4g} mm thick at most. Try geometry.cortical_thickness = "
            f"{_below(0.5 * wall)} or less, or another geometry.unit."
        )
    size = "geometry.semi_axes" if geometry.n_dim == 3 else "geometry.area"
    is_flat = geometry.shape in ("strip", "patch")
    remedy = "geometry.depth" if is_flat else f"{size}, or a smaller geometry.hole_fraction"
    return (
        f"geometry.cortical_thickness = {geometry.cortical_thickness!r} is not allowed: too little "
        f"white matter is left, it must be below 0.95 of the narrowest wall, "
        f"that is {MAX_WALL_SHARE * wall:.6g} [mm]. "
        f"Try geometry.cortical_thickness = {_below(0.9 * wall)} or less, or a larger {remedy}."
    )


def _cells(config: Config) -> str:
    mesh = config.mesh
    if config.geometry.n_dim == 3:
        return _cells_in_space(config)
    times = mesh.refine + mesh.refine_cortex
    column = 2 * mesh.n_layers * 4**times
    cells = column * mesh.n_around
    if cells <= MAX_CELLS:
        return ""
    fewer = MAX_CELLS // column // 2 * 2
    fits = max(
        (n for n in range(times) if column * mesh.n_around // 4 ** (times - n) <= MAX_CELLS), default=0
    )
    refine = min(mesh.refine, fits)
    advice = (
        f"Try mesh.n_around = {fewer} or less."
        if fewer >= FEWEST_COLUMNS
        else f"Try mesh.refine = {refine} and mesh.refine_cortex = {fits - refine}."
    )
    return f"mesh: up to {cells} cells are not allowed: at most {MAX_CELLS}. {advice}"


def _cells_in_space(config: Config) -> str:
    cells = space_checks.n_cells(config)
    if cells <= MAX_CELLS:
        return ""
    if config.geometry.shape in FROM_FILES:
        return (
            f"mesh: about {cells:.3g} cells are not allowed: at most {MAX_CELLS}. Try a smaller mesh.refine"
            + (
                " or a geometry.file with fewer tetrahedra."
                if config.geometry.shape == "volume"
                else ", a smaller mesh.n_cortex_layers, or a geometry.file with fewer triangles."
            )
        )
    enough = math.ceil(100.0 * space_checks.edge_length(config) * math.sqrt(cells / MAX_CELLS)) / 100.0
    return (
        f"mesh: about {cells:.3g} cells are not allowed: at most {MAX_CELLS}. "
        f"Try mesh.edge_length = {enough:g}, or fewer layers."
    )


def _growth(config: Config) -> str:
    growth = config.growth
    if growth.rate * growth.duration <= MAX_GROWTH:
        return ""
    return (
        f"growth.rate × growth.duration = {growth.rate * growth.duration:.6g} is not allowed: at most "
        f"{MAX_GROWTH:g} (the paper has 1, a doubling of length). Try growth.rate = "
        f"{_below(MAX_GROWTH, growth.duration)} or growth.duration = {_below(MAX_GROWTH, growth.rate)}."
    )


def _below(limit: float, factor: float = 1.0) -> str:
    """The largest number of three digits whose product with a factor stays within a limit."""
    value = limit / factor
    step = 10.0 ** (math.floor(math.log10(value)) - 2)
    n = math.floor(value / step * (1.0 + 1e-12))
    while n * step * factor > limit * (1.0 + 1e-15):
        n -= 1
    return f"{n * step:.3g}"


def _increments(config: Config) -> str:
    solver = config.solver
    if solver.min_increment * solver.increments <= 1.0:
        return ""
    return (
        f"solver.min_increment = {solver.min_increment!r} is not allowed: it must be at most "
        f"1/solver.increments = {1 / solver.increments:.6g}. Try 1e-06, the default."
    )


def _branch(config: Config) -> str:
    stability, dissipation = config.stability, config.dissipation
    if not stability.follow_branch:
        return ""
    is_held = dissipation.kind != "none" and dissipation.number != 0.0
    if not stability.detect:
        free = ' and dissipation.kind = "none"' if is_held else ""
        return (
            "stability.follow_branch = true is not allowed with stability.detect = false: a branch must be "
            f"found before it is followed. Try stability.detect = true{free}."
        )
    if not is_held:
        return ""
    return (
        f'stability.follow_branch = true is not allowed with dissipation.kind = "{dissipation.kind}": with '
        'dissipation, a state is not an equilibrium of the tissue alone. Try dissipation.kind = "none".'
    )


def _axial(config: Config) -> str:
    growth = config.growth
    if growth.out_of_plane == "none" and growth.out_of_plane_exponent != 1.0:
        return (
            f"growth.out_of_plane_exponent = {growth.out_of_plane_exponent:g} is not allowed with "
            'growth.out_of_plane = "none": there is no growth along z that it could change. Try '
            'growth.out_of_plane = "blocked".'
        )
    if growth.out_of_plane != "generalised":
        return ""
    if config.mesh.element == "mean_dilatation":
        return (
            'growth.out_of_plane = "generalised" is not allowed with mesh.element = "mean_dilatation". '
            'Try mesh.element = "quadratic" or "linear".'
        )
    if config.dissipation.kind == "kelvin_voigt":
        return (
            'growth.out_of_plane = "generalised" is not allowed with dissipation.kind = "kelvin_voigt": its '
            'dashpots do not act along z. Try dissipation.kind = "drag".'
        )
    return ""


def _transitions(config: Config) -> str:
    mesh = config.mesh
    white = (mesh.n_layers - mesh.n_cortex_layers) * 2**mesh.refine
    if mesh.refine_cortex <= max(white, 0) or config.geometry.shape in FROM_FILES:
        return ""
    return (
        f"mesh.refine_cortex = {mesh.refine_cortex} is not allowed: each time takes one of the {white} white "
        "layers. Try at most that number, or more layers in mesh.n_layers."
    )


def _symmetry(config: Config) -> str:
    mesh, is_strip = config.mesh, config.geometry.shape == "strip"
    if mesh.split != "symmetric":
        return ""
    parts = 2 if is_strip else 4
    columns = mesh.n_around * 2**mesh.refine
    if columns % parts:
        lines = "the middle of the strip" if is_strip else "both axes"
        below = mesh.n_around // parts * parts
        return (
            f'mesh.split = "symmetric" is not allowed with {columns} columns: {parts} must divide their '
            f"number, for a mesh that is its own mirror image about {lines}. "
            f"Try mesh.n_around = {max(below, 24)} or {below + parts}."
        )
    if config.stability.follow_branch:
        return (
            'mesh.split = "symmetric" is not allowed with stability.follow_branch = true: the branch may '
            'break the symmetry. Try mesh.split = "alternating".'
        )
    return ""
