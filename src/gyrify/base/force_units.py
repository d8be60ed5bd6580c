"""Units of forces and energies: per thickness of the slice in the plane."""

from __future__ import annotations


def force_unit(n_dim: int) -> str:
    """Unit of a nodal force: per thickness in the plane (2), a stress times an area in space (3)."""
    return "Pa mm" if n_dim == 2 else "Pa mm²"


def energy_unit(n_dim: int) -> str:
    """Unit of an energy, likewise."""
    return "Pa mm²" if n_dim == 2 else "Pa mm³"
