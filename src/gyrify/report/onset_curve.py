"""Where theory lets the growing circle or sphere lose stability, as curves over two parameters."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import zip_longest
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from gyrify.config import Config
from gyrify.config.body_sections import PERIODIC
from gyrify.errors import ConfigError, SolveError
from gyrify.run.validity.exact_bodies import round_body
from gyrify.theory.margin import SmoothState, stability_margin
from gyrify.theory.onset import Parameter, state_at

FloatArray = NDArray[np.float64]
Span = tuple[float, float]

# Parameters along which theory finds every change of stability, the most telling first.
SCANNED: Final[dict[str, Parameter]] = {
    "growth.ratio": "growth_ratio",
    "growth.duration": "growth_time",
    "geometry.cortical_thickness": "cortical_thickness",
    "material.stiffness_ratio": "stiffness_ratio",
}
# Parameters that the exact annulus knows, and the sphere.
COVERED: Final = (
    *SCANNED,
    "geometry.area",
    "geometry.hole_fraction",
    "material.young_modulus",
    "material.poisson_ratio",
    "material.poisson_ratio_white",
    "growth.rate",
)
_SECTIONS: Final = 12
_SCAN: Final = 7
_ACCURACY: Final = 1e-3
_SMOOTH: Final = 160


@dataclass(frozen=True, eq=False)
class OnsetCurve:
    """Curves of neutral stability.

    Attributes
    ----------
    lines : tuple of (n, 2) float arrays
        Values of the first and of the second parameter along each curve.
    note : str
        What a reader should know: what the curve is of, or why there is none.
    """

    lines: tuple[FloatArray, ...]
    note: str


def onset_curve(config: Config, keys: tuple[str, str], spans: tuple[Span, Span]) -> OnsetCurve:
    """Where the exact annulus, or sphere, loses (or gains) stability within two ranges.

    Parameters
    ----------
    config : Config
        All other parameters.
    keys : (str, str)
        Dotted keys of the two parameters.
    spans : ((float, float), (float, float))
        Their ranges.

    Returns
    -------
    OnsetCurve
    """
    missing = [key for key in keys if key not in COVERED]
    scanned = next((key for key in SCANNED if key in keys), None)
    body, round_one, size = ("annulus", "circle", "area")
    if config.geometry.n_dim == 3:
        body, round_one, size = ("sphere", "sphere", "volume")
    is_flat = config.geometry.shape in PERIODIC
    if is_flat or missing or scanned is None:
        flat = {"strip": "strips", "patch": "patches"}
        what = flat[config.geometry.shape] if is_flat else " and ".join(missing or keys)
        return OnsetCurve((), f"No onset curve: the exact {body} does not cover {what}.")
    along = keys.index(scanned)
    sections = _spaced(spans[1 - along], _SECTIONS)
    cuts = [_section(config, (keys[1 - along], at), scanned, spans[along]) for at in sections]
    # Where no section crosses onset there is no row, and no line.
    rows = np.array(list(zip_longest(*(cut.values for cut in cuts), fillvalue=np.nan)), dtype=np.float64)
    lines = [line for values in rows for line in _smooth(sections, values)]
    lines = [line[:, ::-1] if along == 0 else line for line in lines]
    same = "" if config.geometry.shape == round_one else f" of the same {size}"
    circle = f"a {round_one}{same}"
    exact = f"The exact {body}" if body == circle.removeprefix("a ") else f"The exact {body} ({circle})"
    rest = _without_curve([cut.outcome for cut in cuts if not cut.values], len(cuts))
    if not lines and any(cut.values for cut in cuts):
        return OnsetCurve((), f"{exact} changes stability only at an edge of this range{rest}.")
    if not lines:
        return OnsetCurve((), f"{exact} does not change stability in this range{rest}.")
    return OnsetCurve(tuple(lines), f"Onset: exact, for {circle}, without dissipation{rest}.")


@dataclass(frozen=True)
class _Section:
    """One line through the plane: where stability changes on it, and what it is if it does not."""

    values: list[float]
    outcome: str


def _without_curve(outcomes: list[str], n_sections: int) -> str:
    """What is known of the sections that no curve crosses, in words."""
    if not outcomes:
        return ""
    if len(outcomes) == n_sections and len(set(outcomes)) == 1:
        return f": {outcomes[0]} throughout"
    kinds = list(dict.fromkeys(outcomes))
    found = kinds[0] if len(kinds) == 1 else ", ".join(f"{outcomes.count(kind)} {kind}" for kind in kinds)
    return f"; no onset in {len(outcomes)} of {n_sections} sections ({found})"


def _section(config: Config, other: tuple[str, float], key: str, span: Span) -> _Section:
    """Values of the scanned parameter at which stability changes; none where theory finds no base state."""
    guess: SmoothState | None = None

    def margin(value: float) -> float:
        nonlocal guess
        guess = state_at(body, SCANNED[key], value, body.duration, guess)
        return stability_margin(guess).value

    values = _spaced(span, _SCAN).tolist()
    try:
        there = round_body(config.replace(**{other[0]: float(other[1]), key: float(span[1])}))
        body = replace(there, degree=type(there).degree)
        margins = [margin(value) for value in values]
        found = [
            float(brentq(margin, values[i], values[i + 1], rtol=_ACCURACY))
            for i in range(len(values) - 1)
            if (margins[i] < 0.0) != (margins[i + 1] < 0.0)
        ]
        return _Section(found, "unstable" if margins[0] < 0.0 else "stable")
    except (ConfigError, SolveError):
        return _Section([], "without a smooth state")


def _spaced(span: Span, n: int) -> FloatArray:
    """Values in a range, in equal ratios where it spans much."""
    low, high = span
    inner = (np.geomspace if low > 0.0 and high > 4.0 * low else np.linspace)(low, high, n)[1:-1]
    return np.array([low, *inner, high])


def _smooth(sections: FloatArray, values: FloatArray) -> list[FloatArray]:
    """Curves through neighbouring sections that have a value, monotone between them; none over a gap."""
    known = np.flatnonzero(np.isfinite(values))
    runs = [run for run in np.split(known, np.flatnonzero(np.diff(known) > 1) + 1) if run.size >= 2]
    at = [np.linspace(sections[run[0]], sections[run[-1]], _SMOOTH) for run in runs]
    return [
        np.column_stack([x, PchipInterpolator(sections[run], values[run])(x)])
        for run, x in zip(runs, at, strict=True)
    ]
