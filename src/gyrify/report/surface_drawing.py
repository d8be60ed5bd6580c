"""A body in space as it is drawn on paper: seen from far away, lit, near parts over far ones; or cut."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from gyrify.mesh import GREY, Mesh
from gyrify.mesh.boundary import straight_cells
from gyrify.metrics.surface import vertex_normals
from gyrify.report.layout import COLOURS

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
# Corners of polygons, and the colour of each.
Painted = tuple[list[FloatArray], FloatArray]

# Name of a view, and the axes of the body that point to the right, up, and to the reader.
VIEWS: Final = {
    "from the side": ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0)),
    "from above": ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    "from the front": ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)),
}
# Light over the left shoulder of the reader; what it does not reach is not black.
_LIGHT: Final = np.array([-0.45, 0.55, 0.70]) / np.linalg.norm([-0.45, 0.55, 0.70])
_AMBIENT: Final = 0.32
# The same on a field, whose colours are to be told.
_AMBIENT_ON_FIELDS: Final = 0.62
# How much darker the bottom of the deepest sulcus is.
_SHADE: Final = 0.55


def section_caption(place: float, width: float) -> str:
    """Caption of a section across x at a place [mm], to a thousandth of the body's width [mm]."""
    step = 10.0 ** np.floor(np.log10(1e-3 * width))
    shown = round(place / step) * step
    return f"section at x = {shown + 0.0:.3g} mm".replace("-", "−")


@dataclass(frozen=True, eq=False)
class DrawnBody:
    """A state of a body in space.

    Attributes
    ----------
    mesh : Mesh
        The reference mesh.
    points : (n_points, 3) float array
        Deformed positions [mm].
    depth : (n_contour,) float array, optional
        Depth of the points of the outer surface below its closing [mm]: sulci are drawn darker.
    """

    mesh: Mesh
    points: FloatArray
    depth: FloatArray | None = None

    @cached_property
    def corners(self) -> FloatArray:
        """(n, 3, 3) corners of the outer surface, counter-clockwise seen from outside [mm]."""
        return self.mesh.unwrapped(self.mesh.faces) + (self.points - self.mesh.points)[self.mesh.faces]

    @cached_property
    def faces(self) -> IntArray:
        """(n, 3) places of the corners in the list of points of the outer surface."""
        return np.searchsorted(self.mesh.contour, self.mesh.faces)

    @cached_property
    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Corners of the box around it [mm]."""
        flat = self.corners.reshape(-1, 3)
        low, high = flat.min(axis=0), flat.max(axis=0)
        if self.mesh.period is not None:
            low[2] = min(float(self.points[:, 2].min()), float(low[2]))
        return low, high

    @cached_property
    def _normals(self) -> FloatArray:
        """(n, 3) unit normals that light falls on, smooth over the surface."""
        smooth = vertex_normals(self.mesh.contour.size, self.faces, self.corners)[self.faces].sum(axis=1)
        return np.asarray(smooth / np.linalg.norm(smooth, axis=1, keepdims=True))

    @cached_property
    def _shade(self) -> FloatArray:
        """(n,) depth of the triangles in sulci, from 0 to 1."""
        if self.depth is None:
            return np.zeros(len(self.faces))
        low, high = self.bounds
        # a dent of less than a hundredth of the body casts no shadow
        deepest = max(float(self.depth.max()), 0.01 * float((high - low).max()))
        return np.asarray(self.depth[self.faces].mean(axis=1) / deepest)

    def surface(self, view: str, colours: FloatArray | None = None) -> Painted:
        """Triangles of the surface that face the reader, far ones first.

        Parameters
        ----------
        view : str
            One of `VIEWS`.
        colours : (n, 3) float array, optional
            Red, green and blue of every triangle, from 0 to 1; that of tissue by default, darker in sulci.
        """
        turn = np.array(VIEWS[view]).T
        seen, normals = self.corners @ turn, self._normals @ turn
        facing = np.flatnonzero(np.cross(seen[:, 1] - seen[:, 0], seen[:, 2] - seen[:, 0])[:, 2] > 0.0)
        order = facing[np.argsort(seen[facing, :, 2].mean(axis=1), kind="stable")]
        light = np.clip(normals[order] @ _LIGHT, 0.0, 1.0)[:, None]
        if colours is None:
            bright = 0.5 * (np.array(to_rgb(COLOURS["white"])) + np.array(to_rgb(COLOURS["grey"])))
            light = (_AMBIENT + (1.0 - _AMBIENT) * light) * (1.0 - _SHADE * self._shade[order, None])
            painted = np.clip(light * (0.12 + 0.98 * bright), 0.0, 1.0)
        else:
            painted = (_AMBIENT_ON_FIELDS + (1.0 - _AMBIENT_ON_FIELDS) * light) * colours[order]
        return list(seen[order][:, :, :2]), painted

    def section(self, place: float, colours: FloatArray | None = None, axis: int = 0) -> Painted:
        """Polygons in which a plane normal to an axis cuts the cells.

        Parameters
        ----------
        place : float
            Position of the plane along the axis [mm].
        colours : (n_cells, 3) float array, optional
            Colour of every cell; that of its tissue by default.
        axis : int
            0, 1 or 2.
        """
        polygons, cell = cut_cells(*self._apart, axis, place)
        if colours is None:
            tissues = np.array([to_rgb(COLOURS["white"]), to_rgb(COLOURS["grey"])])
            colours = tissues[(self.mesh.region == GREY).astype(np.int64)]
        return polygons, colours[cell // (len(straight_cells(self.mesh)) // self.mesh.n_cells)]

    @cached_property
    def _apart(self) -> tuple[FloatArray, IntArray]:
        """Points and cells; across a period, cells with corners of their own, next to each other."""
        if self.mesh.period is None:
            return self.points, straight_cells(self.mesh)
        cells = straight_cells(self.mesh)
        corners = self.mesh.unwrapped(cells) + (self.points - self.mesh.points)[cells]
        return corners.reshape(-1, 3), np.arange(cells.size).reshape(cells.shape)


def paint(axes: Axes, painted: Painted) -> PolyCollection:
    """Draw polygons, each in its colour; edges of the same colour close the gaps between them."""
    polygons, colours = painted
    drawn = PolyCollection(polygons, facecolors=colours, edgecolors=colours, linewidths=0.2)
    drawn.set_rasterized(True)
    axes.add_collection(drawn, autolim=False)
    return drawn


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
