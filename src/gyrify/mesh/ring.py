"""Mapped elliptic ring: the paper's brain slice, grey on the outside, white inside, a hole in the middle."""

from __future__ import annotations

import numpy as np

from gyrify.errors import MeshError
from gyrify.mesh.mesh import FloatArray, Mesh
from gyrify.mesh.quality import require_quality
from gyrify.mesh.sheet import Layers, Sheet, build_sheet


def elliptic_ring(
    semi_axes: tuple[float, float], hole_fraction: float, cortical_thickness: float, layers: Layers
) -> Mesh:
    """Mesh a ring between the ellipses (h a, h b) and (a, b) with the interface on (a - T, b - T).

    Parameters
    ----------
    semi_axes : (float, float)
        Outer semi-axes a, b [mm].
    hole_fraction : float
        Semi-axes of the clamped hole over those of the contour, h.
    cortical_thickness : float
        Thickness T of the grey layer [mm].
    layers : Layers
        How the wall is divided. Jitter slides points of the contour, the interface and the hole along their
        ellipse, so that these lines stay exact.

    Returns
    -------
    Mesh

    Raises
    ------
    MeshError
        If no white matter is left, or a cell would be a sliver.
    """
    a, b = semi_axes
    T = cortical_thickness
    wall = min(a, b) * (1.0 - hole_fraction)
    if not 0.0 < T < wall:
        raise MeshError(
            f"geometry.cortical_thickness = {T:g} mm leaves no white matter: the wall is {wall:.4g} mm.",
            f"Choose a thickness between 0 and {0.95 * wall:.4g} mm.",
        )
    radius = float(np.sqrt(a * b))
    white = radius * (1.0 - hole_fraction) - T
    sheet = build_sheet(layers, T / white, (white, T), 2.0 * np.pi * radius)
    points = _bend(sheet, semi_axes, hole_fraction, T)
    mesh = Mesh(
        points=points,
        cells=sheet.cells,
        region=sheet.region,
        contour=sheet.rows[-1],
        interface=sheet.rows[sheet.interface_row],
        clamped=sheet.rows[0],
        across=_ellipse_normals(points[sheet.cells[:, :3]].mean(axis=1), semi_axes),
        patch=sheet.patch,
    )
    require_quality(mesh)
    return mesh


def _bend(sheet: Sheet, semi_axes: tuple[float, float], hole_fraction: float, T: float) -> FloatArray:
    """(n_points, 2) points; the position along the sheet becomes an eccentric angle."""
    a, b = semi_axes
    angle = 2.0 * np.pi * sheet.along
    white, grey = np.minimum(sheet.depth, 1.0), np.maximum(sheet.depth - 1.0, 0.0)
    along_a = hole_fraction * a + white * (a - T - hole_fraction * a) + grey * T
    along_b = hole_fraction * b + white * (b - T - hole_fraction * b) + grey * T
    return np.stack([along_a * np.cos(angle), along_b * np.sin(angle)], axis=1)


def _ellipse_normals(points: FloatArray, semi_axes: tuple[float, float]) -> FloatArray:
    """Unit outward normals of the ellipses, similar to the contour, through the points."""
    normal = points / np.square(semi_axes)
    return np.asarray(normal / np.linalg.norm(normal, axis=1, keepdims=True))
