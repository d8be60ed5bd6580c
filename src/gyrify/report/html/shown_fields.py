"""The fields that a report shows: names, units and colours, and the colours' ranges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Final, Literal

import numpy as np

from gyrify.config.run_sections import OutputField
from gyrify.solve.types import FloatArray
from gyrify.store.fields import field_unit

# Share of the values beyond either end of the colours, so that cells and points in cusps do not wash out the
# others; `gyrify plot` has the same.
_OUTER: Final = 0.01
# A state that is nearly uniform is coloured over at least this part of the range of the whole run.
_NARROWEST: Final = 1e-3


@dataclass(frozen=True)
class ShownField:
    """A field of the report.

    Attributes
    ----------
    name : str
        As in `gyrify.store.fields`, or ``depth`` in space.
    label : str
        For people.
    place : {"cell", "contour"}
        Whether it has a value per cell or per point of the contour, in space of the outer surface.
    colours : {"sequential", "diverging"}
        Diverging colours are for signed fields, with zero in the middle.
    about : str
        What it is, in one sentence.
    outer : float
        Share of the values beyond either end of its colours. Curvature is far larger in the few points at the
        bottom of sulci than anywhere else, and would have no colour on crowns.
    n_dim : int
        Of what body it is, in the plane (2) or in space (3).
    """

    name: OutputField | Literal["depth"]
    label: str
    place: Literal["cell", "contour"]
    colours: Literal["sequential", "diverging"]
    about: str
    outer: float = _OUTER
    n_dim: int = 2

    @property
    def unit(self) -> str:
        """Unit; empty for a pure number."""
        unit = "mm" if self.name == "depth" else field_unit(self.name, self.n_dim)
        return unit.replace("-", "").replace("1/mm", "mm⁻¹").replace("Pa mm", "Pa·mm")


SHOWN: Final = (
    ShownField("growth_stretch", "growth stretch λ_g", "cell", "sequential", "Stretch by growth alone."),
    ShownField("J", "volume ratio J", "cell", "sequential", "Current over reference volume, det F."),
    ShownField(
        "von_mises", "von Mises stress", "cell", "sequential", "Size of the deviatoric Cauchy stress."
    ),
    ShownField(
        "mean_stress", "mean stress", "cell", "diverging", "A third of the trace of the Cauchy stress."
    ),
    ShownField(
        "circumferential_stress",
        "circumferential stress",
        "cell",
        "diverging",
        "Normal Cauchy stress along the layers as they lie now; negative is compression.",
    ),
    ShownField(
        "thickness",
        "cortical thickness",
        "contour",
        "sequential",
        "Shortest distance from the contour to the grey-white interface.",
    ),
    ShownField(
        "curvature",
        "curvature",
        "contour",
        "diverging",
        "Of the contour: positive at crowns, negative in sulci.",
        outer=0.15,
    ),
    ShownField(
        "contact_force",
        "contact force",
        "contour",
        "sequential",
        "Size of the force of self-contact on each point.",
    ),
)


# What is called or explained otherwise in space: label and explanation.
_IN_SPACE: Final[dict[str, tuple[str, str]]] = {
    "circumferential_stress": (
        "stress along the layers",
        "Mean normal Cauchy stress along the layers as they lie now; negative is compression.",
    ),
    "thickness": (
        "cortical thickness",
        "Shortest distance from the outer surface to the grey-white interface.",
    ),
    "curvature": (
        "mean curvature",
        "Of the outer surface: positive where it bulges outwards, negative in sulci.",
    ),
}


def _in_space(field: ShownField) -> ShownField:
    label, about = _IN_SPACE.get(field.name, (field.label, field.about))
    return replace(field, label=label, about=about, n_dim=3)


SHOWN_IN_SPACE: Final = (
    *map(_in_space, SHOWN),
    ShownField(
        "depth",
        "sulcal depth",
        "contour",
        "sequential",
        "Distance below the outline of the closing by a ball.",
        n_dim=3,
    ),
)


def chosen(names: Sequence[str], n_dim: int = 2) -> tuple[ShownField, ...]:
    """The shown fields of these names, in their order on the page."""
    return tuple(field for field in (SHOWN if n_dim == 2 else SHOWN_IN_SPACE) if field.name in names)


def scalar(values: FloatArray) -> FloatArray:
    """A field as one number each: a vector's size."""
    return values if values.ndim == 1 else np.asarray(np.linalg.norm(values, axis=1))


def describe(field: ShownField, values: FloatArray) -> dict[str, Any]:
    """What a page says of a field, and the range of its colours.

    Parameters
    ----------
    field : ShownField
        The field.
    values : (n_frames, n) float array
        Its values.

    Returns
    -------
    dict
        With ``ranges`` [low, high] of the colours of each frame, ``range``, which covers them all, and
        ``extremes``, the least and the greatest value of each frame.
    """
    ranges = [colour_range(row, field.colours, field.outer) for row in values]
    whole = _widened([min(low for low, _ in ranges), max(high for _, high in ranges)], 0.0)
    least = _NARROWEST * (whole[1] - whole[0])
    return {
        "name": field.name,
        "label": field.label,
        "unit": field.unit,
        "place": field.place,
        "colours": field.colours,
        "about": field.about,
        "range": whole,
        "extremes": [_extremes(row) for row in values],
        "ranges": [_widened(ends, least) for ends in ranges],
    }


def colour_range(values: FloatArray, colours: str, outer: float = _OUTER) -> list[float]:
    """Ends of the colours of one state: outer quantiles; for signed fields as far on both sides of zero."""
    finite = values[np.isfinite(values)]
    if finite.size == 0:
        return [0.0, 0.0]
    low, high = (float(end) for end in np.quantile(finite, (outer, 1.0 - outer)))
    if colours == "diverging":
        end = max(-low, high)
        return [-end, end]
    if high > low:
        return [low, high]
    # Nearly everywhere one value (hardly any contact yet, say): show what there is.
    return [float(finite.min()), float(finite.max())]


def _extremes(values: FloatArray) -> list[float]:
    """Least and greatest value; 0 where none is defined."""
    finite = values[np.isfinite(values)]
    return [float(finite.min()), float(finite.max())] if finite.size else [0.0, 0.0]


def _widened(ends: list[float], least: float) -> list[float]:
    """At least so wide, about the same middle; a range without any width becomes 1 wide."""
    middle, half = 0.5 * (ends[0] + ends[1]), 0.5 * max(ends[1] - ends[0], least)
    return [middle - half, middle + half] if half > 0.0 else [middle - 0.5, middle + 0.5]
