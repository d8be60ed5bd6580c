"""Shape quality of cells, and the refusal of slivers."""

from __future__ import annotations

from typing import Final

import numpy as np

from gyrify.errors import MeshError
from gyrify.mesh.mesh import FloatArray, Mesh

LOWEST_QUALITY: Final = 0.02


class SliverError(MeshError):
    """A mesh with cells that are far too thin; another division of the same shape has none."""


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


def tetrahedron_quality(corners: FloatArray) -> FloatArray:
    """Mean-ratio quality 12 (3 V)^(2/3) / sum of squared edges: 1 regular, 0 flat, negative inverted.

    Parameters
    ----------
    corners : (n_cells, 4, 3) float array
        Corner coordinates [mm].

    Returns
    -------
    (n_cells,) float array
    """
    volume = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6.0
    squares = sum(
        np.square(corners[:, i] - corners[:, j]).sum(axis=1) for i in range(4) for j in range(i + 1, 4)
    )
    return np.asarray(12.0 * np.sign(volume) * np.abs(3.0 * volume) ** (2.0 / 3.0) / squares)


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
    SliverError
        If the worst quality is below `LOWEST_QUALITY`.
    """
    worst = float(triangle_quality(mesh.cell_points[:, :3]).min())
    if worst >= LOWEST_QUALITY:
        return
    is_wide = column / layers.min() >= layers.max() / column
    fit, layer = ("wide", layers.min()) if is_wide else ("narrow", layers.max())
    raise SliverError(
        f"The mesh has cells of quality {worst:.2g} (1 is equilateral, {LOWEST_QUALITY:g} is needed). "
        f"Columns {column:.3g} mm wide are too {fit} for layers of {layer:.3g} mm.",
        "Raise mesh.n_around, or lower mesh.n_cortex_layers."
        if is_wide
        else "Lower mesh.n_around, or raise mesh.n_layers.",
    )
