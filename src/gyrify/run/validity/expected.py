"""What exact linear theory expects: when the smooth slice loses stability, and in what wave."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gyrify.config.body_sections import PERIODIC
from gyrify.errors import GyrifyError
from gyrify.run.validity.exact_bodies import annulus_of, bilayer_of, sphere_of

if TYPE_CHECKING:
    from gyrify.config import Config
    from gyrify.theory import Bilayer

# Growth times scanned, as parts of the duration; a slice may be unstable between two of them only.
_SCAN: Final = (0.0, 0.15, 0.3, 0.45, 0.6, 0.8, 1.0)
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
        ``annulus``, ``sphere``, ``film on a half-space``, or empty where no theory covers the configuration.
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

    A circle and a sphere are exact; an ellipse stands as the circle of the same area and hole, an ellipsoid
    as the sphere of the same volume, a strip or a patch as a film on a half-space with the same period. What
    they leave out is named in ``not_covered``.

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
    is_flat, n_dim = config.geometry.shape in PERIODIC, config.geometry.n_dim
    name = "film on a half-space" if is_flat else "annulus" if n_dim == 2 else "sphere"
    if config.growth.rate == 0.0:
        return Expected(name)
    find = _strip if is_flat else _ring if n_dim == 2 else _ball
    try:
        return find(config)
    except GyrifyError as fault:
        return Expected("", f"The theory has no answer: {fault.message}")


def _ring(config: Config) -> Expected:
    """First growth time at which the annulus is unstable."""
    from gyrify.theory import base_state

    annulus = annulus_of(config)
    return _first_loss("annulus", annulus.outer_radius, annulus.duration, partial(base_state, annulus))


def _ball(config: Config) -> Expected:
    """First growth time at which the sphere is unstable."""
    from gyrify.theory import sphere_state

    sphere = sphere_of(config)
    return _first_loss("sphere", sphere.outer_radius, sphere.duration, partial(sphere_state, sphere))


def _first_loss(name: str, radius: float, duration: float, state_at: Callable[..., Any]) -> Expected:
    """Where the smooth state of a theory first loses stability, in growth time."""
    from scipy.optimize import brentq

    from gyrify.theory import stability_margin

    guess: Any = None

    def margin(time: float) -> float:
        nonlocal guess
        guess = state_at(time, guess)
        return stability_margin(guess).value

    times = [part * duration for part in _SCAN]
    before = times[0]
    for time in times[1:]:
        if margin(time) < 0.0:
            root = brentq(margin, before, time, xtol=1e-4 * duration, rtol=1e-4)
            number = stability_margin(state_at(root, guess)).mode_number
            wavelength = 2.0 * np.pi * radius / number if number else None
            return Expected(name, "", float(root), number, wavelength)
        before = time
    return Expected(name)


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
    if geometry.n_dim == 3:
        wavelength = 2.0 * np.pi * T / wrinkle.scaled_thickness
        number, load = round(geometry.length / wavelength), wrinkle.load
    else:
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
