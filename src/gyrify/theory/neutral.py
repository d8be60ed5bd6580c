"""Stiffness of a bilayer's surface against one wave, and the load at which it vanishes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from gyrify.errors import ConfigError
from gyrify.theory.bilayer import Bilayer
from gyrify.theory.wave import layered_stiffness, lowest_stiffness

FloatArray = NDArray[np.float64]

# Loads scanned, as parts of the lowest load (g - 1) of a bare surface or of the largest one.
_LOAD_PARTS = np.geomspace(1e-4, 2.0, 28)
_LARGEST_STRAIN = 1.0
# Relative tolerance of a critical load that is not a rough one.
EXACT: Final = 1e-13


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


@dataclass(frozen=True, eq=False)
class LoadScan:
    """A bilayer at the loads of a scan: film (n, 4, 4), substrate (n, 2, 2)."""

    bilayer: Bilayer
    loads: FloatArray
    film: FloatArray
    below: FloatArray

    @classmethod
    def of(cls, bilayer: Bilayer, surface: float) -> LoadScan:
        """Scan up to twice the load g - 1 of the first bare surface."""
        loads = 1.0 + _LOAD_PARTS * min(surface - 1.0, _LARGEST_STRAIN)
        return cls(bilayer, loads, bilayer.matrices("film", loads), bilayer.half_space("substrate", loads))

    def neutral(self, waves: FloatArray, tolerance: float) -> FloatArray:
        """Critical load of each wave, to a relative tolerance in g - 1; infinite where there is none."""
        curve = np.full(len(waves), np.inf)
        for i, kh in enumerate(waves):
            thickness = np.full(len(self.loads), kh)
            stiffness = lowest_stiffness(layered_stiffness(self.film, self.below, thickness))
            bracket = first_sign_change(self.loads, stiffness)
            if bracket is not None:
                curve[i] = root(self.bilayer, kh, *bracket, tolerance)
        return curve


def first_sign_change(loads: FloatArray, stiffness: FloatArray) -> tuple[float, float] | None:
    """Neighbouring loads between which the stiffness first turns negative; an unloaded bilayer is stable."""
    unstable = np.flatnonzero(stiffness < 0.0)
    if len(unstable) == 0:
        return None
    return float(np.append(1.0, loads)[unstable[0]]), float(loads[unstable[0]])


def root(bilayer: Bilayer, kh: float, low: float, high: float, tolerance: float) -> float:
    """Load between two others at which one wave is neutral, to a relative tolerance in g - 1."""

    def stiffness(load: float) -> float:
        # Bounded, so that minus infinity does not break the root-finding.
        return max(float(dispersion(bilayer, load, kh)[0]), -1.0)

    return float(brentq(stiffness, low, high, xtol=tolerance * (high - 1.0), rtol=EXACT))
