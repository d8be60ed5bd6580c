"""What a mode of instability moves on a surface in space."""

from __future__ import annotations

from typing import Final

import numpy as np

from gyrify.mesh import Mesh
from gyrify.metrics.surface import FloatArray, IntArray, face_areas, laplacian, vertex_areas, vertex_normals

# Share of the squared normal displacement from which a mode is uniform.
_UNIFORM: Final = 0.5


def surface_wave(mesh: Mesh, u: FloatArray, mode: FloatArray) -> tuple[int, float]:
    """Number and length of the wave of a mode.

    Parameters
    ----------
    mesh : Mesh
        The reference mesh, in space.
    u : (n_points, 3) float array
        State [mm].
    mode : (n_points, 3) float array
        Displacement from there, in any unit.

    Returns
    -------
    mode_number : int
        Degree l of the spherical harmonics that vary as fast, l (l + 1) = (2 pi R / wavelength)^2 with the
        radius R of the sphere of the same area; of a patch, waves along its period in x. 0 if it is uniform.
    wavelength : float
        2 pi rms(w) / rms(grad w) of the normal displacement w [mm]; 0 for a uniform mode.
    """
    height, corners, faces = _height(mesh, u, mode)
    areas = vertex_areas(height.size, faces, corners)
    mean = areas @ height / areas.sum()
    varied = height - mean
    if areas.sum() * mean**2 > _UNIFORM * (areas @ height**2):
        return 0, 0.0
    slope = varied @ (laplacian(height.size, faces, corners) @ varied)
    wavelength = float(2.0 * np.pi * np.sqrt(areas @ varied**2 / slope))
    if mesh.period is not None:
        return max(round(mesh.period / wavelength), 1), wavelength
    area = float(face_areas(corners).sum()) * (2.0 if mesh.on_plane.size else 1.0)  # of both halves
    square = area * np.pi / wavelength**2  # (2 pi R / wavelength)^2
    return max(round(np.sqrt(square + 0.25) - 0.5), 1), wavelength


def outwards_in_space(mesh: Mesh, u: FloatArray, mode: FloatArray) -> FloatArray:
    """A mode with the sign by which its largest normal displacement points outwards."""
    height, _, _ = _height(mesh, u, mode)
    # Among peaks that are equal but for rounding, the first one decides.
    peak = int(np.argmax(np.abs(height) > (1.0 - 1e-6) * np.abs(height).max()))
    return mode if height[peak] >= 0.0 else -mode


def normal_displacement(mesh: Mesh, u: FloatArray, mode: FloatArray) -> FloatArray:
    """(n_contour,) displacement of a mode along the outward normals of the surface."""
    return _height(mesh, u, mode)[0]


def _height(mesh: Mesh, u: FloatArray, mode: FloatArray) -> tuple[FloatArray, FloatArray, IntArray]:
    """Normal displacement of the surface's points; corners and points of its triangles."""
    faces = np.searchsorted(mesh.contour, mesh.faces)
    corners = mesh.unwrapped(mesh.faces) + u[mesh.faces]
    normals = vertex_normals(mesh.contour.size, faces, corners)
    return np.asarray(np.einsum("ni,ni->n", mode[mesh.contour], normals)), corners, faces
