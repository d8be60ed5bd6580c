"""Every quantity that a run comes to, once: its key in files, type, unit, label, and where it is shown.

Summary, CSV, Parquet, report, notebook, table and the documentation read this list. A quantity of a state is
one function of a `gyrify.metrics.deformed.Deformed` and one entry in `MEASURED`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal

from gyrify.metrics.deformed import Deformed
from gyrify.metrics.sharpness import fold_sharpness

if TYPE_CHECKING:
    from gyrify.metrics.measure_surface import DeformedSurface

# "run" and "notebook": what a run came to, in its report and in a notebook; "study": columns of a study's
# report; "table": what `gyrify table` prints by itself; "converge": what `gyrify converge` compares.
Place = Literal["run", "notebook", "study", "table", "converge"]


@dataclass(frozen=True)
class Quantity:
    """A quantity.

    Attributes
    ----------
    path : str
        Its place in ``summary.json``, with dots: ``"sulcal_depth_mm.max"``.
    type : type
        int, float, bool or str.
    unit : str
        Unit; "1" for pure numbers and counts, empty for words.
    label : str
        What people call it, without the unit.
    decimals : int, optional
        Digits after the point where it is shown; as needed if there are none.
    about : str
        What it is, in one sentence.
    shown : frozenset of str
        Where it is shown.
    measure : callable, optional
        What measures it of a state.
    name : str
        What `gyrify.metrics.Measures` calls it; by default its key.
    in_results : bool
        Whether ``results.parquet`` always has it as a column.
    leads : bool
        Whether it comes first where quantities are shown.
    least : float
        Size below which errors are relative to this instead of the value, in a body as large as the standard
        slice.
    in_space : callable, optional
        What measures it of a state of a body in space.
    of_n_dim : int, optional
        Of what is known of a run: 2 or 3 where only a body in the plane, or in space, has it.
    """

    path: str
    type: type
    unit: str = ""
    label: str = ""
    decimals: int | None = None
    about: str = ""
    shown: frozenset[Place] = frozenset()
    measure: Callable[[Deformed], float | int | bool] | None = None
    name: str = ""
    in_results: bool = True
    leads: bool = False
    least: float = 0.0
    in_space: Callable[[DeformedSurface], float | int | bool | None] | None = None
    of_n_dim: int | None = None

    def measured_by(self, n_dim: int) -> Callable[[Any], float | int | bool | None] | None:
        """What measures it in the plane (2) or in space (3); None where nothing does."""
        return self.measure if n_dim == 2 else self.in_space

    def is_known_in(self, n_dim: int) -> bool:
        """Whether a body in the plane (2), or in space (3), has it."""
        if self.is_measured:
            return self.measured_by(n_dim) is not None
        return self.of_n_dim in (None, n_dim)

    @property
    def is_measured(self) -> bool:
        """Whether it is measured of a state; others are known of the run."""
        return self.measure is not None or self.in_space is not None

    @property
    def key(self) -> str:
        """Its name in ``metrics.csv`` and ``results.parquet``."""
        return self.path.replace(".", "_")

    @property
    def attribute(self) -> str:
        """Its name in `gyrify.metrics.Measures`."""
        return self.name or self.key

    @property
    def axis(self) -> str:
        """Its label with the unit, as on an axis or above a column."""
        return f"{self.label} [{self.unit}]" if self.unit not in ("", "1", "growth time") else self.label


def _in(*places: Place) -> frozenset[Place]:
    return frozenset(places)


def _exposed_index(shape: Deformed) -> float:
    return shape.length / shape.exposed_length if shape.exposed_length > 0 else math.inf


_EVERYWHERE: Final = _in("run", "notebook", "study", "table", "converge")
MEASURED: Final[list[Quantity]] = [
    Quantity(
        "gi.hull", float, "1", "GI, hull", 3, "Contour over the perimeter of the convex hull",
        _EVERYWHERE - {"table"}, lambda s: s.length / s.hull_length,
    ),
    Quantity(
        "gi.closing", float, "1", "GI, closing", 3, "Contour over the outline of the closing",
        _EVERYWHERE, lambda s: s.length / s.closed_length, leads=True,
    ),
    Quantity(
        "gi.closing_radius_mm", float, "mm", "closing radius", about="Radius of the disc that closes sulci",
        measure=lambda s: float(s.closing_radius), name="closing_radius",
        in_space=lambda s: float(s.closing_radius),
    ),
    Quantity(
        "gi.exposed", float, "1", "GI, exposed", 3, "Contour over the part of it on the closing's outline",
        _in("run", "notebook", "converge"), _exposed_index,
    ),
    Quantity(
        "n_gyri", int, "1", "gyri", None, "Maxima of the normal displacement from the smooth contour",
        _EVERYWHERE, lambda s: s.folds.n_gyri, in_space=lambda s: int(s.folds.crowns.size),
    ),
    Quantity(
        "sulcal_depth_mm.max", float, "mm", "deepest sulcus", 2,
        "Distance of the deepest fundus to the closing's outline", _EVERYWHERE,
        lambda s: float(s.depth.max()), "sulcal_depth_max", least=0.1,
        in_space=lambda s: float(s.depth.max()),
    ),
    Quantity(
        "sulcal_depth_mm.mean", float, "mm", "mean sulcal depth", 2,
        "Mean distance of the fundi to the closing's outline", _in("notebook", "converge"),
        lambda s: float(s.depth.mean()), "sulcal_depth_mean", least=0.1,
        in_space=lambda s: float(s.fundus_depth.mean()),
    ),
    Quantity(
        "thickness_mm.crown", float, "mm", "cortex at crowns", 2, "Mean shortest distance to the interface",
        _in("run", "notebook", "study"), lambda s: s.thickness[0], "thickness_crown",
        in_space=lambda s: s.thickness[0],
    ),
    Quantity(
        "thickness_mm.fundus", float, "mm", "cortex at fundi", 2, "Mean shortest distance to the interface",
        _in("run", "notebook", "study"), lambda s: s.thickness[1], "thickness_fundus",
        in_space=lambda s: s.thickness[1],
    ),
    Quantity(
        "gyrus_width_mm", float, "mm", "width of gyri", 2, "Mean chord across a gyrus at half its height",
        _in("run", "notebook", "study"), lambda s: s.gyri.mean_width, "gyrus_width",
    ),
    Quantity(
        "gyrus_flatness", float, "1", "flatness of gyri", 2,
        "Mean chord at three quarters of a gyrus' height over that between its fundi",
        _in("run", "notebook", "study"), lambda s: s.gyri.mean_flatness,
    ),
    Quantity(
        "fold_sharpness", float, "1", "sharpness of sulci", 2, "Turning at fundi over that at crowns",
        _in("run", "notebook", "study"), lambda s: fold_sharpness(s.folds, closed=s.is_closed),
    ),
    Quantity(
        "contour_length_mm", float, "mm", "contour", 1, "Length of the contour", _in("notebook"),
        lambda s: s.length, "contour_length",
    ),
    Quantity(
        "min_gap_mm", float, "mm", "smallest gap of the contour", None,
        "Smallest distance between pieces of the contour that are no neighbours",
        measure=lambda s: s.gap, name="min_gap", in_space=lambda s: s.gap,
    ),
    Quantity(
        "self_intersecting", bool, "", "crosses itself", None, "Whether the contour crosses itself",
        measure=lambda s: s.crosses_itself, in_space=lambda s: s.crosses_itself,
    ),
    Quantity(
        "gi.area.hull", float, "1", "GI by area, hull", 3, "Surface over the area of the convex hull",
        _EVERYWHERE - {"table"}, in_results=False, in_space=lambda s: s.area / s.hull_area,
    ),
    Quantity(
        "gi.area.closing", float, "1", "GI by area, closing", 3, "Surface over the outline of the closing",
        _EVERYWHERE, in_results=False, leads=True, in_space=lambda s: s.area / s.closing.area,
    ),
    Quantity(
        "gi.sections", float, "1", "GI of sections", 3, "Mean index by the closing of sections across x",
        _in("run", "notebook", "converge"), in_results=False, in_space=lambda s: s.section_index,
    ),
    Quantity(
        "surface_area_mm2", float, "mm²", "outer surface", 0, "Area of the outer surface",
        _in("run", "notebook"), name="surface_area", in_results=False, in_space=lambda s: s.area,
    ),
    Quantity(
        "volume_mm3", float, "mm³", "volume", 0, "Within the outer surface",
        _in("notebook"), name="volume", in_results=False, in_space=lambda s: s.volume,
    ),
    Quantity(
        "mean_curvature", float, "1/mm", "mean curvature", 3, "Mean of the absolute mean curvature",
        _in("notebook"), in_results=False, in_space=lambda s: s.mean_curvature,
    ),
    Quantity(
        "wavelength_mm", float, "mm", "wavelength", 1, "Of the height above the smoothed surface",
        _in("run", "notebook"), name="wavelength", in_results=False, in_space=lambda s: s.wavelength,
    ),
]  # fmt: skip

_AFTER: Final = [
    Quantity("min_J", float, "1", "smallest J", None, "Smallest volume ratio over the whole of all cells"),
    Quantity("min_J_elastic", float, "1", "smallest elastic J", None, "The same of the elastic deformation"),
    Quantity("nodes_per_wavelength", float, "1", "contour nodes per fold"),
    Quantity(
        "onset.growth_time", float, "growth time", "stability lost at time", 1,
        "Growth time at which the slice lost stability", _in("run", "study", "table", "converge"),
    ),
    Quantity("onset.kind", str),
    Quantity("onset.mode_number", int, "1"),
    Quantity("onset.wavelength_mm", float, "mm"),
    Quantity("onset.eigenvalue", float, "Pa/mm²"),
    Quantity("onset.visible_delay", float, "growth time"),
    Quantity("visible_growth_time", float, "growth time", "folds visible", 1, shown=_in("converge")),
    Quantity(
        "elastic_energy_mJ_per_mm", float, "mJ/mm", "elastic energy", 3, shown=_in("converge"),
        in_results=False, of_n_dim=2,
    ),
    Quantity(
        "elastic_energy_mJ", float, "mJ", "elastic energy", 3, shown=_in("converge"), in_results=False,
        of_n_dim=3,
    ),
    Quantity("relaxed.gi_closing", float, "1"),
    Quantity("relaxed.n_gyri", int, "1"),
    Quantity("relaxed.moved_mm", float, "mm"),
    Quantity("relaxed.is_kept", bool),
    Quantity("stable", bool),
    Quantity("stability_note", str),
    Quantity("expected.growth_time", float, "growth time"),
    Quantity("expected.mode_number", int, "1"),
    Quantity("expected.wavelength_mm", float, "mm"),
    Quantity("converged.error", float, "1"),
    Quantity("converged.limit", float, "1", in_results=False),
    Quantity("warnings", str),
    Quantity("solver.increments", int, "1", "increments"),
    Quantity("solver.newton_iterations", int, "1", "Newton iterations"),
    Quantity("solver.factorizations", int, "1", "factorisations"),
    Quantity("solver.analyses", int, "1", "symbolic analyses"),
    Quantity("solver.rejected", int, "1", "rejected increments"),
    Quantity("solver.residual", float, "Pa mm", "largest nodal force at the end"),
    Quantity("solver.tolerance", float, "Pa mm", "tolerance of it"),
    Quantity("solver.linear_solver", str, label="linear solver"),
    Quantity("solver.contact_library", str, label="contact by"),
    Quantity("solver.wall_s", float, "s", "time spent", 1, in_results=False),
    Quantity("wall_s", float, "s", "time spent", 1, shown=_in("study"), in_results=False),
    Quantity("phenotype", str),
    Quantity("phenotype_rule", str),
]  # fmt: skip


def measured_in(n_dim: int) -> list[Quantity]:
    """Quantities of a state in the plane (2) or in space (3)."""
    return [quantity for quantity in MEASURED if quantity.measured_by(n_dim) is not None]


def quantities() -> Iterator[Quantity]:
    """Every quantity, in the order of the files."""
    yield Quantity("growth_time", float, "growth time", "growth time")
    yield Quantity("growth_fraction", float, "1", in_results=False)
    yield from MEASURED
    yield from _AFTER


def by_key() -> dict[str, Quantity]:
    """Every quantity by its key."""
    return {quantity.key: quantity for quantity in quantities()}


def shown_in(place: Place, n_dim: int = 2) -> list[Quantity]:
    """What is shown in a place of a body in the plane (2) or in space (3), in order."""
    found = [q for q in quantities() if place in q.shown and q.is_known_in(n_dim)]
    return sorted(found, key=lambda quantity: not quantity.leads)


def flat(nested: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Nested mappings as one, their keys joined with ``_``, as in ``metrics.csv``."""
    found: dict[str, Any] = {}
    for key, value in nested.items():
        inner = flat(value, f"{prefix}{key}_") if isinstance(value, Mapping) else {f"{prefix}{key}": value}
        found |= inner
    return found
