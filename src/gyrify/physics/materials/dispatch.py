"""Calls of a material from compiled code: which one is a constant there, so that the choice costs nothing.

Kernels capture the place of their material in the list as a whole number, and numba, which compiles a kernel
for each such number, finds the material's own functions here; put in line, they keep the loops over points
fast. (A captured function would be compiled anew in every process: numba's cache knows it from no other.)
"""

from __future__ import annotations

from typing import Any

from gyrify.base.compiled import overload
from gyrify.physics.materials import MATERIALS

# numba compiles what follows without annotations.
# mypy: disable-error-code="no-untyped-def"


def density(material, x, y, z, p, c):
    """W [Pa] of the material at a place of the list; arguments as its own function has."""
    return MATERIALS[material].density(x, y, z, p, c)


def derivatives(material, x, y, z, p, c):
    """Its derivatives [Pa], likewise."""
    return MATERIALS[material].derivatives(x, y, z, p, c)


@overload(density, prefer_literal=True, inline="always")
def _density(material, x, y, z, p, c) -> Any:  # noqa: ARG001
    chosen = MATERIALS[material.literal_value].density

    def implementation(material, x, y, z, p, c):  # noqa: ARG001
        return chosen(x, y, z, p, c)

    return implementation


@overload(derivatives, prefer_literal=True, inline="always")
def _derivatives(material, x, y, z, p, c) -> Any:  # noqa: ARG001
    chosen = MATERIALS[material.literal_value].derivatives

    def implementation(material, x, y, z, p, c):  # noqa: ARG001
        return chosen(x, y, z, p, c)

    return implementation
