"""What is measured of one state, and how it is named in files."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from gyrify.base.markup import html_rows
from gyrify.metrics.deformed import Deformed
from gyrify.metrics.quantities import flat, measured_in

if TYPE_CHECKING:
    from gyrify.metrics.measure_surface import DeformedSurface


class Measures:
    """Metrics of one deformed state; lengths in mm.

    Each quantity in `gyrify.metrics.quantities` that has a meaning in the plane, or in space, is one.

    Parameters
    ----------
    **values
        A value for each quantity of a state, by the name of its attribute.

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
    gi_area_hull, gi_area_closing : float
        In space, area of the outer surface over that of the hull, and of the closing's outline [-].
    gi_sections : float or None
        In space, mean index by the closing of sections across x; None for a patch [-].
    surface_area : float
        In space, area of the outer surface [mm^2].
    volume : float or None
        In space, volume within it [mm^3].
    mean_curvature : float
        In space, mean of the absolute mean curvature [1/mm].
    wavelength : float
        In space, length of the wave that varies as the height above the smoothed surface does [mm]; 0 without
        folds.
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
    gi_area_hull: float
    gi_area_closing: float
    gi_sections: float | None
    surface_area: float
    volume: float | None
    mean_curvature: float
    wavelength: float

    def __init__(self, **values: Any) -> None:
        sets = ([quantity.attribute for quantity in measured_in(n_dim)] for n_dim in (2, 3))
        names = min(sets, key=lambda names: len(set(values) ^ set(names)))
        if set(values) != set(names):
            wrong = ", ".join(sorted(set(values) ^ set(names)))
            raise TypeError(f"Measures takes one value for each quantity; missing or unknown: {wrong}")
        self.__dict__.update({name: values[name] for name in names})

    @classmethod
    def of(cls, shape: Deformed | DeformedSurface) -> Measures:
        """Every quantity of a state.

        Parameters
        ----------
        shape : Deformed or DeformedSurface
            What is measured.

        Returns
        -------
        Measures
        """
        found = {}
        n_dim = getattr(shape, "n_dim", 2)
        for quantity in measured_in(n_dim):
            measure = quantity.measured_by(n_dim)
            if measure is not None:
                found[quantity.attribute] = measure(shape)
        return cls(**found)

    @property
    def n_dim(self) -> int:
        """Whether they are of a contour in the plane (2) or of a surface in space (3)."""
        return 2 if "gi_closing" in self.__dict__ else 3

    @property
    def index(self) -> float:
        """The index by the closing: of lengths in the plane, of areas in space [-]."""
        return self.gi_closing if self.n_dim == 2 else self.gi_area_closing

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"Measures cannot be changed: {name}")

    def __iter__(self) -> Iterator[tuple[str, Any]]:
        return iter(self.__dict__.items())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Measures) and self.__dict__ == other.__dict__

    def __hash__(self) -> int:
        return hash(tuple(self.__dict__.items()))

    def __repr__(self) -> str:
        gyri = f"{self.n_gyri} {'gyrus' if self.n_gyri == 1 else 'gyri'}"
        if self.n_dim == 3:
            return (
                f"Measures(GI by area {self.gi_area_closing:.3f} (closing of {self.closing_radius:g} mm), "
                f"{self.gi_area_hull:.3f} (hull); {gyri}, sulci up to {self.sulcal_depth_max:.2f} mm deep, "
                f"cortex {self.thickness_crown:.2f} mm at crowns and {self.thickness_fundus:.2f} mm at fundi)"
            )
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
        nested: dict[str, Any] = {}
        for quantity in measured_in(self.n_dim):
            *groups, name = quantity.path.split(".")
            table = nested
            for group in groups:
                table = table.setdefault(group, {})
            table[name] = self.__dict__[quantity.attribute]
        return nested

    def flat(self) -> dict[str, Any]:
        """Return the metrics named as in ``metrics.csv``: the keys of `as_dict` joined with ``_``."""
        return flat(self.as_dict())


def _shown(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
