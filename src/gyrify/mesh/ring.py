"""Mapped elliptic ring: the paper's brain slice, grey on the outside, white inside, a hole in the middle."""

from __future__ import annotations

import numpy as np

from gyrify.errors import MeshError
from gyrify.mesh.layered_grid import Layers, Sheet, build_sheet
from gyrify.mesh.mesh import FloatArray, Mesh
from gyrify.mesh.quality import require_quality
from gyrify.mesh.symmetry import Mirror, symmetric_field


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
    sheet = build_sheet(layers, T / white, (white, T), 2.0 * np.pi * radius, n_mirrors=2)
    mirrors = tuple(Mirror(axis, image) for axis, image in zip((1, 0), sheet.images, strict=False))
    points = _bend(sheet, semi_axes, hole_fraction, T)
    mesh = Mesh(
        points=symmetric_field(mirrors, points) if mirrors else points,
        cells=sheet.cells,
        region=sheet.region,
        contour=sheet.rows[-1],
        interface=sheet.rows[sheet.interface_row],
        clamped=sheet.rows[0],
        across=_normals(sheet, semi_axes, hole_fraction, T),
        patch=sheet.patch,
        mirrors=mirrors,
        along=sheet.along,
        depth=sheet.depth,
    )
    lines = np.unique(sheet.depth[[row[0] for row in sheet.rows]])
    thickness = np.diff(np.minimum(lines, 1.0) * white + np.maximum(lines - 1.0, 0.0) * T)
    require_quality(mesh, 2.0 * np.pi * radius / sheet.rows[-1].size, thickness)
    return mesh


def _bend(sheet: Sheet, semi_axes: tuple[float, float], hole_fraction: float, T: float) -> FloatArray:
    """(n_points, 2) points; the position along the sheet becomes an eccentric angle."""
    angle = 2.0 * np.pi * sheet.along
    along_a, along_b = _ellipse(sheet.depth, semi_axes, hole_fraction, T)
    return np.stack([along_a * np.cos(angle), along_b * np.sin(angle)], axis=1)


def _ellipse(
    depth: FloatArray, semi_axes: tuple[float, float], hole_fraction: float, T: float
) -> tuple[FloatArray, FloatArray]:
    """Semi-axes [mm] of the ellipse at a depth: 0 is the hole, 1 the interface, 2 the contour."""
    white, grey = np.minimum(depth, 1.0), np.maximum(depth - 1.0, 0.0)
    a, b = (h + white * (axis - T - h) + grey * T for axis in semi_axes for h in [hole_fraction * axis])
    return a, b


def _normals(sheet: Sheet, semi_axes: tuple[float, float], hole_fraction: float, T: float) -> FloatArray:
    """(n_cells, 2) unit outward normals of the ellipses through the middles of the cells."""
    corners = sheet.cells[:, :3]
    along = sheet.along[corners]
    along = along[:, :1] + (along - along[:, :1] - np.round(along - along[:, :1]))
    angle = 2.0 * np.pi * along.mean(axis=1)
    along_a, along_b = _ellipse(sheet.depth[corners].mean(axis=1), semi_axes, hole_fraction, T)
    normal = np.stack([np.cos(angle) / along_a, np.sin(angle) / along_b], axis=1)
    return np.asarray(normal / np.linalg.norm(normal, axis=1, keepdims=True))
