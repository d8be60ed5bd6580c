"""Surfaces of a whole body, of which the mesh may be half."""

from __future__ import annotations

import numpy as np

from gyrify.mesh.mesh import FloatArray, IntArray, Mesh
from gyrify.metrics.mirrored import with_image


def whole_surface(
    mesh: Mesh, points: FloatArray, chosen: IntArray, faces: IntArray
) -> tuple[FloatArray, IntArray]:
    """Points and triangles of one of the surfaces of a body in space, with the image of half a body.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    points : (n_points, 3) float array
        Positions of its points [mm].
    chosen : (n,) int array
        Points of the surface, in order.
    faces : (n_faces, 3) int array
        Its triangles, by points of the mesh.

    Returns
    -------
    points : (m, 3) float array
        Those chosen come first [mm].
    faces : (m_faces, 3) int array
        By position among them.
    """
    surface = points[chosen], np.searchsorted(chosen, faces)
    if mesh.on_plane.size == 0:
        return surface
    axis = int(np.argmin(np.ptp(mesh.points[mesh.on_plane], axis=0)))
    rim = np.flatnonzero(np.isin(chosen, mesh.on_plane))
    return with_image(*surface, rim, axis, float(points[mesh.on_plane, axis].mean()))
