"""Onset of folding of a film on a half-space, and of a bare half-space: exact linear stability.

A wave of any length is tried; the bilayer is stable while the stiffness of its surface against every wave is
positive definite. See `Bilayer` for the load g and the readings.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq, minimize_scalar

from gyrify.errors import ConfigError
from gyrify.theory.bilayer import INCOMPRESSIBLE, Bilayer, Loading
from gyrify.theory.wave import layered_stiffness, lowest_stiffness

__all__ = [
    "INCOMPRESSIBLE",
    "Bilayer",
    "Loading",
    "Wrinkle",
    "asymptotic_wrinkle",
    "critical_surface",
    "critical_wrinkle",
    "dispersion",
    "neutral_curve",
]

FloatArray = NDArray[np.float64]

# Loads scanned, as parts of the load (g - 1) of the bare surface or of the largest one.
_LOAD_PARTS = np.geomspace(1e-4, 2.0, 28)
_LARGEST_STRAIN = 1.0
_SURFACE_LOADS = 1.0 + np.geomspace(1e-2, 4.0, 60)
_SCALED_THICKNESSES = np.geomspace(0.03, 8.0, 20)
_TINY = 1e-9
_EXACT = 1e-13
_ROUGH = 1e-3


@dataclass(frozen=True)
class Wrinkle:
    """The first wave to lose stability as the load rises.

    Attributes
    ----------
    load : float
        Critical g [-]: growth stretch of the film, or 1 / stretch of the compressed bilayer.
    strain : float
        Compression 1 - 1/g [-].
    wavelength : float
        Wavelength / thickness of the film, both deformed [-]; 0 at the surface limit.
    scaled_thickness : float
        k h of the wave in the reference configuration [-]; infinite at the surface limit.
    """

    load: float
    strain: float
    wavelength: float
    scaled_thickness: float

    @property
    def is_surface(self) -> bool:
        """Whether waves far shorter than the film's thickness come first (Biot's surface instability)."""
        return self.wavelength == 0.0


def dispersion(bilayer: Bilayer, load: float, scaled_thickness: ArrayLike) -> FloatArray:
    """Stiffness of the surface against waves, at one load.

    Parameters
    ----------
    bilayer : Bilayer
        The parameters.
    load : float
        g [-], at least 1.
    scaled_thickness : (n,) array_like
        k h [-] of the waves, reference configuration.

    Returns
    -------
    (n,) float array
        Lowest surface stiffness / (k x Young's modulus of the film) [-]; negative means unstable. Minus
        infinity where the bilayer is unstable even if its surface is held.

    Raises
    ------
    ConfigError
        If the load is below 1.
    """
    if not 1.0 <= load < np.inf:
        raise ConfigError(f"The load is {load}.", "It must be finite and at least 1.")
    film, below = bilayer.matrices("film", load)[0], bilayer.half_space("substrate", load)[0]
    return lowest_stiffness(layered_stiffness(film, below, np.atleast_1d(scaled_thickness)))


def neutral_curve(bilayer: Bilayer, scaled_thickness: ArrayLike) -> FloatArray:
    """Load at which each wave loses stability.

    Parameters
    ----------
    bilayer : Bilayer
        The parameters.
    scaled_thickness : (n,) array_like
        k h [-] of the waves, reference configuration.

    Returns
    -------
    (n,) float array
        Lowest critical g [-] of each wave; infinite where there is none up to twice the load
        g - 1 of the bare film's surface, or up to g = 3.
    """
    waves = np.atleast_1d(np.asarray(scaled_thickness, dtype=np.float64))
    return _neutral(bilayer, waves, critical_surface(bilayer).load, _EXACT)


def _neutral(bilayer: Bilayer, waves: FloatArray, surface: float, tolerance: float) -> FloatArray:
    """Neutral curve, given the critical load of the film's bare surface."""
    loads = 1.0 + _LOAD_PARTS * min(surface - 1.0, _LARGEST_STRAIN)
    film, below = bilayer.matrices("film", loads), bilayer.half_space("substrate", loads)
    curve = np.full(len(waves), np.inf)
    for i, kh in enumerate(waves):
        stiffness = lowest_stiffness(layered_stiffness(film, below, np.full(len(loads), kh)))
        bracket = _first_sign_change(loads, stiffness)
        if bracket is not None:
            curve[i] = _root(bilayer, kh, *bracket, tolerance)
    return curve


def _first_sign_change(loads: FloatArray, stiffness: FloatArray) -> tuple[float, float] | None:
    """Neighbouring loads between which the stiffness first turns negative; an unloaded bilayer is stable."""
    unstable = np.flatnonzero(stiffness < 0.0)
    if len(unstable) == 0:
        return None
    return float(np.append(1.0, loads)[unstable[0]]), float(loads[unstable[0]])


def _root(bilayer: Bilayer, kh: float, low: float, high: float, tolerance: float) -> float:
    """Load between two others at which one wave is neutral, to a relative tolerance in g - 1."""

    def stiffness(load: float) -> float:
        # Bounded, so that minus infinity does not break the root-finding.
        return max(float(dispersion(bilayer, load, kh)[0]), -1.0)

    return float(brentq(stiffness, low, high, xtol=tolerance * (high - 1.0), rtol=_EXACT))


def critical_surface(bilayer: Bilayer) -> Wrinkle:
    """Surface instability of a bare half-space of the film's tissue (Biot 1963; any growth).

    Parameters
    ----------
    bilayer : Bilayer
        The parameters; the substrate plays no part.

    Returns
    -------
    Wrinkle
        With zero wavelength; the load is infinite where nothing is critical up to g = 5, as for tissue of
        small nu that grows in all directions: it loses volume and is hardly compressed along the layers.
    """
    stiffness = lowest_stiffness(bilayer.half_space("film", _SURFACE_LOADS))
    bracket = _first_sign_change(_SURFACE_LOADS, stiffness)
    if bracket is None:
        return Wrinkle(np.inf, 1.0, 0.0, np.inf)
    load = brentq(
        lambda g: max(float(lowest_stiffness(bilayer.half_space("film", g))[0]), -1.0), *bracket, xtol=1e-13
    )
    return Wrinkle(load, 1.0 - 1.0 / load, 0.0, np.inf)


def critical_wrinkle(bilayer: Bilayer) -> Wrinkle:
    """First wave to lose stability as the load rises from 1.

    Waves of k h between 0.03 and 8 are tried, and the surface limit for shorter ones.

    Parameters
    ----------
    bilayer : Bilayer
        The parameters.

    Returns
    -------
    Wrinkle
        The surface limit where it comes first or at the same load; the load is infinite where nothing is
        critical up to g = 3.
    """
    surface = critical_surface(bilayer)
    # A rough curve finds the valley; then its floor is sought.
    curve = _neutral(bilayer, _SCALED_THICKNESSES, surface.load, _ROUGH)
    best = int(np.argmin(curve))
    if curve[best] >= 1.0 + (1.0 + _ROUGH) * (surface.load - 1.0):
        return surface
    ends = np.log(_SCALED_THICKNESSES[[max(best - 1, 0), min(best + 1, len(curve) - 1)]])
    low, high = 1.0 + 0.5 * (curve[best] - 1.0), 1.0 + 1.3 * (curve[best] - 1.0)
    wave = minimize_scalar(
        lambda log_kh: _root(bilayer, float(np.exp(log_kh)), low, high, _EXACT),
        bounds=ends,
        method="bounded",
        options={"xatol": 1e-5},
    )
    load, kh = float(wave.fun), float(np.exp(wave.x))
    if load >= surface.load - _TINY:
        return surface
    across, along = bilayer.state("film", load)[0][:2]
    return Wrinkle(load, 1.0 - 1.0 / load, 2.0 * np.pi * float(along / across) / kh, kh)


def asymptotic_wrinkle(stiffness_ratio: float) -> Wrinkle:
    """Large-contrast limit of a compressed incompressible bilayer, good to a few per cent above 50.

    Wavelength 2 pi h (mu_f / 3 mu_s)^(1/3) and strain (3 mu_s / mu_f)^(2/3) / 4 (thin-film theory,
    for instance Allen 1969).

    Parameters
    ----------
    stiffness_ratio : float
        mu_f / mu_s [-].

    Returns
    -------
    Wrinkle
        The limit.

    Raises
    ------
    ConfigError
        If the ratio is not positive.
    """
    if not stiffness_ratio > 0.0:
        raise ConfigError(f"The stiffness ratio is {stiffness_ratio}.", "It must be positive.")
    strain = 0.25 * (3.0 / stiffness_ratio) ** (2.0 / 3.0)
    wavelength = 2.0 * np.pi * (stiffness_ratio / 3.0) ** (1.0 / 3.0)
    return Wrinkle(1.0 / (1.0 - strain), strain, wavelength, 2.0 * np.pi / wavelength)
