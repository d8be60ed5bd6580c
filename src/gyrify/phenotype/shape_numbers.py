"""The dimensionless numbers that phenotypes are told by."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from gyrify.config import Config
from gyrify.errors import ConfigError
from gyrify.metrics import Measures

_NEEDED = (
    "gi_hull",
    "gi_closing",
    "n_gyri",
    "sulcal_depth_mm_mean",
    "contour_length_mm",
    "gyrus_width_mm",
    "gyrus_flatness",
    "thickness_mm_crown",
    "thickness_mm_fundus",
)


# In space the number of gyri is that of a surface, not of a slice, and a gyrus has no chord.
_NEEDED_IN_SPACE = ("gi_area_hull", "sulcal_depth_mm_mean", "thickness_mm_crown", "thickness_mm_fundus")


def grown_thickness(config: Config) -> float:
    """Thickness of the cortex at the end of growth if nothing held it back [mm].

    Parameters
    ----------
    config : Config
        The run.

    Returns
    -------
    float
        T (1 + G Δt) or T exp(G Δt); T where growth is tangential.
    """
    growth, thickness = config.growth, config.geometry.cortical_thickness
    if growth.is_tangential:
        return thickness
    increase = growth.rate * growth.duration
    return thickness * (math.exp(increase) if growth.stretch == "exponential" else 1.0 + increase)


def shape_numbers(
    metrics: Measures | Mapping[str, Any], thickness: float, normal_gyri: int
) -> dict[str, float]:
    """Dimensionless numbers of a folded shape; see ``rules.toml`` for what each means.

    Parameters
    ----------
    metrics : Measures or mapping
        Metrics of a state, or a row with the names of ``metrics.csv`` (lengths in mm).
    thickness : float
        Grown cortical thickness [mm], > 0.
    normal_gyri : int
        Number of gyri of the normal slice.

    Returns
    -------
    dict
        ``hull``, ``depth``, ``gyri``, ``spacing``, ``breadth``, ``flatness`` and ``crown_fundus`` [-].
        Without gyri the spacing is the whole outline. Of a body in space, ``hull`` (of areas), ``depth`` and
        ``crown_fundus`` alone.

    Raises
    ------
    ConfigError
        If a metric is missing, not finite or out of range.
    """
    row = metrics.flat() if isinstance(metrics, Measures) else metrics
    is_in_space = row.get("gi_area_hull") is not None
    value = {name: _metric(row, name) for name in (_NEEDED_IN_SPACE if is_in_space else _NEEDED)}
    thickness = _positive("thickness", thickness)
    numbers = {
        "hull": value["gi_area_hull" if is_in_space else "gi_hull"],
        "depth": value["sulcal_depth_mm_mean"] / thickness,
        "crown_fundus": value["thickness_mm_crown"] / _positive("fundus", value["thickness_mm_fundus"]),
    }
    if is_in_space:
        return numbers
    outline = _positive("contour_length_mm", value["contour_length_mm"]) / _positive(
        "gi", value["gi_closing"]
    )
    gyri = value["n_gyri"]
    return {
        "hull": numbers["hull"],
        "depth": numbers["depth"],
        "gyri": gyri / normal_gyri,
        "spacing": outline / max(gyri, 1.0) / thickness,
        "breadth": value["gyrus_width_mm"] * normal_gyri / outline,
        "flatness": value["gyrus_flatness"],
        "crown_fundus": numbers["crown_fundus"],
    }


def _metric(row: Mapping[str, Any], name: str) -> float:
    found = row.get(name)
    if found is None or not math.isfinite(found) or found < 0:
        raise ConfigError(
            f"{name} = {found} is not a metric of a folded shape: it must be a finite number >= 0.",
            "Pass the metrics of a completed run.",
        )
    return float(found)


def _positive(name: str, value: float) -> float:
    if not (math.isfinite(value) and value > 0):
        raise ConfigError(f"{name} = {value} is out of range: it must be > 0.", f"Give {name} in mm.")
    return value
