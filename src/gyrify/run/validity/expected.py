"""What exact linear theory expects: when the smooth slice loses stability, and in what wave."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gyrify.errors import ConfigError, GyrifyError

if TYPE_CHECKING:
    from gyrify.config import Config
    from gyrify.theory import Annulus, Bilayer

# Degree of the elements across the wall: onset to 1e-4, in a seventh of the time that round-off takes.
DEGREE: Final = 4
# Growth times scanned, as parts of the duration; a slice may be unstable between two of them only.
_SCAN: Final = (0.0, 0.15, 0.3, 0.45, 0.6, 0.8, 1.0)
# Ratio of growth from which white matter counts as not growing.
_STILL: Final = 1e3
# Depth of white matter over a wavelength from which the clamped floor of a strip is not felt (1 % in load).
_DEEP: Final = 0.5
# What makes the theory of another configuration another one.
_SECTIONS: Final = ("geometry", "material", "growth", "boundary")


@dataclass(frozen=True)
class Expected:
    """The exact onset of a configuration.

    Attributes
    ----------
    theory : str
        ``annulus``, ``film on a half-space``, or empty where no theory covers the configuration.
    not_covered : str
        Why none does; else empty.
    growth_time : float or None
        Growth time at which stability is lost; None where it is kept to the end of growth.
    mode_number : int or None
        Waves around the contour (along the period); None for waves much shorter than the cortex is thick.
    wavelength_mm : float or None
        Length of one of them on the contour before growth [mm].
    """

    theory: str
    not_covered: str = ""
    growth_time: float | None = None
    mode_number: int | None = None
    wavelength_mm: float | None = None

    @property
    def is_known(self) -> bool:
        """Whether a theory covers the configuration."""
        return not self.not_covered

    def as_dict(self) -> dict[str, Any]:
        """Return the fields as in ``summary.json``."""
        return asdict(self)


def expected_onset(config: Config) -> Expected:
    """What linear theory expects of a configuration, whatever its mesh.

    A circle is exact; an ellipse stands as the circle of the same area and hole, a strip as a film on a
    half-space with the same period. What they leave out is named in ``not_covered``.

    Parameters
    ----------
    config : Config
        Every number of the run.

    Returns
    -------
    Expected
    """
    physics = tuple(getattr(config, name) for name in _SECTIONS)
    return _expected(*(section.model_dump_json() for section in physics), _Held(config))


class _Held:
    """A configuration that is no part of the key under which its answer is kept."""

    def __init__(self, config: Config) -> None:
        self.config = config

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Held)

    def __hash__(self) -> int:
        return 0


@lru_cache(maxsize=256)
def _expected(_geometry: str, _material: str, _growth: str, _boundary: str, held: _Held) -> Expected:
    config = held.config
    if config.growth.rate == 0.0:
        return Expected("annulus" if config.geometry.shape != "strip" else "film on a half-space")
    find = _strip if config.geometry.shape == "strip" else _ring
    try:
        return find(config)
    except GyrifyError as fault:
        return Expected("", f"The theory has no answer: {fault.message}")


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


def annulus_of(config: Config) -> Annulus:
    """Circle of the same area, hole, tissue and growth.

    Raises
    ------
    ConfigError
        If it has no white matter, or something that the theory does not have.
    """
    from gyrify.theory import Annulus

    require_covered(config)
    geometry, material, growth = config.geometry, config.material, config.growth
    radius = geometry.mean_radius
    return Annulus(
        inner_radius=geometry.hole_fraction * radius,
        outer_radius=radius,
        cortical_thickness=geometry.cortical_thickness,
        young_modulus=material.young_modulus,
        stiffness_ratio=material.stiffness_ratio,
        poisson_ratio=material.poisson_ratio,
        poisson_ratio_white=material.poisson_ratio_white,
        growth_rate=growth.rate,
        growth_ratio=growth.ratio,
        duration=growth.duration,
        out_of_plane=growth.out_of_plane,
        out_of_plane_exponent=growth.out_of_plane_exponent,
        stretch=growth.stretch,
        energy_per=growth.energy_per,
        law="tangential" if growth.is_tangential else "isotropic",
        degree=DEGREE,
    )


def _ring(config: Config) -> Expected:
    """First growth time at which the annulus is unstable."""
    from scipy.optimize import brentq

    from gyrify.theory import BaseState, base_state, stability_margin

    annulus = annulus_of(config)
    guess: BaseState | None = None

    def margin(time: float) -> float:
        nonlocal guess
        guess = base_state(annulus, time, guess)
        return stability_margin(guess).value

    times = [part * annulus.duration for part in _SCAN]
    before = times[0]
    for time in times[1:]:
        if margin(time) < 0.0:
            root = brentq(margin, before, time, xtol=1e-4 * annulus.duration, rtol=1e-4)
            number = stability_margin(base_state(annulus, root, guess)).mode_number
            wavelength = 2.0 * np.pi * annulus.outer_radius / number if number else None
            return Expected("annulus", "", float(root), number, wavelength)
        before = time
    return Expected("annulus")


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


def _strip(config: Config) -> Expected:
    """Load at which a film on a half-space wrinkles, as a growth time."""
    from gyrify.theory import critical_wrinkle

    bilayer, geometry = bilayer_of(config), config.geometry
    if isinstance(bilayer, str):
        return Expected("", bilayer)
    name, T = "film on a half-space", geometry.cortical_thickness
    wrinkle = critical_wrinkle(bilayer)
    if wrinkle.is_surface:
        return Expected(name, "", _time_of(config, wrinkle.load))
    number, load = _fitting(bilayer, geometry.length / T, wrinkle.scaled_thickness)
    wavelength = geometry.length / number
    if geometry.depth - T < _DEEP * wavelength:
        return Expected("", "The theory of a strip has deep white matter: at least half a wavelength of it.")
    time = _time_of(config, load)
    return Expected(name, "", time, number, wavelength) if time is not None else Expected(name)


def _fitting(bilayer: Bilayer, period: float, scaled_thickness: float) -> tuple[int, float]:
    """Of the waves that fit a period, in thicknesses, the one that comes first, and its load."""
    from gyrify.theory import neutral_curve

    nearest = period * scaled_thickness / (2.0 * np.pi)
    numbers = sorted({max(1, int(nearest)), int(nearest) + 1})
    loads = neutral_curve(bilayer, [2.0 * np.pi * number / period for number in numbers])
    best = int(np.argmin(loads))
    return numbers[best], float(loads[best])


def _time_of(config: Config, load: float) -> float | None:
    """Growth time at which the cortex has grown by a load; None if it does not by the end."""
    growth = config.growth
    if not np.isfinite(load):
        return None
    strain = np.log(load) if growth.stretch == "exponential" else load - 1.0
    time = float(strain / growth.rate)
    return time if time <= growth.duration else None
