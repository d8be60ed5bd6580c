"""What is measured of one state, and how it is named in files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from gyrify.markup import html_rows


@dataclass(frozen=True, repr=False)
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
    gyrus_width : float
        Mean width of the gyri at half their height [mm]; 0 without folds.
    gyrus_flatness : float
        Mean flatness of the gyri [-], see `gyrify.metrics.gyrus_shapes`; 0 without folds.
    fold_sharpness : float
        Turning at fundi over that at crowns [-], see `gyrify.metrics.fold_sharpness`; 1 without folds.
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
    gyrus_width: float
    gyrus_flatness: float
    fold_sharpness: float
    contour_length: float
    min_gap: float
    self_intersecting: bool

    def __repr__(self) -> str:
        gyri = f"{self.n_gyri} {'gyrus' if self.n_gyri == 1 else 'gyri'}"
        return (
            f"Measures(GI {self.gi_closing:.3f} (closing of {self.closing_radius:g} mm), {self.gi_hull:.3f} "
            f"(hull), {self.gi_exposed:.3f} (exposed); {gyri}, "
            f"sulci up to {self.sulcal_depth_max:.2f} mm deep, "
            f"cortex {self.thickness_crown:.2f} mm at crowns and {self.thickness_fundus:.2f} mm at fundi)"
        )

    def _repr_html_(self) -> str:
        return html_rows("Measures", ((name, _shown(value)) for name, value in self.flat().items()))

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
            "gyrus_width_mm": self.gyrus_width,
            "gyrus_flatness": self.gyrus_flatness,
            "fold_sharpness": self.fold_sharpness,
            "contour_length_mm": self.contour_length,
            "min_gap_mm": self.min_gap,
            "self_intersecting": self.self_intersecting,
        }

    def flat(self) -> dict[str, Any]:
        """Return the metrics named as in ``metrics.csv``: the keys of `as_dict` joined with ``_``."""
        return _flatten(self.as_dict())


def _flatten(nested: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Return nested mappings as one, their keys joined with ``_``."""
    flat: dict[str, Any] = {}
    for key, value in nested.items():
        flat |= (
            _flatten(value, f"{prefix}{key}_") if isinstance(value, Mapping) else {f"{prefix}{key}": value}
        )
    return flat


def _shown(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
