"""A surface in space as it is drawn on paper: seen from far away, lit, near parts over far ones."""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from gyrify.mesh import GREY
from gyrify.report.layout import COLOURS

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# Name of a view, and the axes of the body that point to the right, up, and to the reader.
VIEWS: Final = {
    "from the side": ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0)),
    "from above": ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    "from the front": ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)),
}
# Light over the left shoulder of the reader; what it does not reach is not black.
_LIGHT: Final = np.array([-0.45, 0.55, 0.70]) / np.linalg.norm([-0.45, 0.55, 0.70])
_AMBIENT: Final = 0.32
# How much darker the bottom of the deepest sulcus is.
_SHADE: Final = 0.55


def draw_surface(
    axes: Axes,
    corners: FloatArray,
    normals: FloatArray,
    axes_of_view: tuple[tuple[float, float, float], ...],
    depth: FloatArray | None = None,
) -> None:
    """Draw the triangles of a surface that face the reader.

    Parameters
    ----------
    axes : Axes
        Where to, in mm.
    corners : (n, 3, 3) float array
        Corners, counter-clockwise seen from outside [mm].
    normals : (n, 3) float array
        Unit normals that light falls on.
    axes_of_view : tuple
        Of `VIEWS`.
    depth : (n,) float array, optional
        Depth of the triangles in sulci, from 0 to 1; the deeper the darker.
    """
    turn = np.array(axes_of_view).T
    seen, normals = corners @ turn, normals @ turn
    facing = np.flatnonzero(np.cross(seen[:, 1] - seen[:, 0], seen[:, 2] - seen[:, 0])[:, 2] > 0.0)
    order = facing[np.argsort(seen[facing, :, 2].mean(axis=1), kind="stable")]
    light = _AMBIENT + (1.0 - _AMBIENT) * np.clip(normals[order] @ _LIGHT, 0.0, 1.0)
    if depth is not None:
        light = light * (1.0 - _SHADE * depth[order])
    bright = 0.5 * (np.array(to_rgb(COLOURS["white"])) + np.array(to_rgb(COLOURS["grey"])))
    colours = np.clip(light[:, None] * (0.12 + 0.98 * bright), 0.0, 1.0)
    # edges of the same colour close the gaps between triangles
    axes.add_collection(
        PolyCollection(seen[order][:, :, :2], facecolors=colours, edgecolors=colours, linewidths=0.2)
    )


def cut_cells(
    points: FloatArray, cells: IntArray, axis: int, place: float
) -> tuple[list[FloatArray], IntArray]:
    """Polygons in which a plane normal to an axis cuts tetrahedra, and the cell of each.

    Returns
    -------
    polygons : list of (3 or 4, 2) float arrays
        In the plane of the other two axes [mm].
    cell : (n,) int array
        Their cells.
    """
    height = points[cells][:, :, axis] - place
    above = height >= 0.0
    cut = np.flatnonzero(above.any(axis=1) & ~above.all(axis=1))
    others = [k for k in range(3) if k != axis]
    polygons = []
    for cell in cut:
        high, low = np.flatnonzero(above[cell]), np.flatnonzero(~above[cell])
        # around the polygon: neighbours share a corner of the tetrahedron
        pairs = [(i, j) for i in high for j in low]
        if len(pairs) == 4:
            pairs = [pairs[0], pairs[1], pairs[3], pairs[2]]
        x, h = points[cells[cell]][:, others], height[cell]
        polygons.append(np.array([x[i] + h[i] / (h[i] - h[j]) * (x[j] - x[i]) for i, j in pairs]))
    return polygons, cut


def draw_section(
    axes: Axes, points: FloatArray, cells: IntArray, region: NDArray[np.int8], axis: int, place: float
) -> None:
    """Draw the tissues where a plane normal to an axis cuts a body; parameters as of `cut_cells`."""
    polygons, cell = cut_cells(points, cells, axis, place)
    colours = [COLOURS["grey"] if region[k] == GREY else COLOURS["white"] for k in cell]
    axes.add_collection(PolyCollection(polygons, facecolors=colours, edgecolors=colours, linewidths=0.25))
