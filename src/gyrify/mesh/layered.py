"""The mesh of a shape: a layered grid of triangles, bent to it."""

from __future__ import annotations

from typing import Final

import numpy as np

from gyrify.mesh.layered_grid import LayeredGrid, Layers, build_grid
from gyrify.mesh.mesh import FloatArray, Mesh
from gyrify.mesh.quality import require_quality
from gyrify.mesh.shapes import Shape

# The grid's layers run counter-clockwise, with the outside on the right; along a strip it is on the left.
_MIRRORED: Final = {3: [0, 2, 1], 6: [0, 2, 1, 5, 4, 3]}


def layered_mesh(shape: Shape, layers: Layers) -> Mesh:
    """Mesh a shape in layers from the clamped side to the contour.

    Parameters
    ----------
    shape : Shape
        The body.
    layers : Layers
        How its wall is divided. Jitter slides points of the contour, the interface and the clamped side along
        their line, so that these lines stay exact. An odd ``n_around`` breaks the alternating split at the
        seam.

    Returns
    -------
    Mesh

    Raises
    ------
    MeshError
        If a cell would be a sliver, or the shape has no mirrors that the split asks for.
    """
    white, T = shape.wall
    grid = build_grid(layers, T / white, (white, T), shape.length, n_mirrors=shape.n_mirrors)
    points = shape.points(grid.along, grid.depth)
    points, mirrors = shape.mirrored(points, grid.images) if grid.images else (points, ())
    order = slice(None) if shape.is_closed else _MIRRORED[grid.cells.shape[1]]
    mesh = Mesh(
        points=points,
        cells=np.ascontiguousarray(grid.cells[:, order]),
        region=grid.region,
        contour=grid.rows[-1],
        interface=grid.rows[grid.interface_row],
        clamped=grid.rows[0],
        across=shape.normals(*_middles(grid)),
        patch=grid.patch,
        is_closed=shape.is_closed,
        period=shape.period,
        mirrors=mirrors,
        along=grid.along,
        depth=grid.depth,
    )
    # One point of each row: jitter puts the others a little above or below it.
    lines = np.unique(grid.depth[[row[0] for row in grid.rows]])
    thickness = np.diff(np.minimum(lines, 1.0) * white + np.maximum(lines - 1.0, 0.0) * T)
    require_quality(mesh, shape.length / grid.rows[-1].size, thickness)
    return mesh


def _middles(grid: LayeredGrid) -> tuple[FloatArray, FloatArray]:
    """(n_cells,) position and depth of the middles of the cells."""
    corners = grid.cells[:, :3]
    along = grid.along[corners]
    along = along[:, :1] + (along - along[:, :1] - np.round(along - along[:, :1]))
    return along.mean(axis=1), grid.depth[corners].mean(axis=1)
