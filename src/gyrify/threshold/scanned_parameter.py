"""The parameters that a threshold can be sought in, and what is scanned unless a range is given."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from gyrify.base.arguments import native, real_number, whole_number
from gyrify.config import Config
from gyrify.errors import ConfigError

Range = tuple[float, float]


@dataclass(frozen=True)
class Scannable:
    """How a parameter is scanned.

    Attributes
    ----------
    unit : str
        Its unit.
    stability, visible : callable
        Default range for either definition.
    points, runs : int
        Values scanned by default for either definition.
    logarithmic : bool
        Whether they are spaced geometrically.
    """

    unit: str
    stability: Callable[[Config], Range]
    visible: Callable[[Config], Range]
    points: int
    runs: int
    logarithmic: bool


def _walls(config: Config) -> Range:
    return 0.5, 0.5 * config.geometry.narrowest_wall


def _times(config: Config) -> Range:
    return 0.0, config.growth.duration


PARAMETERS: Final = {
    "growth.ratio": Scannable("", lambda _: (1.0, 10.0), lambda _: (1.0, 4.0), 25, 7, True),
    "growth.time": Scannable("time", _times, _times, 26, 0, False),
    "material.stiffness_ratio": Scannable("", lambda _: (0.2, 5.0), lambda _: (1 / 3, 3.0), 25, 7, True),
    "geometry.cortical_thickness": Scannable("mm", _walls, _walls, 25, 7, True),
}


def configured(config: Config, parameter: str, value: float) -> Config:
    """Configuration with one parameter set; a growth time is the end of growth.

    Raises
    ------
    ConfigError
        If the value is out of bounds.
    """
    key = "growth.duration" if parameter == "growth.time" else parameter
    return config.replace(**{key: float(value)})


def scan_values(
    config: Config, parameter: str, given: Range | None, points: int | None, visible: bool
) -> list[float]:
    """Values to scan, in increasing order.

    Raises
    ------
    ConfigError
        If the parameter, range or number of points makes no sense.
    """
    scannable = PARAMETERS.get(parameter)
    if scannable is None:
        raise ConfigError(
            f"parameter = {parameter[:60]!r} has no threshold.", f"Choose one of: {', '.join(PARAMETERS)}."
        )
    default = (scannable.visible if visible else scannable.stability)(config)
    low, high = default if given is None else _pair(given)
    count = whole_number("points", points) if points else (scannable.runs if visible else scannable.points)
    if not (np.isfinite([low, high]).all() and low < high):
        raise ConfigError(
            f"range = {low:g} {high:g} is not increasing.", "Give the lower end first, then the upper one."
        )
    if count < 2 and parameter != "growth.time":
        raise ConfigError(f"points = {count} is too few to scan a range.", "Give 2 or more.")
    for end in (low, high):
        if parameter != "growth.time" or end != 0.0:
            configured(config, parameter, end)
    spaced = np.geomspace if scannable.logarithmic else np.linspace
    return [low, *(float(value) for value in spaced(low, high, count)[1:-1]), high]


def _pair(given: object) -> Range:
    """Both ends of a range, given as a pair or an array of two."""
    ends = native(given)
    if not isinstance(ends, list | tuple) or len(ends) != 2:
        raise ConfigError(
            f"range = {str(given)[:60]} is not a pair.", "Give the lower end first, then the upper one."
        )
    return real_number("range", ends[0]), real_number("range", ends[1])
