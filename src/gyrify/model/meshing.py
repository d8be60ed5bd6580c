"""From a configuration to its mesh."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from gyrify.config import Config
from gyrify.config.body_sections import FROM_FILES
from gyrify.config.space_checks import edge_length
from gyrify.errors import ConfigError, MeshError
from gyrify.mesh import Mesh
from gyrify.mesh.layered import layered_mesh
from gyrify.mesh.layered_grid import Layers
from gyrify.mesh.quality import SliverError
from gyrify.mesh.shapes import SolidShape, SurfaceBody, VolumeBody, shape_of
from gyrify.mesh.shelled import ShellLayers, shell_mesh
from gyrify.mesh.surface_mesh import jittered
from gyrify.model.kept_mesh import mesh_inside

_FEWEST_COLUMNS, _MOST_COLUMNS = 24, 4096
_MOST_LAYERS: Final = 64
_MANY_LAYERS: Final = (24, 32, 48, 64)
# Cells that are built at most to find a piece of advice: a second or two.
_MOST_CELLS: Final = 1_500_000


def build_mesh(config: Config, like: Config | None = None) -> Mesh:
    """Mesh of a configuration.

    Parameters
    ----------
    config : Config
        The body.
    like : Config, optional
        In space, what the surfaces are divided for instead: the same but for the thickness of the cortex, so
        that the states of both have the same unknowns. In the plane they have them anyway.

    Raises
    ------
    MeshError
        If the geometry cannot be meshed well; the advice names numbers with which it can.
    """
    try:
        return _built(config, like or config)
    except SliverError as fault:
        if config.geometry.n_dim == 3:
            raise
        raise SliverError(fault.message, _advice(config, fault.advice)) from None


def _built(config: Config, like: Config) -> Mesh:
    mesh = config.mesh
    if config.geometry.shape in FROM_FILES:
        return jittered(mesh_inside(config), mesh.node_jitter, config.seed)
    shape = shape_of(config.geometry)
    assert not isinstance(shape, SurfaceBody | VolumeBody)
    if isinstance(shape, SolidShape):
        other = shape_of(like.geometry)
        assert isinstance(other, SolidShape)
        return shell_mesh(shape, _shell_layers(like), other)
    layers = Layers(
        n_around=mesh.n_around,
        n_layers=mesh.n_layers,
        n_cortex_layers=mesh.n_cortex_layers,
        grading=mesh.grading,
        split=mesh.split,
        node_jitter=mesh.node_jitter,
        seed=config.seed,
        element=mesh.element,
        refine=mesh.refine,
        refine_cortex=mesh.refine_cortex,
    )
    return layered_mesh(shape, layers)


def _shell_layers(config: Config) -> ShellLayers:
    mesh = config.mesh
    return ShellLayers(
        edge_length=edge_length(config),
        n_layers=mesh.n_layers,
        n_cortex_layers=mesh.n_cortex_layers,
        grading=mesh.grading,
        node_jitter=mesh.node_jitter,
        seed=config.seed,
        refine=mesh.refine,
        refine_cortex=mesh.refine_cortex,
        element=mesh.element,
    )


def _advice(config: Config, direction: str) -> str:
    """What to change: the nearest numbers of columns and layers of which a mesh was built well."""
    mesh, up = config.mesh, not direction.startswith("Lower")
    # Even numbers suit the alternating split; 4 divides those of a mesh that is its own mirror image.
    unit, ends = 4 if mesh.split == "symmetric" else 2, (_FEWEST_COLUMNS, _MOST_COLUMNS)
    tries = {
        "mesh.n_around": _steps(mesh.n_around, 1.1 if up else 1 / 1.1, unit, ends),
        "mesh.n_layers": _steps(mesh.n_layers, 1.06, 1, (3, _MOST_LAYERS)),
        "mesh.n_cortex_layers": range(mesh.n_cortex_layers - 1, 1, -1),
    }
    found = [
        f"{key} = {changes[key]}"
        for key, values in tries.items()
        if (changes := _first(config, ({key: value} for value in values)))
    ]
    if found:
        return f"Try {' or '.join(found)}."
    both = _first(
        config,
        (
            {"mesh.n_around": columns, "mesh.n_layers": layers}
            for layers in _MANY_LAYERS
            for columns in _steps(mesh.n_around, 1.5 if up else 1 / 1.5, unit, ends)
        ),
    )
    if both:
        return f"Try {' with '.join(f'{key} = {value}' for key, value in both.items())}."
    return "Try a thicker cortex, or a smaller shape: no number of columns and layers was found to be enough."


def _steps(start: int, ratio: float, unit: int, bounds: tuple[int, int]) -> list[int]:
    """Multiples of a unit ever farther from a number, in steps of a ratio or of one unit."""
    found: list[int] = []
    value, sign = float(start), 1 if ratio > 1.0 else -1
    while True:
        value = unit * round(max(sign * value * ratio, sign * value + unit) * sign / unit)
        if not bounds[0] <= value <= bounds[1]:
            return found
        found.append(int(value))


def _first(config: Config, tries: Iterable[dict[str, int]]) -> dict[str, int]:
    """The first changes of which a mesh is built well, until too many cells were built; none are empty."""
    spent = 0
    for changes in tries:
        spent += _n_cells(config, changes)
        if spent > _MOST_CELLS:
            break
        try:
            # Corners lie where those of linear cells do, and these are quickly made.
            tried = config.with_overrides({**changes, "mesh.element": "linear"})
            _built(tried, tried)
        except (ConfigError, MeshError):
            continue
        return changes
    return {}


def _n_cells(config: Config, changes: dict[str, int]) -> int:
    """About how many cells a mesh has."""
    mesh = config.mesh
    columns = changes.get("mesh.n_around", mesh.n_around)
    layers = changes.get("mesh.n_layers", mesh.n_layers)
    return int(2 * columns * layers * 4 ** (mesh.refine + mesh.refine_cortex))
