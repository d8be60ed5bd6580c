"""Elements that are too stiff where tissue hardly changes its volume."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from gyrify.config import Config

# Poisson ratio from which linear triangles lose about a tenth of the gyrification index to locking, and more
# above, on the mesh of the standard slice (docs/validity.md has the measurement).
LOCKING_POISSON_RATIO: Final = 0.47


def locking(config: Config) -> list[str]:
    """Warn of linear triangles in nearly incompressible tissue."""
    material = config.material
    highest = max(material.poisson_ratio, material.poisson_ratio_white)
    if config.mesh.element != "linear" or highest < LOCKING_POISSON_RATIO:
        return []
    can_average = config.growth.out_of_plane != "generalised"
    advice = 'mesh.element = "quadratic"'
    if config.geometry.n_dim == 2:
        advice += " and mesh.inversion_resistance = 0.1"
    if can_average:
        advice = f'mesh.element = "mean_dilatation", or {advice}'
    key = "poisson_ratio" if material.poisson_ratio == highest else "poisson_ratio_white"
    return [
        f'mesh.element = "linear" locks at material.{key} = {highest:g}: linear triangles that hardly change '
        "their volume can hardly bend, and folds come out too shallow (from 0.47 on, the gyrification index "
        f"is about a tenth too low or more on the mesh of the standard slice). Set {advice}."
    ]
