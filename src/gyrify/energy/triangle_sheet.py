"""An outer surface in space as the triangles that contact works on; a periodic one with its images around.

The images are the surface one period to either side, along both periods and across: eight of them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gyrify.base.tiling import tiled
from gyrify.energy.term import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class TriangleSheet:
    """Vertices, edges and faces of a surface for contact.

    Attributes
    ----------
    vertices : (n_vertices,) int array
        Position among the surface's points of each vertex; those of the surface itself come first.
    offset : (n_vertices, 3) float array
        Constant distance from the surface's point to the vertex [mm]: zero, or some periods.
    edges : (n_edges, 2) int array
        Vertices of each edge.
    faces : (n_faces, 3) int array
        Vertices of each triangle.
    """

    vertices: IntArray
    offset: FloatArray
    edges: IntArray
    faces: IntArray

    @staticmethod
    def of(points: FloatArray, faces: IntArray, periods: tuple[float, float] | None) -> TriangleSheet:
        """Sheet of a surface.

        Parameters
        ----------
        points : (n, 3) float array
            Reference coordinates of the surface's points [mm].
        faces : (n_faces, 3) int array
            Triangles, by position among these points.
        periods : (float, float) or None
            Periods in x and y [mm].
        """
        own = np.arange(points.shape[0])
        if periods is None:
            return TriangleSheet(own, np.zeros(points.shape), _edges(faces), faces)
        source, turns, triangles = tiled(points, faces, periods)
        offset = np.zeros((source.size, 3))
        offset[:, :2] = turns * np.array(periods)
        return TriangleSheet(source, offset, _edges(triangles), triangles)


def smallest_height(corners: FloatArray) -> float:
    """Smallest height of triangles with (n, 3, 3) corners [mm]."""
    sides = np.roll(corners, -1, axis=1) - corners
    areas = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    return float((areas / np.linalg.norm(sides, axis=2).max(axis=1)).min())


def _edges(faces: IntArray) -> IntArray:
    ends = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    return np.asarray(np.unique(np.sort(ends, axis=1), axis=0))
