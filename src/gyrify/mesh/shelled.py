"""The mesh of a shape in space: shells of tetrahedra, bent to it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gyrify.errors import MeshError
from gyrify.mesh.grading import Grading, layer_fractions
from gyrify.mesh.layered_grid import Element
from gyrify.mesh.mesh import FloatArray, IntArray, Mesh
from gyrify.mesh.midsides import with_midsides
from gyrify.mesh.nested_surface import NestedSurface
from gyrify.mesh.quality import LOWEST_QUALITY, SliverError, tetrahedron_quality
from gyrify.mesh.shapes.solid import SolidShape
from gyrify.mesh.shells import Shells, build_shells, coarsening


@dataclass(frozen=True)
class ShellLayers:
    """How a body in space is divided.

    Attributes
    ----------
    edge_length : float
        Edge on the outer surface, before refinement [mm].
    n_layers, n_cortex_layers : int
        Layers across the wall and across the cortex, before refinement.
    grading : {"geometric", "uniform"}
        Thickness of the white layers.
    node_jitter : float
        Largest random shift of a point over its local layer.
    seed : int
        Seed of the jitter.
    refine, refine_cortex : int
        Times all edges and layers, and then those of the cortex alone, are halved.
    element : {"linear", "quadratic", "mean_dilatation"}
        Quadratic cells get nodes between their corners.
    """

    edge_length: float
    n_layers: int
    n_cortex_layers: int
    grading: Grading = "geometric"
    node_jitter: float = 0.0
    seed: int = 0
    refine: int = 0
    refine_cortex: int = 0
    element: Element = "linear"


def shell_mesh(shape: SolidShape, layers: ShellLayers, like: SolidShape | None = None) -> Mesh:
    """Mesh a shape in layers, the cortex finest.

    Parameters
    ----------
    shape : SolidShape
        The body.
    layers : ShellLayers
        How its wall is divided. Jitter slides points of the outer surface, the interface and the innermost
        surface along it, so that all three stay exact.
    like : SolidShape, optional
        Body that is divided instead, to have cells between the same points: the same but for its cortex.

    Returns
    -------
    Mesh

    Raises
    ------
    MeshError
        If a cell would be a sliver.
    """
    surface = shape.surface(layers.edge_length, layers.refine + layers.refine_cortex)
    lines, heights, interface = _lines(shape, layers)
    edges = np.array([shape.edge(surface, depth) for depth in lines])
    levels = _levels(like or shape, layers, surface)
    shells = build_shells(surface, lines, levels, interface, solid=shape.is_solid)
    places, depth = _jittered(shape, shells, heights, edges, levels, layers)
    cells = _positive(shape.points(places, depth), shells.cells, shape.periods)
    shells = replace(shells, places=places, depth=depth, cells=cells)
    if layers.element == "quadratic":
        shells = with_midsides(shells, surface.between)
    points = shape.points(shells.places, shells.depth)
    outer, inner = shells.surfaces[-1], shells.surfaces[interface]
    middles = _corners(points, cells, shape.periods).mean(axis=1)
    x, y = shape.periods or (None, None)
    clamped = np.empty(0, dtype=np.int64) if shape.is_solid else np.unique(shells.surfaces[0])
    mesh = Mesh(
        points=points,
        cells=shells.cells,
        region=shells.region,
        contour=np.unique(outer),
        interface=np.unique(inner),
        clamped=clamped,
        across=shape.normals(middles, shells.depth[cells].mean(axis=1)),
        patch=shells.patch,
        is_closed=shape.periods is None,
        period=x,
        period_y=y,
        depth=shells.depth,
        faces=outer,
        interface_faces=inner,
    )
    _require_quality(mesh)
    return mesh


def _lines(shape: SolidShape, layers: ShellLayers) -> tuple[FloatArray, FloatArray, int]:
    """Depth of the surfaces, their distance from the innermost end [mm], and which is the interface."""
    white, T = shape.wall
    n_cortex = layers.n_cortex_layers * 2 ** (layers.refine + layers.refine_cortex)
    n_white = (layers.n_layers - layers.n_cortex_layers) * 2**layers.refine
    fractions = layer_fractions(n_white, T / n_cortex / white, layers.grading)
    lines = np.concatenate([fractions, 1.0 + np.arange(1, n_cortex + 1) / n_cortex])
    if shape.is_solid:
        lines = lines[1:]  # the first layer is a fan about the middle
    heights = np.minimum(lines, 1.0) * white + np.maximum(lines - 1.0, 0.0) * T
    return lines, heights, lines.size - 1 - n_cortex


def _levels(shape: SolidShape, layers: ShellLayers, surface: NestedSurface) -> tuple[int, ...]:
    """Level of each surface."""
    lines, heights, interface = _lines(shape, layers)
    edges = np.array([shape.edge(surface, depth) for depth in lines])
    return coarsening(surface.n_levels, np.diff(heights), edges, interface)


def _jittered(
    shape: SolidShape,
    shells: Shells,
    heights: FloatArray,
    edges: FloatArray,
    levels: tuple[int, ...],
    layers: ShellLayers,
) -> tuple[FloatArray, FloatArray]:
    """Parameters and depth of the points, moved a little."""
    rng, (white, T) = np.random.default_rng(layers.seed), shape.wall
    noise = layers.node_jitter * rng.uniform(-1.0, 1.0, size=(shells.depth.size, 3))
    layer = np.minimum(np.append(np.diff(heights), np.inf), np.append(np.inf, np.diff(heights)))
    sizes = np.minimum(layer, edges * 2.0 ** (max(levels) - np.array(levels)))
    first = shells.depth.size - sum(np.unique(surface).size for surface in shells.surfaces)
    counts = [np.unique(surface).size for surface in shells.surfaces]
    local = np.concatenate([np.full(first, sizes[0]), np.repeat(sizes, counts)])
    is_exact = np.zeros(heights.size, dtype=bool)
    is_exact[[0, shells.interface, -1]] = True
    if shape.is_solid:
        is_exact[0] = shells.interface == 0
    inwards = np.concatenate([np.zeros(first), np.repeat(np.where(is_exact, 0.0, layer), counts)])
    unit = np.where(shells.depth > 1.0, T, white)
    places = shape.moved(shells.places, shells.depth, local[:, None] * noise)
    return places, shells.depth + np.where(inwards > 0.0, inwards * noise[:, 2] / unit, 0.0)


def _corners(points: FloatArray, cells: IntArray, periods: tuple[float, float] | None) -> FloatArray:
    """(n_cells, 4, 3) corners, those of one cell next to each other."""
    corners = points[cells]
    if periods is not None:
        step = corners[:, :, :2] - corners[:, :1, :2]
        corners[:, :, :2] -= np.array(periods) * np.round(step / np.array(periods))
    return corners


def _positive(points: FloatArray, cells: IntArray, periods: tuple[float, float] | None) -> IntArray:
    """Cells with their last two corners exchanged where they would be inverted."""
    corners = _corners(points, cells, periods)
    inverted = np.linalg.det(corners[:, 1:] - corners[:, :1]) < 0.0
    turned = cells.copy()
    turned[inverted, 2], turned[inverted, 3] = cells[inverted, 3], cells[inverted, 2]
    return turned


def _require_quality(mesh: Mesh) -> None:
    worst = float(tetrahedron_quality(mesh.cell_points[:, :4]).min())
    if not np.isfinite(worst):
        raise MeshError("The mesh has points that are not finite numbers.", "Check the geometry.")
    if worst < LOWEST_QUALITY:
        raise SliverError(
            f"The mesh has tetrahedra of quality {worst:.2g} (1 is regular, {LOWEST_QUALITY:g} is needed).",
            "Lower mesh.edge_length, lower mesh.n_cortex_layers, or raise mesh.n_layers.",
        )
