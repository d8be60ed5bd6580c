"""The weakest mode of one smooth state, over all mode numbers and the limit of short waves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gyrify.theory.annulus import Annulus, BaseState
from gyrify.theory.mode_numbers import SecondVariation, surface_limit
from gyrify.theory.sphere import Sphere, SphereState
from gyrify.theory.spherical_modes import SphericalVariation

FloatArray = NDArray[np.float64]
SmoothState = BaseState | SphereState

_MODE_SPACING = 1.4
# Beyond this many waves per 2 pi thicknesses a wave sees a half-space, which the surface limit covers; where
# the weakest mode lies at that end all the same, the search goes on, as far as the elements resolve.
_SHORTEST = 5.0
_SHORTEST_RESOLVED = 20.0


@dataclass(frozen=True)
class Margin:
    """The weakest mode of one state.

    Attributes
    ----------
    value : float
        Its stability margin [-]; negative where the state is unstable.
    mode_number : int or None
        Its number, of a sphere its degree; None for the surface limit.
    at_edge : bool
        Whether it is the last number that was tried, so that a shorter wave may be weaker still.
    """

    value: float
    mode_number: int | None
    at_edge: bool = False


def scaled(body: Annulus | Sphere, eigenvalue: ArrayLike, mode_number: ArrayLike) -> FloatArray:
    """Eigenvalue [Pa/mm^2] over the shear stiffness of a wave as long, mu (n / outer radius)^2 [-]."""
    wave_number = np.maximum(mode_number, 1) / body.outer_radius
    return np.asarray(eigenvalue, dtype=np.float64) / (body.moduli_grey[0] * wave_number**2)


def coarse_modes(body: Annulus | Sphere) -> list[int]:
    """Mode numbers to scan: all up to 5, then in geometric steps until waves are shorter than the cortex."""
    last = int(np.ceil(_SHORTEST * body.outer_radius / body.cortical_thickness))
    modes = [0, 1, 2]
    while modes[-1] < last:
        modes.append(min(last, max(modes[-1] + 1, round(modes[-1] * _MODE_SPACING))))
    return modes


def variation_of(state: SmoothState) -> SecondVariation | SphericalVariation:
    """The second variation about a smooth state."""
    return SphericalVariation.of(state) if isinstance(state, SphereState) else SecondVariation.of(state)


def stability_margin(state: SmoothState) -> Margin:
    """Weakest mode of a state, over all mode numbers and the surface limit.

    Parameters
    ----------
    state : BaseState or SphereState
        The smooth state.

    Returns
    -------
    Margin
        Negative where the state is unstable.
    """
    body = state.sphere if isinstance(state, SphereState) else state.annulus
    variation = variation_of(state)
    known: dict[int, float] = {}

    def margin(number: int) -> float:
        if number not in known:
            known[number] = float(scaled(body, variation.lowest(number), number))
        return known[number]

    modes = coarse_modes(body)
    end = int(np.ceil(_SHORTEST_RESOLVED * body.outer_radius / body.cortical_thickness))
    while min(modes, key=margin) == modes[-1] < end:
        modes.append(min(end, round(modes[-1] * _MODE_SPACING)))
    for valley in _valleys(modes, margin):
        _descend(valley, modes[-1], margin)
    best = min(known, key=margin)
    surface = surface_limit(state)
    if surface < margin(best):
        return Margin(surface, None)
    return Margin(margin(best), best, at_edge=best == modes[-1])


def _valleys(modes: list[int], margin: Callable[[int], float]) -> list[int]:
    """Modes, of those scanned from 2 on, that are no stronger than both neighbours."""
    values = [np.inf, *(margin(number) for number in modes if number > 1), np.inf]
    waves = [number for number in modes if number > 1]
    return [n for i, n in enumerate(waves, 1) if values[i] <= min(values[i - 1], values[i + 1])]


def _descend(start: int, last: int, margin: Callable[[int], float]) -> None:
    """Evaluate modes around a scanned one until the weakest has been seen with both its neighbours."""
    best, step = start, max(1, round(start * (_MODE_SPACING - 1.0)) // 2)
    while True:
        better = min((max(best - step, 2), best, min(best + step, last)), key=margin)
        if better == best and step == 1:
            return
        best, step = better, max(1, step // 2) if better == best else step
