"""Growth parameters from published volumes, as Wang et al. (2019) derive them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

from gyrify.base.arguments import real_number
from gyrify.errors import ConfigError

# Lengths [mm] in whose cube volumes may be counted: a power law with a prefactor of 1 depends on it.
LENGTH_UNITS: Final = {"um": 1e-3, "mm": 1.0, "cm": 10.0, "m": 1000.0}


def growth_ratio_from_scaling(
    cortical_thickness: float = 1.5,
    *,
    area: float = 4069.0,
    aspect_ratio: float = 1.2,
    hole_fraction: float = 0.5,
    slice_thickness: float = 0.01,
    exponent: float = 1.23,
    growth: float = 1.0,
    unit: str = "mm",
) -> float:
    """Growth ratio of cortex to white matter from the scaling law of mammalian brains, Eqs 9-11.

    The law V_W = V_G^exponent, read with a prefactor of 1, is applied to the grown slice: the cortex grows to
    V_G = (1 + growth)³ · A_G · slice_thickness, the white matter to
    V_W = (1 + growth/ratio)³ · A_W · slice_thickness, and the ratio follows.

    Parameters
    ----------
    cortical_thickness : float
        Initial thickness T of the cortex [mm], > 0.
    area : float
        Area πab inside the outer ellipse [mm²], > 0.
    aspect_ratio : float
        a/b of the ellipse [-], >= 1.
    hole_fraction : float
        Size of the hole relative to the ellipse [-], in (0, 1).
    slice_thickness : float
        Thickness of the slice [mm], > 0.
    exponent : float
        Exponent of the scaling law [-], > 0.
    growth : float
        Growth rate of the cortex times the duration: its relative increase in length [-], > 0.
    unit : {"mm", "cm", "um", "m"}
        Length in whose cube the volumes are counted. A power law without a prefactor is not homogeneous, so
        the answer depends on it: 3.592 in mm³, and no solution in cm³. The published value is that in mm³.

    Returns
    -------
    float
        Growth ratio G_G/G_W [-].

    Raises
    ------
    ConfigError
        If an argument is out of range, or the law would have the white matter shrink.
    """
    slice_thickness = _require("slice_thickness", slice_thickness, "mm", _is_positive)
    exponent = _require("exponent", exponent, "-", _is_positive)
    growth = _require("growth", growth, "-", _is_positive)
    grey_area, white_area = _tissue_areas(cortical_thickness, area, aspect_ratio, hole_fraction)
    depth = slice_thickness / _length_unit(unit) ** 3
    grey, white = (1 + growth) ** 3 * grey_area * depth, white_area * depth
    white_growth = math.cbrt(math.pow(grey, exponent) / white) - 1
    if not white_growth > 0:
        raise ConfigError(
            f"unit = {unit!r} gives no growth ratio: in {unit}³ the scaling law has the white matter grow by "
            f"{white_growth:.3g}, and it must be > 0.",
            "The law holds in one unit alone: it was published with mm³.",
        )
    return growth / white_growth


def _length_unit(unit: str) -> float:
    """Return a unit of length in mm."""
    if unit not in LENGTH_UNITS:
        known = ", ".join(LENGTH_UNITS)
        raise ConfigError(f"unit = {unit!r} is not a unit of length.", f"Choose one of {known}.")
    return LENGTH_UNITS[unit]


def _tissue_areas(
    cortical_thickness: float, area: float, aspect_ratio: float, hole_fraction: float
) -> tuple[float, float]:
    """Return the initial areas [mm²] of grey and white matter of the hollow elliptic slice."""
    area = _require("area", area, "mm²", _is_positive)
    aspect_ratio = _require("aspect_ratio", aspect_ratio, "-", lambda value: value >= 1, ">= 1")
    hole_fraction = _require(
        "hole_fraction", hole_fraction, "-", lambda value: 0 < value < 1, "between 0 and 1"
    )
    b = math.sqrt(area / (math.pi * aspect_ratio))
    a = aspect_ratio * b
    widest = b * (1 - hole_fraction)
    allowed = f"between 0 and {widest:.3g}"
    cortical_thickness = _require(
        "cortical_thickness", cortical_thickness, "mm", lambda value: 0 < value < widest, allowed
    )
    interface = math.pi * (a - cortical_thickness) * (b - cortical_thickness)
    return area - interface, interface - hole_fraction**2 * area


def growth_ratio_from_volumes(grey_increase: float = 4.6, white_increase: float = 1.9) -> float:
    """Growth ratio from how much the volumes of grey and white matter increase, both growing isotropically.

    Parameters
    ----------
    grey_increase, white_increase : float
        Volume at the end over volume at the start [-], > 1; by default from 30 to 40 weeks of gestation.

    Returns
    -------
    float
        (grey_increase^⅓ - 1) / (white_increase^⅓ - 1) [-]; 2.78 by default.

    Raises
    ------
    ConfigError
        If a volume does not increase.
    """
    grey_increase = _require("grey_increase", grey_increase, "-", lambda value: value > 1, "> 1")
    white_increase = _require("white_increase", white_increase, "-", lambda value: value > 1, "> 1")
    return (math.cbrt(grey_increase) - 1) / (math.cbrt(white_increase) - 1)


def length_increase(initial_volume: float = 60.0, final_volume: float = 1200.0) -> float:
    """Relative increase in length of a body that grows isotropically from one volume to another.

    Parameters
    ----------
    initial_volume, final_volume : float
        Volumes in the same unit, > 0; by default those of the brain at 22 weeks and of the adult [ml].

    Returns
    -------
    float
        (final/initial)^⅓ - 1 [-]: by default a 1.71-fold increase, to 2.71 times the length.

    Raises
    ------
    ConfigError
        If a volume is not positive.
    """
    initial_volume = _require("initial_volume", initial_volume, "ml", _is_positive)
    final_volume = _require("final_volume", final_volume, "ml", _is_positive)
    return math.cbrt(final_volume / initial_volume) - 1


def _is_positive(value: float) -> bool:
    return value > 0


def _require(
    name: str, given: object, unit: str, is_in_range: Callable[[float], bool], allowed: str = "> 0"
) -> float:
    """Return a number, or raise `ConfigError` with name, value and range unless it is finite and in range."""
    value = real_number(name, given)
    if not (math.isfinite(value) and is_in_range(value)):
        raise ConfigError(
            f"{name} = {value:g} [{unit}] is out of range: it must be {allowed}.",
            f"Give {name} as a number {allowed}.",
        )
    return value
