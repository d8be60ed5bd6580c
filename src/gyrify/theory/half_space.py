"""Onset of folding of a film on a half-space, and of a bare half-space: exact linear stability.

A wave of any length is tried; the bilayer is stable while the stiffness of its surface against every wave is
positive definite. See `Bilayer` for the load g and the readings.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq, minimize_scalar

from gyrify.errors import ConfigError
from gyrify.theory.bilayer import INCOMPRESSIBLE, Bilayer, Layer, Loading
from gyrify.theory.neutral import EXACT, LoadScan, dispersion, first_sign_change
from gyrify.theory.wave import lowest_stiffness

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

# Strains g - 1 of a bare tissue's own growth, or of the compression, at which its surface is looked at.
_SURFACE_STRAINS = np.geomspace(1e-2, 4.0, 60)
# Waves scanned at first, and how far the scan goes on where the first wave lies at its end.
_SCALED_THICKNESSES = np.geomspace(0.03, 8.0, 20)
_SHORTEST, _LONGEST = 64.0, 1e-5
_TINY = 1e-9
_ROUGH = 1e-3


@dataclass(frozen=True)
class Wrinkle:
    """The first wave to lose stability as the load rises.

    Attributes
    ----------
    load : float
        Critical g [-]: growth stretch of the film, or 1 / stretch of the compressed bilayer; infinite where
        nothing is critical up to `searched`.
    strain : float
        Compression 1 - 1/g [-].
    wavelength : float
        Wavelength / thickness of the film, both deformed [-]; 0 at the limit of short waves, infinite at that
        of long ones.
    scaled_thickness : float
        k h of the wave in the reference configuration [-]; infinite at the limit of short waves, 0 at that of
        long ones.
    searched : float
        Largest load that was tried [-].
    """

    load: float
    strain: float
    wavelength: float
    scaled_thickness: float
    searched: float = np.inf

    @property
    def is_surface(self) -> bool:
        """Whether waves far shorter than the film's thickness come first (Biot's surface instability)."""
        return self.wavelength == 0.0

    @property
    def is_substrate(self) -> bool:
        """Whether waves far longer than the film is thick come first: the substrate's own surface."""
        return self.scaled_thickness == 0.0

    @property
    def at_edge(self) -> bool:
        """Whether no finite wave is the first: the answer is a limit of the waves, or of the loads tried."""
        return self.is_surface or self.is_substrate or not np.isfinite(self.load)

    @property
    def note(self) -> str:
        """What the answer is a limit of, in words; empty for a finite wave."""
        if not np.isfinite(self.load):
            return f"Nothing is critical up to a load of {self.searched:g}, the largest that was tried."
        if self.is_surface:
            return "The shorter the wave, the earlier: the film's own surface is critical first."
        if self.is_substrate:
            return "The longer the wave, the earlier: the substrate's own surface is critical first."
        return ""


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
        g - 1 of the first bare surface, the film's or the substrate's, or up to g = 3.
    """
    waves = np.atleast_1d(np.asarray(scaled_thickness, dtype=np.float64))
    return LoadScan.of(bilayer, _surfaces(bilayer)[0].load).neutral(waves, EXACT)


def critical_surface(bilayer: Bilayer, layer: Layer = "film") -> Wrinkle:
    """Surface instability of a bare half-space of one layer's tissue (Biot 1963; any growth).

    Parameters
    ----------
    bilayer : Bilayer
        The parameters.
    layer : {"film", "substrate"}
        Whose tissue; the other plays no part.

    Returns
    -------
    Wrinkle
        The limit of short waves (film), or of long ones (substrate), at the film's load g. Infinite where
        nothing is critical up to a stretch of 5 of the layer itself, as for tissue of small nu that grows in
        all directions: it loses volume and is hardly compressed along the layers; or for a substrate that
        does not grow.
    """
    scale = bilayer.growth_ratio if layer == "substrate" and bilayer.loading != "compression" else 1.0
    wavelength, kh = (0.0, np.inf) if layer == "film" else (np.inf, 0.0)
    searched = float(1.0 + scale * _SURFACE_STRAINS[-1])
    if not np.isfinite(scale):
        return Wrinkle(np.inf, 1.0, wavelength, kh, searched)
    loads = 1.0 + scale * _SURFACE_STRAINS
    bracket = first_sign_change(loads, lowest_stiffness(bilayer.half_space(layer, loads)))
    if bracket is None:
        return Wrinkle(np.inf, 1.0, wavelength, kh, searched)
    load = brentq(
        lambda g: max(float(lowest_stiffness(bilayer.half_space(layer, g))[0]), -1.0), *bracket, xtol=1e-13
    )
    return Wrinkle(load, 1.0 - 1.0 / load, wavelength, kh, searched)


def _surfaces(bilayer: Bilayer) -> tuple[Wrinkle, Wrinkle]:
    """The limits of short and of long waves, the first to be critical first; the film's where they agree.

    The interface needs no look of its own: its stiffness is the sum of those of two half-spaces, and positive
    while both surfaces are stable.
    """
    film, substrate = critical_surface(bilayer), critical_surface(bilayer, "substrate")
    return (substrate, film) if substrate.load < film.load - _TINY else (film, substrate)


def critical_wrinkle(bilayer: Bilayer) -> Wrinkle:
    """First wave to lose stability as the load rises from 1: the infimum over all waves.

    Waves of k h between 0.03 and 8 are tried, more where the first one lies at an end of these, and the two
    limits: the film's own surface (short waves) and the substrate's own (long waves).

    Parameters
    ----------
    bilayer : Bilayer
        The parameters.

    Returns
    -------
    Wrinkle
        A limit where it comes first or at the same load (`Wrinkle.at_edge`, told by `Wrinkle.note`); the load
        is infinite where nothing is critical up to g = 3.
    """
    limit = _surfaces(bilayer)[0]
    scan = LoadScan.of(bilayer, limit.load)
    waves, curve = _extended(scan, limit.load)
    best = int(np.argmin(curve))
    if curve[best] >= 1.0 + (1.0 + _ROUGH) * (limit.load - 1.0):
        return replace(limit, searched=float(scan.loads[-1])) if not np.isfinite(limit.load) else limit
    largest = 2.0 * scan.loads[-1]
    # The rough curve has found the valley; now its floor is sought.
    wave = minimize_scalar(
        lambda log_kh: min(scan.neutral(np.exp([log_kh]), EXACT)[0], largest),
        bounds=np.log(waves[[max(best - 1, 0), min(best + 1, len(curve) - 1)]]),
        method="bounded",
        options={"xatol": 1e-5},
    )
    load, kh = float(wave.fun), float(np.exp(wave.x))
    if load >= limit.load - _TINY:
        return limit
    across, along = bilayer.state("film", load)[0][:2]
    wavelength = 2.0 * np.pi * float(along / across) / kh
    return Wrinkle(load, 1.0 - 1.0 / load, wavelength, kh, float(scan.loads[-1]))


def _extended(scan: LoadScan, limit: float) -> tuple[FloatArray, FloatArray]:
    """Waves and their rough neutral loads, with more waves at an end as long as the first one lies there."""
    waves, step = _SCALED_THICKNESSES, _SCALED_THICKNESSES[1] / _SCALED_THICKNESSES[0]
    curve = scan.neutral(waves, _ROUGH)
    while np.isfinite(curve).any() and curve.min() < 1.0 + (1.0 + _ROUGH) * (limit - 1.0):
        best = int(np.argmin(curve))
        if best == 0 and waves[0] > _LONGEST:
            wave = waves[:1] / step
            waves, curve = np.append(wave, waves), np.append(scan.neutral(wave, _ROUGH), curve)
        elif best == len(waves) - 1 and waves[-1] < _SHORTEST:
            wave = waves[-1:] * step
            waves, curve = np.append(waves, wave), np.append(curve, scan.neutral(wave, _ROUGH))
        else:
            break
    return waves, curve


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
