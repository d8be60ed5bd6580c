"""Growth at which each circumferential mode becomes unstable, exactly, with the onset of the run."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from gyrify.config import Config
from gyrify.errors import ConfigError
from gyrify.report.drawn_slice import FloatArray
from gyrify.report.plot.curves import curves, title_of
from gyrify.report.plot.shown import Shown
from gyrify.report.plot.style import DASHES, HUES, SINGLE, add_legend, literal
from gyrify.run.validity import exact_bodies
from gyrify.theory import Annulus, SecondVariation, base_state, surface_limit
from gyrify.theory.margin import scaled

# Growth times that are scanned; modes up to waves of two cortical thicknesses.
_TIMES: Final = 17
_MODES: Final = 26
_SHORTEST: Final = 2.0


@dataclass(frozen=True, eq=False)
class Dispersion:
    """Exact growth at onset of a circular slice.

    Attributes
    ----------
    modes : (n_modes,) int array
        Mode numbers n.
    times : (n_modes,) float array
        Growth time at which each becomes unstable [model units]; NaN where none does before growth ends.
    surface : float or None
        Growth time of the surface limit, of waves much shorter than the cortex is thick.
    """

    modes: NDArray[np.int64]
    times: FloatArray
    surface: float | None

    @property
    def critical(self) -> tuple[int, float] | None:
        """Mode number and growth time of the first mode to become unstable."""
        if not np.isfinite(self.times).any():
            return None
        first = int(np.nanargmin(self.times))
        return int(self.modes[first]), float(self.times[first])


def annulus_of(config: Config) -> Annulus:
    """Circular slice with the area, hole and tissues of a configuration.

    Raises
    ------
    ConfigError
        If it is a strip, or a body in space.
    """
    if config.geometry.n_dim == 3:
        raise ConfigError(
            "A body in space has no circumferential modes: dispersion is that of the exact circular slice.",
            "Choose another picture with --what; `expected` in summary.json has the exact onset of spheres.",
        )
    if config.geometry.shape == "strip":
        raise ConfigError(
            "A strip has no circumferential modes: dispersion is that of the exact circular slice.",
            "Choose another picture with --what; docs/strip.md has the exact onset of strips.",
        )
    return replace(exact_bodies.annulus_of(config), degree=Annulus.degree)


def dispersion(annulus: Annulus, modes: Iterable[int]) -> Dispersion:
    """Growth time at which each mode of a circular slice first becomes unstable, to about 1e-3 of it.

    The lowest eigenvalue of each mode is computed at some growth times, and its first zero interpolated.
    Modes beside the first one to become unstable are added, until it stands between two others.
    """
    times = np.linspace(0.0, annulus.duration, _TIMES)
    states = [base_state(annulus, 0.0)]
    for time in times[1:]:
        states.append(base_state(annulus, float(time), states[-1]))
    variations = [SecondVariation.of(state) for state in states]

    def onset(n: int) -> float:
        return _first_zero(times, scaled(annulus, [each.lowest(n) for each in variations], n))

    known = {n: onset(n) for n in modes}
    while unknown := _beside(known):
        known |= {n: onset(n) for n in unknown}
    surface = _first_zero(times, np.array([surface_limit(state) for state in states]))
    numbers = np.array(sorted(known))
    first = np.array([known[n] for n in numbers])
    return Dispersion(numbers, first, None if math.isnan(surface) else surface)


def _beside(known: dict[int, float]) -> list[int]:
    """Modes beside the first one to become unstable whose onset is unknown."""
    finite = {n: time for n, time in known.items() if math.isfinite(time)}
    if not finite:
        return []
    first = min(finite, key=finite.__getitem__)
    return [n for n in (first - 1, first + 1) if n > 0 and n not in known]


def dispersion_plot(states: Sequence[Shown], width_mm: float | None) -> Figure:
    """Exact growth at onset against mode number, with the onset that each run found."""
    annuli = [annulus_of(state.history.config) for state in states]
    label = "growth time at onset [model units]"
    figure, (axes,) = curves(
        title_of(states, "Exact onset of each mode"), "mode number n [–]", [label], width_mm or SINGLE, [55.0]
    )
    for number, (state, annulus) in enumerate(zip(states, annuli, strict=True)):
        found = dispersion(annulus, _modes(annulus, state))
        _draw(axes, state, found, number, len(states) == 1)
    axes.set_xlim(left=0.0)
    axes.margins(y=0.12)
    add_legend(axes, loc="upper right" if len(states) == 1 else "best")
    return figure


def _modes(annulus: Annulus, state: Shown) -> list[int]:
    """Mode numbers in geometric steps, and that of the run's onset."""
    last = round(2.0 * math.pi * annulus.outer_radius / (_SHORTEST * annulus.cortical_thickness))
    modes = {round(float(n)) for n in np.geomspace(2, max(last, 8), _MODES)}
    onset = state.history.onset
    return sorted(modes | ({onset.mode_number} if onset is not None and onset.mode_number > 1 else set()))


def _first_zero(times: FloatArray, margin: FloatArray) -> float:
    """First growth time at which a margin of stability falls through zero; NaN where it does not."""
    below = np.flatnonzero((margin[:-1] >= 0.0) & (margin[1:] < 0.0))
    if not below.size:
        return math.nan
    start = int(below[0])
    return float(brentq(PchipInterpolator(times, margin), times[start], times[start + 1]))


def _draw(axes: Axes, state: Shown, found: Dispersion, number: int, is_alone: bool) -> None:
    hue, onset, critical = HUES[number], state.history.onset, found.critical
    curve = "exact, circle of equal area" if is_alone else literal(state.name)
    style: dict[str, Any] = {"color": hue, "linestyle": DASHES[number], "linewidth": 1.2, "markersize": 2.5}
    axes.plot(found.modes, found.times, marker="o", label=curve, **style)
    if critical is not None:
        name = f"first: n = {critical[0]}, t = {critical[1]:.1f}" if is_alone else None
        axes.plot(*critical, marker="D", markersize=5, color=hue, linestyle="none", label=name)
    if is_alone and found.surface is not None:
        axes.axhline(found.surface, color=HUES[2], linestyle=DASHES[2], linewidth=1.0, label="surface limit")
    if onset is not None:
        name = f"this run: n = {onset.mode_number}, t = {onset.growth_time:.1f}" if is_alone else None
        place: dict[str, Any] = {"markersize": 5, "markerfacecolor": "white", "linestyle": "none"}
        colour = HUES[1] if is_alone else hue
        axes.plot(onset.mode_number, onset.growth_time, marker="s", color=colour, label=name, **place)
    if critical is None:
        text = "no mode becomes unstable before growth ends"
        axes.text(0.5, 0.5 - 0.1 * number, text, transform=axes.transAxes, ha="center", fontsize=8, color=hue)
        axes.set_ylim(0.0, state.history.config.growth.duration)
    if is_alone and onset is None:
        axes.plot([], [], linestyle="none", label="the run found no onset")
