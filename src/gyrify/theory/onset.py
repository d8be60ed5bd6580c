"""Where the growing annulus loses stability: every crossing of a scanned parameter."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from gyrify.errors import ConfigError
from gyrify.theory.annulus import Annulus, BaseState, base_state
from gyrify.theory.modes import SecondVariation, surface_limit

FloatArray = NDArray[np.float64]
Parameter = Literal["growth_ratio", "growth_time", "stiffness_ratio", "cortical_thickness"]

_MODE_SPACING = 1.4
# Beyond this many waves per 2 pi thicknesses a wave sees a half-space, which the surface limit covers.
_SHORTEST = 5.0


@dataclass(frozen=True)
class Crossing:
    """One value of a parameter at which the annulus gains or loses stability.

    Attributes
    ----------
    parameter : str
        Name of the parameter.
    value : float
        Its value there, in its own unit.
    mode_number : int or None
        n of the mode that crosses; None for the surface limit.
    wavelength : float
        Length of one wave on the deformed contour [mm]; 0 for the surface limit.
    growth_time : float
        t [time].
    becomes : {"unstable", "stable"}
        What the annulus becomes as the parameter rises.
    """

    parameter: Parameter
    value: float
    mode_number: int | None
    wavelength: float
    growth_time: float
    becomes: Literal["unstable", "stable"]


@dataclass(frozen=True)
class Margin:
    """The weakest mode of one state: its number (None for the surface limit) and its stability margin [-]."""

    value: float
    mode_number: int | None


def scaled(annulus: Annulus, eigenvalue: ArrayLike, mode_number: ArrayLike) -> FloatArray:
    """Eigenvalue [Pa/mm^2] over the shear stiffness of a wave as long, mu (n / outer radius)^2 [-]."""
    wave_number = np.maximum(mode_number, 1) / annulus.outer_radius
    return np.asarray(eigenvalue, dtype=np.float64) / (annulus.moduli_grey[0] * wave_number**2)


def coarse_modes(annulus: Annulus) -> list[int]:
    """Mode numbers to scan: all up to 5, then in geometric steps until waves are shorter than the cortex."""
    last = int(np.ceil(_SHORTEST * annulus.outer_radius / annulus.cortical_thickness))
    modes = [0, 1, 2]
    while modes[-1] < last:
        modes.append(min(last, max(modes[-1] + 1, round(modes[-1] * _MODE_SPACING))))
    return modes


def stability_margin(state: BaseState) -> Margin:
    """Weakest mode of a state, over all mode numbers and the surface limit.

    Parameters
    ----------
    state : BaseState
        The axisymmetric state.

    Returns
    -------
    Margin
        Negative where the state is unstable.
    """
    annulus, variation = state.annulus, SecondVariation.of(state)
    known: dict[int, float] = {}

    def margin(number: int) -> float:
        if number not in known:
            known[number] = float(scaled(annulus, variation.lowest(number), number))
        return known[number]

    coarse = coarse_modes(annulus)
    best = min(coarse, key=margin)
    step = max(1, round(best * (_MODE_SPACING - 1.0)) // 2)
    while best > 1:
        better = min((best - step, best, min(best + step, coarse[-1])), key=margin)
        if better == best and step == 1:
            break
        best, step = better, max(1, step // 2) if better == best else step
    surface = surface_limit(state)
    return Margin(surface, None) if surface < margin(best) else Margin(margin(best), best)


def state_at(
    annulus: Annulus, parameter: Parameter, value: float, growth_time: float, guess: BaseState | None
) -> BaseState:
    """Axisymmetric state with one parameter set; `growth_time` is used unless it is that parameter."""
    if parameter == "growth_time":
        return base_state(annulus, value, guess)
    changes: dict[str, float] = {parameter: value}
    return base_state(replace(annulus, **changes), growth_time, guess)  # type: ignore[arg-type]


def crossings(
    annulus: Annulus, parameter: Parameter, values: Sequence[float], growth_time: float | None = None
) -> tuple[Crossing, ...]:
    """Every change of stability along a scanned parameter.

    Stability need not be monotone in the parameter, so nothing is bisected before the scan.

    Parameters
    ----------
    annulus : Annulus
        The other parameters.
    parameter : {"growth_ratio", "growth_time", "stiffness_ratio", "cortical_thickness"}
        What is varied.
    values : sequence of float
        The values scanned, increasing; two crossings between neighbours are not seen.
    growth_time : float, optional
        t [time] where it is not itself varied; the annulus' duration by default.

    Returns
    -------
    tuple of Crossing
        In the order of the values, to about 1e-6 of the value; empty where nothing is critical.

    Raises
    ------
    ConfigError
        If the values are not increasing, or one is out of bounds.
    SolveError
        If an axisymmetric state is not found.
    """
    if len(values) < 2 or np.any(np.diff(values) <= 0.0):
        raise ConfigError("The scanned values do not increase.", "Give two values or more, in order.")
    time = annulus.duration if growth_time is None else growth_time
    guess: BaseState | None = None

    def margin(value: float) -> float:
        nonlocal guess
        guess = state_at(annulus, parameter, value, time, guess)
        return stability_margin(guess).value

    margins = [margin(value) for value in values]
    found = []
    for i in range(len(values) - 1):
        if (margins[i] < 0.0) != (margins[i + 1] < 0.0):
            root = brentq(margin, values[i], values[i + 1], xtol=1e-9, rtol=1e-7)
            state = state_at(annulus, parameter, root, time, guess)
            found.append(_crossing(parameter, root, state, margins[i] < 0.0))
    return tuple(found)


def _crossing(parameter: Parameter, value: float, state: BaseState, was_unstable: bool) -> Crossing:
    number = stability_margin(state).mode_number
    outer = float(state.radius(state.annulus.outer_radius))
    return Crossing(
        parameter,
        value,
        number,
        2.0 * np.pi * outer / number if number else 0.0,
        state.growth_time,
        "stable" if was_unstable else "unstable",
    )


def critical_growth_ratio(
    annulus: Annulus, values: Sequence[float] | None = None, growth_time: float | None = None
) -> tuple[Crossing, ...]:
    """Growth ratios at which the annulus changes stability (see `crossings`).

    Parameters
    ----------
    annulus : Annulus
        The other parameters.
    values : sequence of float, optional
        Growth ratios scanned [-]; 1 to 10 in 24 geometric steps by default.
    growth_time : float, optional
        t [time]; the annulus' duration by default.

    Returns
    -------
    tuple of Crossing
        Every one in the range; empty where nothing is critical.
    """
    return crossings(
        annulus,
        "growth_ratio",
        np.geomspace(1.0, 10.0, 25).tolist() if values is None else values,
        growth_time,
    )


def critical_growth_time(annulus: Annulus, values: Sequence[float] | None = None) -> tuple[Crossing, ...]:
    """Growth times at which the annulus changes stability (see `crossings`).

    Parameters
    ----------
    annulus : Annulus
        The parameters.
    values : sequence of float, optional
        Growth times scanned [time]; 25 equal steps of the duration by default.

    Returns
    -------
    tuple of Crossing
        Every one in the range; empty where nothing is critical.
    """
    return crossings(
        annulus, "growth_time", np.linspace(0.0, annulus.duration, 26).tolist() if values is None else values
    )


def stability_map(
    annulus: Annulus,
    parameter: Parameter,
    values: Sequence[float],
    mode_numbers: Sequence[int],
    growth_time: float | None = None,
) -> FloatArray:
    """Scaled lowest eigenvalues over a parameter and the mode number; the zero contour is the critical curve.

    Parameters
    ----------
    annulus : Annulus
        The other parameters.
    parameter : {"growth_ratio", "growth_time", "stiffness_ratio", "cortical_thickness"}
        What is varied.
    values : (n_values,) sequence of float
        Its values, in its own unit.
    mode_numbers : (n_modes,) sequence of int
        Mode numbers n [-].
    growth_time : float, optional
        t [time] where it is not itself varied; the annulus' duration by default.

    Returns
    -------
    (n_values, n_modes) float array
        Lowest eigenvalue / mu (n / outer radius)^2 [-]; negative means unstable.
    """
    time = annulus.duration if growth_time is None else growth_time
    rows, guess = [], None
    for value in values:
        guess = state_at(annulus, parameter, value, time, guess)
        variation = SecondVariation.of(guess)
        rows.append(scaled(annulus, [variation.lowest(number) for number in mode_numbers], mode_numbers))
    return np.array(rows)
