"""All metrics of one state in one call, sharing what they have in common."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike

from gyrify.metrics.contour import (
    FloatArray,
    as_contour,
    distance_to_line,
    edge_lengths,
    filled,
    offset_outline,
    require_positive,
)
from gyrify.metrics.folds import Folds, depth_below, folds_about, require_detectable, shape_of_hull
from gyrify.metrics.gap import simple_gap
from gyrify.metrics.gyrification import closing_length, exposed_length

# Where nothing is folded the thickness is averaged over about this many points along the contour.
_SMOOTH_POINTS = 50


@dataclass(frozen=True)
class Measures:
    """Metrics of one deformed state; lengths in mm.

    Attributes
    ----------
    gi_hull, gi_closing, gi_exposed : float
        Gyrification index in its three definitions [-].
    closing_radius : float
        Radius of the closing that ``gi_closing``, ``gi_exposed`` and the depths refer to [mm].
    n_gyri : int
        Number of gyri.
    sulcal_depth_max, sulcal_depth_mean : float
        Depth of the fundi below the closing's outline [mm]; 0 without folds.
    thickness_crown, thickness_fundus : float
        Mean cortical thickness at crowns and at fundi [mm]; both the mean along the contour without folds.
    contour_length : float
        Length of the contour [mm].
    min_gap : float
        Smallest distance between non-neighbouring pieces of the contour [mm]; 0 if it crosses itself.
    self_intersecting : bool
        Whether the contour crosses itself.
    """

    gi_hull: float
    gi_closing: float
    gi_exposed: float
    closing_radius: float
    n_gyri: int
    sulcal_depth_max: float
    sulcal_depth_mean: float
    thickness_crown: float
    thickness_fundus: float
    contour_length: float
    min_gap: float
    self_intersecting: bool

    def as_dict(self) -> dict[str, Any]:
        """Return the metrics nested and named as in ``summary.json``."""
        return {
            "gi": {
                "hull": self.gi_hull,
                "closing": self.gi_closing,
                "closing_radius_mm": self.closing_radius,
                "exposed": self.gi_exposed,
            },
            "n_gyri": self.n_gyri,
            "sulcal_depth_mm": {"max": self.sulcal_depth_max, "mean": self.sulcal_depth_mean},
            "thickness_mm": {"crown": self.thickness_crown, "fundus": self.thickness_fundus},
            "contour_length_mm": self.contour_length,
            "min_gap_mm": self.min_gap,
            "self_intersecting": self.self_intersecting,
        }

    def flat(self) -> dict[str, Any]:
        """Return the metrics named as in ``metrics.csv``: the keys of `as_dict` joined with ``_``."""
        return _flatten(self.as_dict())


def measure(
    contour: ArrayLike,
    interface: ArrayLike,
    closing_radius: float = 10.0,
    gyrus_prominence: float = 0.3,
    samples: int = 2000,
) -> Measures:
    """Measure one deformed state of a ring.

    Parameters
    ----------
    contour : (n, 2) array_like
        Vertices of the closed outer contour in order [mm].
    interface : (m, 2) array_like
        Vertices of the closed grey-white interface in order [mm].
    closing_radius : float
        Radius of the morphological closing [mm], > 0.
    gyrus_prominence : float
        Smallest prominence of a gyrus [mm], > 0.
    samples : int
        Points of the arc-length resampling on which gyri are sought, at least 16.

    Returns
    -------
    Measures

    Raises
    ------
    ConfigError
        If a parameter is out of range.
    MeshError
        If the contour or the interface is malformed.
    """
    require_positive("closing_radius", closing_radius)
    require_detectable(gyrus_prominence, samples)
    vertices, inner = as_contour(contour), as_contour(interface)
    crossing = not shapely.linearrings(vertices).is_simple
    tissue = filled(vertices) if crossing else shapely.Polygon(vertices)
    offset = offset_outline(tissue, closing_radius)
    hull = tissue.convex_hull
    folds = folds_about(shape_of_hull(hull), vertices, gyrus_prominence, samples)
    depth = depth_below(folds.fundus_points, offset, closing_radius) if folds.n_gyri else np.zeros(1)
    crown, fundus = _thickness(folds, inner)
    length = float(edge_lengths(vertices).sum())
    exposed = exposed_length(tissue, closing_radius)
    return Measures(
        gi_hull=length / float(hull.length),
        gi_closing=length / closing_length(offset, closing_radius),
        gi_exposed=length / exposed if exposed > 0 else float("inf"),
        closing_radius=float(closing_radius),
        n_gyri=folds.n_gyri,
        sulcal_depth_max=float(depth.max()),
        sulcal_depth_mean=float(depth.mean()),
        thickness_crown=crown,
        thickness_fundus=fundus,
        contour_length=length,
        min_gap=0.0 if crossing else simple_gap(vertices),
        self_intersecting=crossing,
    )


def _thickness(folds: Folds, interface: FloatArray) -> tuple[float, float]:
    """Return the mean thickness at crowns and at fundi, or for both that along a contour without folds."""
    if folds.n_gyri == 0:
        every = max(1, len(folds.points) // _SMOOTH_POINTS)
        mean = float(distance_to_line(folds.points[::every], interface).mean())
        return mean, mean
    at = distance_to_line(np.concatenate([folds.crown_points, folds.fundus_points]), interface)
    return float(at[: folds.n_gyri].mean()), float(at[folds.n_gyri :].mean())


def _flatten(nested: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Return nested mappings as one, their keys joined with ``_``."""
    flat: dict[str, Any] = {}
    for key, value in nested.items():
        flat |= (
            _flatten(value, f"{prefix}{key}_") if isinstance(value, Mapping) else {f"{prefix}{key}": value}
        )
    return flat
