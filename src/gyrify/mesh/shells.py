"""Tetrahedra between nested surfaces: a wall in space, or a solid body, in layers that coarsen inwards.

Between surfaces of one level lie prisms, each cut into three; where the level changes, a triangle faces four,
and the space between them is cut into seven. The faces between neighbours match by the rule that an edge
between two surfaces starts from the point with the lower number (in every other layer: the higher).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from gyrify.mesh.mesh import GREY, WHITE, FloatArray, IntArray
from gyrify.mesh.nested_surface import NestedSurface

# Corners of the tetrahedra of a prism with the bottom 012 and the top 345, numbers rising.
_PRISM: Final = np.array([[0, 1, 2, 5], [0, 1, 4, 5], [0, 3, 4, 5]])
# Under the corners 345 of four triangles with the middles 678 (of 34, 45, 53): bottom 012.
_TRANSITION: Final = np.array(
    [[0, 3, 6, 8], [1, 4, 7, 6], [2, 5, 8, 7], [0, 1, 7, 6], [0, 1, 2, 7], [0, 2, 8, 7], [0, 6, 7, 8]]
)


@dataclass(frozen=True, eq=False)
class Shells:
    """Tetrahedra in parameters, before they are bent to a shape.

    Attributes
    ----------
    places : (n_points, k) float array
        Parameters on the surface; see `NestedSurface`. Of a point in the middle they are zero.
    depth : (n_points,) float array
        0 (hole, middle or clamped side) to 1 (interface) to 2 (outer surface).
    cells : (n_cells, 4) int array
        Corners, of either orientation.
    region : (n_cells,) int8 array
        Tissue.
    patch : (n_cells,) int array
        Prism that each tetrahedron is a part of.
    surfaces : tuple of (n, 3) int arrays
        Triangles of each surface in the points of the whole, from inside.
    interface : int
        Which of them is the interface.
    """

    places: FloatArray
    depth: FloatArray
    cells: IntArray
    region: np.ndarray[tuple[int], np.dtype[np.int8]]
    patch: IntArray
    surfaces: tuple[IntArray, ...]
    interface: int


def build_shells(
    surface: NestedSurface, lines: FloatArray, levels: Sequence[int], interface: int, *, solid: bool
) -> Shells:
    """Stack surfaces.

    Parameters
    ----------
    surface : NestedSurface
        Triangles of every level.
    lines : (n,) float array
        Depth of the surfaces, from inside.
    levels : sequence of int
        Level of each of them; the next one has the same, or one more.
    interface : int
        Which of them is the interface.
    solid : bool
        Whether the first one is filled by a fan about a point in the middle, of depth 0.

    Returns
    -------
    Shells
    """
    n_points = [surface.n_points(level) for level in levels]
    starts = int(solid) + np.concatenate([[0], np.cumsum(n_points)])
    places = np.concatenate([surface.places[:n] for n in n_points])
    depth = np.repeat(lines, n_points)
    surfaces = tuple(surface.triangles[level] + start for level, start in zip(levels, starts, strict=False))
    parts, cell_lists = [], []
    if solid:
        places, depth = np.concatenate([np.zeros((1, places.shape[1])), places]), np.append(0.0, depth)
        fan = np.concatenate([np.zeros((surfaces[0].shape[0], 1), dtype=np.int64), surfaces[0]], axis=1)
        cell_lists.append(fan[:, None])
    for k in range(len(levels) - 1):
        if levels[k] == levels[k + 1]:
            cell_lists.append(prisms(surface.triangles[levels[k]], starts[k], starts[k + 1], k % 2 == 1))
        else:
            cell_lists.append(_transition(surface, levels[k], starts[k], starts[k + 1]))
    grey = len(cell_lists) - (len(levels) - 1 - interface)
    first = 0
    for cells in cell_lists:
        parts.append(first + np.repeat(np.arange(cells.shape[0]), cells.shape[1]))
        first += cells.shape[0]
    region = [
        np.full(cells.shape[0] * cells.shape[1], GREY if k >= grey else WHITE, dtype=np.int8)
        for k, cells in enumerate(cell_lists)
    ]
    return Shells(
        places=places,
        depth=depth,
        cells=np.concatenate([cells.reshape(-1, 4) for cells in cell_lists]),
        region=np.concatenate(region),
        patch=np.concatenate(parts),
        surfaces=surfaces,
        interface=interface,
    )


def coarsening(
    n_levels: int, thickness: FloatArray, edges: FloatArray, interface: int, share: float = 0.5
) -> tuple[int, ...]:
    """Level of each surface: finest from the interface outwards, coarser inwards as layers become thicker.

    Parameters
    ----------
    n_levels : int
        How many levels there are.
    thickness : (n - 1,) float array
        Thickness of the layers between the n surfaces, from inside [mm].
    edges : (n,) float array
        Mean edge of the finest level on each surface [mm].
    interface : int
        Which surface is the interface.
    share : float
        Thickness over edge from which on a layer halves the number of edges.

    Returns
    -------
    tuple of int
    """
    levels = [n_levels - 1] * edges.size
    for k in range(interface - 1, -1, -1):
        above = levels[k + 1]
        edge = edges[k + 1] * 2.0 ** (n_levels - 1 - above)
        levels[k] = max(above - 1, 0) if thickness[k] >= share * edge else above
    return tuple(levels)


def prisms(triangles: IntArray, inner: int, outer: int, falling: bool) -> IntArray:
    """Tetrahedra between two surfaces with the same triangles.

    Parameters
    ----------
    triangles : (n, 3) int array
        In numbers of points of one surface.
    inner, outer : int
        What to add for those of each.
    falling : bool
        Whether edges between the surfaces start from the higher number; in turn, they lean to both sides.

    Returns
    -------
    (n, 3, 4) int array
        Of either orientation.
    """
    ordered = np.sort(triangles, axis=1)
    if falling:
        ordered = ordered[:, ::-1]
    return np.asarray(np.concatenate([ordered + inner, ordered + outer], axis=1)[:, _PRISM])


def _transition(surface: NestedSurface, level: int, inner: int, outer: int) -> IntArray:
    """(n, 7, 4) tetrahedra between a surface and the next finer one outside it."""
    triangles = surface.triangles[level]
    corners = np.concatenate([triangles + inner, triangles + outer, surface.middles[level] + outer], axis=1)
    return np.asarray(corners[:, _TRANSITION])
