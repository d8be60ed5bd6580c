"""Shape quality of cells, and the refusal of slivers."""

from __future__ import annotations

from typing import Final

import numpy as np

from gyrify.errors import MeshError
from gyrify.mesh.mesh import FloatArray, Mesh

LOWEST_QUALITY: Final = 0.02
THIN_LAYERS: Final = (
    "Thin layers need more points around: raise mesh.n_around, lower mesh.n_layers or "
    "mesh.n_cortex_layers, or change geometry.cortical_thickness."
)


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


def require_quality(mesh: Mesh, lowest: float = LOWEST_QUALITY, advice: str = THIN_LAYERS) -> None:
    """Refuse a mesh with inverted cells or slivers; ``advice`` says what to change.

    Raises
    ------
    MeshError
        If the worst quality is below ``lowest``.
    """
    worst = float(triangle_quality(mesh.cell_points[:, :3]).min())
    if worst < lowest:
        raise MeshError(
            f"The mesh has cells of quality {worst:.3g} (1 is equilateral; at least {lowest:g} is needed).",
            advice,
        )
