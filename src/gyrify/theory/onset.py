"""Where a growing annulus or sphere loses stability: every crossing of a scanned parameter."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from gyrify.errors import ConfigError
from gyrify.theory.annulus import Annulus, BaseState, base_state
from gyrify.theory.margin import SmoothState, scaled, stability_margin, variation_of
from gyrify.theory.sphere import Sphere, SphereState, sphere_state

FloatArray = NDArray[np.float64]
Parameter = Literal["growth_ratio", "growth_time", "stiffness_ratio", "cortical_thickness"]

# Margin at an end of the scanned range, over the largest in it, below which a crossing may lie just outside.
_NEAR = 1e-3


@dataclass(frozen=True)
class Crossing:
    """One value of a parameter at which a body gains or loses stability.

    Attributes
    ----------
    parameter : str
        Name of the parameter.
    value : float
        Its value there, in its own unit.
    mode_number : int or None
        n of the mode that crosses, of a sphere its degree l; None for the surface limit.
    wavelength : float
        Length of one wave on the deformed surface [mm], of a sphere 2 pi r / sqrt(l (l + 1)); 0 for the
        surface limit, infinite for mode 0.
    growth_time : float
        t [time].
    becomes : {"unstable", "stable"}
        What the body becomes as the parameter rises.
    at_edge : bool
        Whether the mode is the last that was tried, so that a shorter wave may come first.
    """

    parameter: Parameter
    value: float
    mode_number: int | None
    wavelength: float
    growth_time: float
    becomes: Literal["unstable", "stable"]
    at_edge: bool = False


class Crossings(tuple[Crossing, ...]):
    """Every change of stability that a scan has found, in the order of the values.

    Attributes
    ----------
    notes : tuple of str
        What the range that was searched leaves open, in words; empty where it leaves nothing open.
    """

    notes: tuple[str, ...] = ()

    @classmethod
    def of(cls, found: Iterable[Crossing], notes: Iterable[str]) -> Crossings:
        """Crossings with what is to be said of their search."""
        crossings = cls(found)
        crossings.notes = tuple(notes)
        return crossings


def state_at(
    body: Annulus | Sphere,
    parameter: Parameter,
    value: float,
    growth_time: float,
    guess: SmoothState | None,
) -> SmoothState:
    """Smooth state with one parameter set; `growth_time` is used unless it is that parameter."""
    time = value if parameter == "growth_time" else growth_time
    changes: dict[str, float] = {} if parameter == "growth_time" else {parameter: value}
    changed = replace(body, **changes)  # type: ignore[arg-type]
    if isinstance(changed, Sphere):
        return sphere_state(changed, time, guess if isinstance(guess, SphereState) else None)
    return base_state(changed, time, guess if isinstance(guess, BaseState) else None)


def crossings(
    annulus: Annulus | Sphere, parameter: Parameter, values: Sequence[float], growth_time: float | None = None
) -> Crossings:
    """Every change of stability along a scanned parameter.

    Stability need not be monotone in the parameter, so nothing is bisected before the scan.

    Parameters
    ----------
    annulus : Annulus or Sphere
        The body, with the other parameters.
    parameter : {"growth_ratio", "growth_time", "stiffness_ratio", "cortical_thickness"}
        What is varied.
    values : sequence of float
        The values scanned, increasing; two crossings between neighbours are not seen.
    growth_time : float, optional
        t [time] where it is not itself varied; the body's duration by default.

    Returns
    -------
    Crossings
        A tuple in the order of the values, to about 1e-6 of the value; empty where nothing is critical. Its
        `notes` say what the range leaves open.

    Raises
    ------
    ConfigError
        If the values are not increasing, or one is out of bounds.
    SolveError
        If a smooth state is not found.
    """
    if len(values) < 2 or np.any(np.diff(values) <= 0.0):
        raise ConfigError("The scanned values do not increase.", "Give two values or more, in order.")
    time = annulus.duration if growth_time is None else growth_time
    guess: SmoothState | None = None

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
    return Crossings.of(found, _notes(parameter, values, margins, found))


def _notes(
    parameter: Parameter, values: Sequence[float], margins: Sequence[float], found: Sequence[Crossing]
) -> Iterator[str]:
    """What the range and the modes that were searched leave open."""
    name, low, high = parameter.replace("_", " "), float(values[0]), float(values[-1])
    if margins[0] < 0.0:
        yield (
            f"The body is unstable already at the lowest {name} scanned ({low:.6g}): a crossing may lie "
            "below it. Scan from a smaller value."
        )
    for end, value in ((margins[0], low), (margins[-1], high)):
        if 0.0 <= end < _NEAR * max(map(abs, margins)):
            yield (
                f"The margin nearly vanishes at the end of the range, {name} = {value:.6g}: a crossing may "
                "lie just outside of it. Scan a wider range."
            )
    for crossing in found:
        if crossing.at_edge:
            yield (
                f"At {name} = {crossing.value:.6g} the weakest mode is the last one tried, "
                f"{crossing.mode_number}: a shorter wave may come first."
            )


def _crossing(parameter: Parameter, value: float, state: SmoothState, was_unstable: bool) -> Crossing:
    weakest = stability_margin(state)
    number = weakest.mode_number
    waves: float | None = number
    body: Annulus | Sphere
    if isinstance(state, SphereState):
        body, waves = state.sphere, number and float(np.sqrt(number * (number + 1.0)))
    else:
        body = state.annulus
    length = 2.0 * np.pi * float(state.radius(body.outer_radius))
    return Crossing(
        parameter,
        value,
        number,
        0.0 if waves is None else length / waves if waves else np.inf,
        state.growth_time,
        "stable" if was_unstable else "unstable",
        weakest.at_edge,
    )


def critical_growth_ratio(
    annulus: Annulus | Sphere, values: Sequence[float] | None = None, growth_time: float | None = None
) -> Crossings:
    """Growth ratios at which the body changes stability (see `crossings`).

    Parameters
    ----------
    annulus : Annulus or Sphere
        The body, with the other parameters.
    values : sequence of float, optional
        Growth ratios scanned [-]; 1 to 10 in 24 geometric steps by default.
    growth_time : float, optional
        t [time]; the body's duration by default.

    Returns
    -------
    Crossings
        Every one in the range; empty where nothing is critical.
    """
    return crossings(
        annulus,
        "growth_ratio",
        np.geomspace(1.0, 10.0, 25).tolist() if values is None else values,
        growth_time,
    )


def critical_growth_time(annulus: Annulus | Sphere, values: Sequence[float] | None = None) -> Crossings:
    """Growth times at which the body changes stability (see `crossings`).

    Parameters
    ----------
    annulus : Annulus or Sphere
        The body.
    values : sequence of float, optional
        Growth times scanned [time]; 25 equal steps of the duration by default.

    Returns
    -------
    Crossings
        Every one in the range; empty where nothing is critical.
    """
    return crossings(
        annulus, "growth_time", np.linspace(0.0, annulus.duration, 26).tolist() if values is None else values
    )


def stability_map(
    annulus: Annulus | Sphere,
    parameter: Parameter,
    values: Sequence[float],
    mode_numbers: Sequence[int],
    growth_time: float | None = None,
) -> FloatArray:
    """Scaled lowest eigenvalues over a parameter and the mode number; the zero contour is the critical curve.

    Parameters
    ----------
    annulus : Annulus or Sphere
        The body, with the other parameters.
    parameter : {"growth_ratio", "growth_time", "stiffness_ratio", "cortical_thickness"}
        What is varied.
    values : (n_values,) sequence of float
        Its values, in its own unit.
    mode_numbers : (n_modes,) sequence of int
        Mode numbers n [-].
    growth_time : float, optional
        t [time] where it is not itself varied; the body's duration by default.

    Returns
    -------
    (n_values, n_modes) float array
        Lowest eigenvalue / mu (n / outer radius)^2 [-]; negative means unstable.
    """
    time = annulus.duration if growth_time is None else growth_time
    rows: list[FloatArray] = []
    guess: SmoothState | None = None
    for value in values:
        guess = state_at(annulus, parameter, value, time, guess)
        variation = variation_of(guess)
        rows.append(scaled(annulus, [variation.lowest(number) for number in mode_numbers], mode_numbers))
    return np.array(rows)
