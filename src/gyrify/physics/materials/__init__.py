"""Materials, once each: a file with the energy and its derivatives, and its place in this list."""

from __future__ import annotations

from typing import Final

from gyrify.physics.materials.material import Material
from gyrify.physics.materials.neo_hookean import NEO_HOOKEAN

__all__ = ["MATERIALS", "NEO_HOOKEAN", "Material", "material_named"]

# Others may be added at the end.
MATERIALS: Final[list[Material]] = [NEO_HOOKEAN]


def material_named(name: str) -> Material:
    """The material of a name.

    Raises
    ------
    KeyError
        If there is none.
    """
    for material in MATERIALS:
        if material.name == name:
            return material
    raise KeyError(name)
