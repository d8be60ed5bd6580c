"""Layered grid of triangles in parameters, before it is bent to a ring or laid out as a strip.

A point has a depth, 0 (clamped) to 1 (interface) to 2 (contour), and a position along the layers, 0 to 1
and round again. Layers and columns can be halved everywhere, or in the cortex alone: then the white layers
under the interface halve the columns one after the other, so that the mesh stays conforming.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from gyrify.errors import MeshError
from gyrify.mesh.grading import Grading, layer_fractions
from gyrify.mesh.mesh import GREY, WHITE, FloatArray, IntArray
from gyrify.mesh.symmetry import Mirror, row_image, symmetric_field, with_middles

Split = Literal["alternating", "one", "random", "symmetric"]
Element = Literal["linear", "quadratic", "mean_dilatation"]


@dataclass(frozen=True)
class Layers:
    """How a grid is divided.

    Attributes
    ----------
    n_around, n_layers, n_cortex_layers : int
        Quadrilaterals along, across, and across the cortex, before refinement.
    grading : {"geometric", "uniform"}
        Thickness of the white layers.
    split : {"alternating", "one", "random", "symmetric"}
        Which diagonal splits each quadrilateral; ``symmetric`` alternates, and the mesh is its own mirror
        image.
    node_jitter : float
        Largest random shift of a point over its local layer; mirrored where the split is symmetric.
    seed : int
        Seed of jitter and random split.
    element : {"linear", "quadratic", "mean_dilatation"}
        Quadratic triangles get a node on each edge.
    refine, refine_cortex : int
        Times all layers and columns, and then those of the cortex alone, are halved.
    """

    n_around: int
    n_layers: int
    n_cortex_layers: int
    grading: Grading = "geometric"
    split: Split = "alternating"
    node_jitter: float = 0.0
    seed: int = 0
    element: Element = "linear"
    refine: int = 0
    refine_cortex: int = 0


@dataclass(frozen=True, eq=False)
class LayeredGrid:
    """Triangles in parameters.

    Attributes
    ----------
    depth, along : (n_points,) float arrays
        Parameters of the points, row by row from the clamped side.
    cells : (n_cells, 3) int array
        Triangles, positive where ``along`` runs counter-clockwise and depth outwards.
    region : (n_cells,) int8 array
        Tissue.
    patch : (n_cells,) int array
        Quadrilateral that each triangle is a part of.
    rows : tuple of int arrays
        Points of each row.
    interface_row : int
        Which row is the interface.
    images : tuple of int arrays
        Of a symmetric grid, the image (n_points,) of each point: about the position 0, and a quarter.
    """

    depth: FloatArray
    along: FloatArray
    cells: IntArray
    region: NDArray[np.int8]
    patch: IntArray
    rows: tuple[IntArray, ...]
    interface_row: int
    images: tuple[IntArray, ...] = ()


def build_grid(
    layers: Layers, cortical_share: float, unit: tuple[float, float], width: float, n_mirrors: int = 1
) -> LayeredGrid:
    """Divide a wall.

    Parameters
    ----------
    layers : Layers
        How.
    cortical_share : float
        Cortical thickness over the thickness of the white wall; sets the geometric grading.
    unit : (float, float)
        Thickness of the white wall and of the cortex [mm]: what a depth of 1 means.
    width : float
        Length of the grid [mm]: what a position of 1 means.
    n_mirrors : {1, 2}
        Lines of symmetry where the split is symmetric: through the position 0, or there and at a quarter.

    Returns
    -------
    LayeredGrid

    Raises
    ------
    MeshError
        If there are fewer white layers than times the cortex is refined, or the columns cannot be symmetric.
    """
    rng = np.random.default_rng(layers.seed)
    lines, columns, interface_row = _rows(layers, cortical_share)
    starts = np.concatenate([[0], np.cumsum(columns)])
    rows = tuple(np.arange(starts[i], starts[i + 1]) for i in range(columns.size))
    depth = np.repeat(lines, columns)
    along = np.concatenate([np.arange(n) / n for n in columns])
    noise = layers.node_jitter * rng.uniform(-1.0, 1.0, size=(2, depth.size))
    images = _images(rows, n_mirrors) if layers.split == "symmetric" else ()
    if images:
        # along the layers a mirror turns the shift round
        noise = symmetric_field([Mirror(1, image) for image in images], noise.T).T
    thickness, inwards = _local_thickness(lines, unit, interface_row)
    sideways = np.minimum(thickness, width / columns) / width
    depth, along = (
        depth + np.repeat(inwards, columns) * noise[0],
        along + np.repeat(sideways, columns) * noise[1],
    )
    parts = [_band(rows[i], rows[i + 1], i, layers.split, rng) for i in range(len(rows) - 1)]
    layer = np.repeat(np.arange(len(parts)), [len(part) for part in parts])
    region = np.where(layer >= interface_row, GREY, WHITE).astype(np.int8)
    quads = [np.repeat(np.arange(n), len(part) // n) for part, n in zip(parts, columns[:-1], strict=True)]
    offsets = np.concatenate([[0], np.cumsum(columns[:-1])])
    patch = np.concatenate([offset + quad for offset, quad in zip(offsets, quads, strict=False)])
    grid = LayeredGrid(depth, along, np.concatenate(parts), region, patch, rows, interface_row, images)
    return add_midside_nodes(grid) if layers.element == "quadratic" else grid


def add_midside_nodes(grid: LayeredGrid) -> LayeredGrid:
    """Quadratic triangles: a node in the middle of each edge, in the order of VTK (01, 12, 20).

    Middles are taken in the parameters, so that edges follow the curved layers. Rows keep to the lines of
    the corners, and hold the nodes between them too.
    """
    ends = np.stack([grid.cells, np.roll(grid.cells, -1, axis=1)], axis=2)
    edges, edge_of_cell = np.unique(np.sort(ends.reshape(-1, 2), axis=1), axis=0, return_inverse=True)
    first, second = edges.T
    step = grid.along[second] - grid.along[first]
    step -= np.round(step)
    # from the end that comes first, so that a middle on the seam lies after the last column
    start = grid.along[np.where(step >= 0.0, first, second)]
    middle = grid.depth.size + edge_of_cell.reshape(-1, 3)
    node_of_edge = {(int(a), int(b)): grid.depth.size + i for i, (a, b) in enumerate(edges)}
    rows = tuple(_interleaved(row, node_of_edge) for row in grid.rows)
    return LayeredGrid(
        depth=np.concatenate([grid.depth, 0.5 * (grid.depth[first] + grid.depth[second])]),
        along=np.concatenate([grid.along, start + 0.5 * np.abs(step)]),
        cells=np.concatenate([grid.cells, middle], axis=1),
        region=grid.region,
        patch=grid.patch,
        rows=rows,
        interface_row=grid.interface_row,
        images=tuple(with_middles(image, edges) for image in grid.images),
    )


def _images(rows: tuple[IntArray, ...], n_mirrors: int) -> tuple[IntArray, ...]:
    """Image of each point about the position 0, and about a quarter."""
    n = min(row.size for row in rows)
    if n % (2 * n_mirrors):
        raise MeshError(
            f'mesh.split = "symmetric" needs a number of columns that {2 * n_mirrors} divides, and there are '
            f"{n}.",
            f"Try mesh.n_around = {n // (2 * n_mirrors) * (2 * n_mirrors)}.",
        )
    return tuple(
        np.concatenate([row_image(row, half_turn) for row in rows]) for half_turn in (False, True)[:n_mirrors]
    )


def _interleaved(row: IntArray, node_of_edge: dict[tuple[int, int], int]) -> IntArray:
    """Corner, middle, corner, middle, ... along a closed row."""
    ends = np.sort(np.stack([row, np.roll(row, -1)], axis=1), axis=1)
    middles = np.array([node_of_edge[int(a), int(b)] for a, b in ends])
    return np.stack([row, middles], axis=1).ravel()


def _rows(layers: Layers, cortical_share: float) -> tuple[FloatArray, IntArray, int]:
    """Depth and number of points of every row, and which row is the interface."""
    n_cortex = layers.n_cortex_layers
    n_white = layers.n_layers - n_cortex
    white = layer_fractions(n_white, cortical_share / n_cortex, layers.grading)
    cortex = 1.0 + np.linspace(0.0, 1.0, n_cortex + 1)
    for _ in range(layers.refine):
        white, cortex = _halved(white), _halved(cortex)
    for _ in range(layers.refine_cortex):
        cortex = _halved(cortex)
    _require_transitions(white.size - 1, layers.refine_cortex)
    n_around = layers.n_around * 2**layers.refine
    columns = np.full(white.size + cortex.size - 1, n_around)
    columns[white.size - 1 :] = n_around * 2**layers.refine_cortex
    for level in range(1, layers.refine_cortex):
        columns[white.size - 1 - level] = n_around * 2 ** (layers.refine_cortex - level)
    return np.concatenate([white, cortex[1:]]), columns, white.size - 1


def _require_transitions(n_white: int, refine_cortex: int) -> None:
    """Each halving of the cortex takes one white layer, in which the columns double."""
    if n_white < refine_cortex:
        raise MeshError(
            f"mesh.refine_cortex = {refine_cortex} needs as many white layers, and there are {n_white}.",
            "Raise mesh.n_layers or mesh.refine, or lower mesh.refine_cortex or mesh.n_cortex_layers.",
        )


def _halved(lines: FloatArray) -> FloatArray:
    return np.sort(np.concatenate([lines, 0.5 * (lines[1:] + lines[:-1])]))


def _local_thickness(
    lines: FloatArray, unit: tuple[float, float], interface_row: int
) -> tuple[FloatArray, FloatArray]:
    """Thinner of the layers beside each line [mm], and how far a point may leave the line [depth]."""
    scale = np.where(np.arange(lines.size - 1) < interface_row, unit[0], unit[1])
    steps = np.diff(lines) * scale
    thickness = np.minimum(np.concatenate([steps[:1], steps]), np.concatenate([steps, steps[-1:]]))
    inwards = thickness / np.concatenate([scale, scale[-1:]])
    inwards[[0, interface_row, -1]] = 0.0
    return thickness, inwards


def _band(inner: IntArray, outer: IntArray, row: int, split: Split, rng: np.random.Generator) -> IntArray:
    """(n, 3) triangles between two rows, of which the outer one may have twice the points."""
    next_inner = np.roll(inner, -1)
    if outer.size == 2 * inner.size:
        left, middle, right = outer[::2], outer[1::2], np.roll(outer[::2], -1)
        corners = [(inner, left, middle), (inner, middle, next_inner), (middle, right, next_inner)]
        return np.stack([np.stack(corner, axis=1) for corner in corners], axis=1).reshape(-1, 3)
    next_outer = np.roll(outer, -1)
    if split in ("alternating", "symmetric"):
        falling = (row + np.arange(inner.size)) % 2 == 0
    elif split == "one":
        falling = np.zeros(inner.size, dtype=bool)
    else:
        falling = rng.random(inner.size) < 0.5
    first = np.where(
        falling[:, None],
        np.stack([inner, outer, next_inner], axis=1),
        np.stack([inner, outer, next_outer], axis=1),
    )
    second = np.where(
        falling[:, None],
        np.stack([outer, next_outer, next_inner], axis=1),
        np.stack([inner, next_outer, next_inner], axis=1),
    )
    return np.stack([first, second], axis=1).reshape(-1, 3)
