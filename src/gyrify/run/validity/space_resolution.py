"""What a mesh in space resolves of the wave that exact theory expects."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from gyrify.config.body_sections import FROM_FILES
from gyrify.run.validity.expected import expected_onset
from gyrify.run.validity.ranges import contour_spacing

if TYPE_CHECKING:
    from gyrify.config import Config

# Edges on a wave below which the onset on a mesh is late by more than some 5 %, as measured on balls and
# patches (docs/space.md).
EDGES_PER_WAVE: Final = {"linear": 30.0, "mean_dilatation": 18.0, "quadratic": 4.0}


def resolution_in_space(config: Config) -> list[str]:
    """Warn of a surface whose triangles are large beside the expected wave."""
    expected, edge = expected_onset(config), contour_spacing(config)
    needed, element = EDGES_PER_WAVE[config.mesh.element], config.mesh.element
    if expected.wavelength_mm is None or expected.wavelength_mm >= needed * edge:
        return []
    length = expected.wavelength_mm
    other = ""
    if element != "quadratic":
        other = f' or mesh.element = "quadratic" with {_rounded(length / EDGES_PER_WAVE["quadratic"])}'
    finer = f"mesh.edge_length = {_rounded(length / needed)}{other}"
    if config.geometry.shape in FROM_FILES:
        finer = f"mesh.refine = {config.mesh.refine + 1}"
    return [
        f"The mesh is coarse beside the folds: exact theory ({expected.theory}) expects a wave of "
        f"{length:.3g} mm, which {length / edge:.2g} edges of {edge:.3g} mm make up ({needed:g} are needed "
        f"for an onset that is late by some 5 %): folds come late, and wider. Set {finer}."
    ]


def _rounded(length: float) -> str:
    return f"{float(f'{0.995 * length:.2g}'):g}"
