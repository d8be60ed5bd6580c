"""Shape quality of cells, and the refusal of slivers."""

from __future__ import annotations

from typing import Final

import numpy as np

from gyrify.errors import MeshError
from gyrify.mesh.mesh import FloatArray, Mesh

LOWEST_QUALITY: Final = 0.02


def triangle_quality(corners: FloatArray) -> FloatArray:
    """Mean-ratio quality 4 sqrt(3) area / sum of squared edges: 1 equilateral, 0 flat, negative inverted.

    Parameters
    ----------
    corners : (n_cells, 3, 2) float array
        Corner coordinates [mm].

    Returns
    -------
    (n_cells,) float array
    """
    edges = np.roll(corners, -1, axis=1) - corners
    double_area = edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0]
    return np.asarray(2.0 * np.sqrt(3.0) * double_area / np.square(edges).sum(axis=(1, 2)))


def require_quality(mesh: Mesh, column: float, layers: FloatArray) -> None:
    """Refuse a mesh with inverted cells or slivers, and say what to change.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    column : float
        Width of a column of cells at the contour [mm].
    layers : (n_layers,) float array
        Thickness of the layers [mm].

    Raises
    ------
    MeshError
        If the worst quality is below `LOWEST_QUALITY`.
    """
    worst = float(triangle_quality(mesh.cell_points[:, :3]).min())
    if worst >= LOWEST_QUALITY:
        return
    if column / layers.min() >= layers.max() / column:
        reason = (
            f"Columns {column:.3g} mm wide are too wide for layers of {layers.min():.3g} mm: raise "
            "mesh.n_around or geometry.cortical_thickness, or lower mesh.n_layers or mesh.n_cortex_layers."
        )
    else:
        reason = (
            f"Columns {column:.3g} mm wide are too narrow for layers of {layers.max():.3g} mm: lower "
            "mesh.n_around, or raise mesh.n_layers."
        )
    raise MeshError(
        f"mesh.n_around = {mesh.contour.size} gives cells of quality {worst:.3g} (1 is equilateral; at least "
        f"{LOWEST_QUALITY:g} is needed).",
        reason,
    )
