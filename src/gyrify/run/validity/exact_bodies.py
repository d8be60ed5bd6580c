"""The body of exact theory that stands for a configuration, or what theory does not have."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gyrify.config.body_sections import FROM_FILES
from gyrify.errors import ConfigError

if TYPE_CHECKING:
    from gyrify.config import Config
    from gyrify.theory import Annulus, Bilayer, Sphere

# Degree of the elements across the wall: onset to 1e-4, in a seventh of the time that round-off takes.
DEGREE: Final = 4
# Ratio of growth from which white matter counts as not growing.
_STILL: Final = 1e3
# Smallest over largest radius from which a surface from a file counts as a sphere.
_ROUND: Final = 0.95


def require_covered(config: Config) -> None:
    """Refuse by name what no exact theory has.

    Raises
    ------
    ConfigError
        If there is any of it.
    """
    if config.material.law != "neo_hookean":
        raise ConfigError(
            f'the theory has no material.law = "{config.material.law}".',
            'Set material.law = "neo_hookean" to compare with it.',
        )
    if config.growth.profile != "sharp":
        raise ConfigError(
            f'the theory has no growth.profile = "{config.growth.profile}".',
            'Set growth.profile = "sharp" to compare with it.',
        )
    if config.boundary.clamp != "hole" and config.geometry.n_dim == 2:
        raise ConfigError(
            f'the theory has no boundary.clamp = "{config.boundary.clamp}".',
            'Set boundary.clamp = "hole" to compare with it.',
        )


def round_body(config: Config) -> Annulus | Sphere:
    """Annulus of a body in the plane, sphere of one in space: see `annulus_of` and `sphere_of`."""
    return annulus_of(config) if config.geometry.n_dim == 2 else sphere_of(config)


def sphere_of(config: Config) -> Sphere:
    """Sphere of the same volume, hole, tissue and growth.

    Raises
    ------
    ConfigError
        If it has no white matter, or something that the theory does not have.
    """
    from gyrify.theory import Sphere

    shared, geometry = _shared(config), config.geometry
    is_read = geometry.shape in FROM_FILES
    if is_read and (geometry.hole_surface is not None or geometry.surface.roundness < _ROUND):
        raise ConfigError(
            "the theory is that of a sphere, and the surface of geometry.file has another shape.",
            'Compare with geometry.shape = "sphere" of the same volume.',
        )
    if config.material.poisson_ratio != config.material.poisson_ratio_white:
        raise ConfigError(
            "the theory of a sphere has one Poisson ratio.",
            "Leave material.poisson_ratio_white out to compare with it.",
        )
    return Sphere(**shared, hole="clamped" if config.boundary.clamp == "hole" else "free")


def annulus_of(config: Config) -> Annulus:
    """Circle of the same area, hole, tissue and growth.

    Raises
    ------
    ConfigError
        If it has no white matter, or something that the theory does not have.
    """
    from gyrify.theory import Annulus

    growth = config.growth
    return Annulus(
        **_shared(config),
        poisson_ratio_white=config.material.poisson_ratio_white,
        out_of_plane=growth.out_of_plane,
        out_of_plane_exponent=growth.out_of_plane_exponent,
    )


def _shared(config: Config) -> dict[str, Any]:
    """What an annulus and a sphere have in common.

    Raises
    ------
    ConfigError
        If the configuration has something that the theory does not have.
    """
    require_covered(config)
    geometry, material, growth = config.geometry, config.material, config.growth
    return {
        "inner_radius": geometry.hole_share * geometry.mean_radius,
        "outer_radius": geometry.mean_radius,
        "cortical_thickness": geometry.cortical_thickness,
        "young_modulus": material.young_modulus,
        "stiffness_ratio": material.stiffness_ratio,
        "poisson_ratio": material.poisson_ratio,
        "growth_rate": growth.rate,
        "growth_ratio": growth.ratio,
        "duration": growth.duration,
        "stretch": growth.stretch,
        "energy_per": growth.energy_per,
        "law": "tangential" if growth.is_tangential else "isotropic",
        "degree": DEGREE,
    }


_LOADINGS: Final = {
    (False, "blocked"): "isotropic",
    (False, "none"): "plane",
    (True, "blocked"): "tangential",
    (True, "none"): "uniaxial",
}


def bilayer_of(config: Config) -> Bilayer | str:
    """Film on a half-space of the same tissue and growth, or why there is none."""
    from gyrify.theory import Bilayer

    require_covered(config)
    growth, material = config.growth, config.material
    still = growth.ratio >= _STILL
    if growth.out_of_plane == "generalised":
        return 'The theory of a strip has no growth.out_of_plane = "generalised".'
    if growth.out_of_plane == "blocked" and growth.out_of_plane_exponent != 1.0:
        return "The theory of a strip has no growth.out_of_plane_exponent other than 1."
    if growth.stretch == "exponential" and not still:
        return 'The theory of a strip has no growth.stretch = "exponential" while white matter grows too.'
    if growth.is_tangential and not still:
        return 'The theory of a strip has no growth.law = "tangential" while white matter grows too.'
    return Bilayer(
        stiffness_ratio=material.stiffness_ratio,
        poisson_ratio=material.poisson_ratio,
        poisson_ratio_substrate=material.poisson_ratio_white,
        loading=_LOADINGS[growth.is_tangential, growth.out_of_plane],  # type: ignore[arg-type]
        growth_ratio=np.inf if still else growth.ratio,
        energy_per=growth.energy_per,
    )
