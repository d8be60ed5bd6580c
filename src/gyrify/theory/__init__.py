"""Exact onset of folding, independent of the two-dimensional code and a reference to verify it against."""

from gyrify.theory.annulus import Annulus, BaseState, base_state
from gyrify.theory.bilayer import INCOMPRESSIBLE, Bilayer
from gyrify.theory.half_space import (
    Wrinkle,
    asymptotic_wrinkle,
    critical_surface,
    critical_wrinkle,
    neutral_curve,
)
from gyrify.theory.margin import Margin, stability_margin
from gyrify.theory.mode_numbers import Mode, SecondVariation, lowest_eigenvalue, surface_limit
from gyrify.theory.onset import (
    Crossing,
    Crossings,
    critical_growth_ratio,
    critical_growth_time,
    crossings,
    stability_map,
)
from gyrify.theory.sphere import Sphere, SphereState, sphere_state
from gyrify.theory.spherical_modes import SphericalVariation

__all__ = [
    "INCOMPRESSIBLE",
    "Annulus",
    "BaseState",
    "Bilayer",
    "Crossing",
    "Crossings",
    "Margin",
    "Mode",
    "SecondVariation",
    "Sphere",
    "SphereState",
    "SphericalVariation",
    "Wrinkle",
    "asymptotic_wrinkle",
    "base_state",
    "critical_growth_ratio",
    "critical_growth_time",
    "critical_surface",
    "critical_wrinkle",
    "crossings",
    "lowest_eigenvalue",
    "neutral_curve",
    "sphere_state",
    "stability_map",
    "stability_margin",
    "surface_limit",
]
