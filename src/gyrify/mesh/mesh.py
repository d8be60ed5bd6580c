"""The mesh: a frozen record of points, simplices and the index sets the physics needs."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gyrify.mesh.symmetry import Mirror

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

WHITE: Final = 0
GREY: Final = 1


@dataclass(frozen=True, eq=False)
class Mesh:
    """Simplices of one dimension with their tissue and boundaries.

    Attributes
    ----------
    points : (n_points, n_dim) float array
        Reference coordinates X [mm].
    cells : (n_cells, n_nodes) int array
        Point indices of each simplex, positively oriented: corners, then the nodes between them if it is
        quadratic (in the order of VTK).
    region : (n_cells,) int8 array
        `WHITE` (0) or `GREY` (1).
    contour : (n_contour,) int array
        Points of the free outer contour in order, counter-clockwise when it is closed; in space those of the
        outer surface, by their numbers.
    interface : (n_interface,) int array
        Points of the grey-white interface in the same order and direction as the contour.
    clamped : (n_clamped,) int array
        Points whose displacement is zero.
    across : (n_cells, n_dim) float array
        Unit reference direction N across the layers, pointing outwards.
    patch : (n_cells,) int array
        Quadrilateral that each cell is a part of.
    is_closed : bool
        Whether the contour is a closed loop (a ring) or runs along one period (a strip).
    period : float or None
        Length of the period in x [mm] of a strip or a patch, None for a closed body.
    period_y : float or None
        Length of the period in y [mm] of a patch.
    along : (n_points,) float array
        Position of each point along the layers, 0 to 1 and round again [-]; empty where a mesh has none.
    depth : (n_points,) float array
        Position across them: 0 on the clamped side, 1 on the interface, 2 on the contour [-]; likewise.
    mirrors : tuple of Mirror
        Lines across which the mesh is its own mirror image to the last bit, as far as it was built so.
    faces, interface_faces : (n, 3) int array
        In space, triangles of the outer surface and of the interface, counter-clockwise seen from outside.
    notes : tuple of str
        What a user should know about it, as sentences.
    on_plane : (n,) int array
        Points in a plane of symmetry.
    """

    points: FloatArray
    cells: IntArray
    region: NDArray[np.int8]
    contour: IntArray
    interface: IntArray
    clamped: IntArray
    across: FloatArray
    patch: IntArray
    is_closed: bool = True
    period: float | None = None
    mirrors: tuple[Mirror, ...] = ()
    along: FloatArray = field(default_factory=lambda: np.empty(0))
    depth: FloatArray = field(default_factory=lambda: np.empty(0))
    period_y: float | None = None
    faces: IntArray = field(default_factory=lambda: np.empty((0, 3), dtype=np.int64))
    interface_faces: IntArray = field(default_factory=lambda: np.empty((0, 3), dtype=np.int64))
    notes: tuple[str, ...] = ()
    on_plane: IntArray = field(default_factory=lambda: np.empty(0, dtype=np.int64))

    def __post_init__(self) -> None:
        for array in (
            self.points,
            self.cells,
            self.region,
            self.contour,
            self.interface,
            self.clamped,
            self.across,
            self.patch,
            self.along,
            self.depth,
            self.faces,
            self.interface_faces,
            self.on_plane,
        ):
            array.flags.writeable = False

    @property
    def n_points(self) -> int:
        """Number of points."""
        return int(self.points.shape[0])

    @property
    def n_dim(self) -> int:
        """Dimension of the space the mesh lies in."""
        return int(self.points.shape[1])

    @property
    def n_cells(self) -> int:
        """Number of cells."""
        return int(self.cells.shape[0])

    @property
    def middles(self) -> tuple[FloatArray, FloatArray]:
        """(n_cells,) position along the layers, from 0 to 1, and depth of the middles of the cells [-]."""
        nowhere, corners = np.full(self.n_cells, np.nan), self.cells[:, : self.n_dim + 1]
        if self.along.size == 0:
            return nowhere, self.depth[corners].mean(axis=1) if self.depth.size else nowhere
        along = self.along[corners]
        along = along[:, :1] + (along - along[:, :1] - np.round(along - along[:, :1]))
        return along.mean(axis=1) % 1.0, self.depth[corners].mean(axis=1)

    @property
    def triangles(self) -> IntArray:
        """(n_triangles, 3) straight triangles between all nodes: the cells, or four per quadratic one."""
        if self.cells.shape[1] == 3:
            return self.cells
        return self.cells[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]].reshape(-1, 3)

    @property
    def triangle_region(self) -> NDArray[np.int8]:
        """(n_triangles,) tissue of each of the `triangles`."""
        return np.repeat(self.region, self.triangles.shape[0] // self.n_cells)

    @property
    def cell_points(self) -> FloatArray:
        """(n_cells, n_nodes, n_dim) reference coordinates of each cell, unwrapped across the period."""
        return self.unwrapped(self.cells)

    def unwrapped(self, simplices: IntArray) -> FloatArray:
        """Reference coordinates of cells or faces, those of one next to each other.

        Parameters
        ----------
        simplices : (n, n_nodes) int array
            Points of each.

        Returns
        -------
        (n, n_nodes, n_dim) float array
            [mm].
        """
        corners = self.points[simplices]
        for axis, period in enumerate((self.period, self.period_y)):
            if period is not None:
                offset = corners[:, :, axis] - corners[:, :1, axis]
                corners[:, :, axis] -= period * np.round(offset / period)
        return corners
