"""What a mesh in space resolves of the wave that exact theory expects."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from gyrify.run.validity.expected import expected_onset
from gyrify.run.validity.ranges import contour_spacing

if TYPE_CHECKING:
    from gyrify.config import Config

# Edges on a wave below which the onset on a mesh is late by more than a few per cent.
EDGES_PER_WAVE: Final = 6.0


def resolution_in_space(config: Config) -> list[str]:
    """Warn of a surface whose triangles are large beside the expected wave."""
    expected, edge = expected_onset(config), contour_spacing(config)
    if expected.wavelength_mm is None or expected.wavelength_mm >= EDGES_PER_WAVE * edge:
        return []
    return [
        f"The mesh is coarse beside the folds: exact theory ({expected.theory}) expects a wave of "
        f"{expected.wavelength_mm:.3g} mm, which {expected.wavelength_mm / edge:.2g} edges of {edge:.3g} mm "
        f"make up ({EDGES_PER_WAVE:g} are needed): folds come late, and wider. Set mesh.edge_length = "
        f"{_rounded(expected.wavelength_mm / EDGES_PER_WAVE)}, or mesh.refine = {config.mesh.refine + 1}."
    ]


def _rounded(length: float) -> str:
    return f"{float(f'{length:.2g}'):g}"
