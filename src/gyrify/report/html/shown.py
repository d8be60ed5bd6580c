"""The fields that a report shows: names, units and colours, and the colours' ranges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np

from gyrify.config.run_sections import OutputField
from gyrify.solve.types import FloatArray
from gyrify.store.fields import UNITS

# Colours run between these quantiles, so that cells and points in cusps do not wash out the others.
_OUTER: Final = 0.02
# A state that is nearly uniform is coloured over at least this part of the range of the whole run.
_NARROWEST: Final = 1e-3


@dataclass(frozen=True)
class ShownField:
    """A field of the report.

    Attributes
    ----------
    name : str
        As in `gyrify.store.fields`.
    label : str
        For people.
    place : {"cell", "contour"}
        Whether it has a value per cell or per point of the contour.
    colours : {"sequential", "diverging"}
        Diverging colours are for signed fields, with zero in the middle.
    about : str
        What it is, in one sentence.
    """

    name: OutputField
    label: str
    place: Literal["cell", "contour"]
    colours: Literal["sequential", "diverging"]
    about: str

    @property
    def unit(self) -> str:
        """Unit; empty for a pure number."""
        return UNITS[self.name].replace("-", "").replace("1/mm", "mm⁻¹").replace("Pa mm", "Pa·mm")


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
    ),
    ShownField(
        "contact_force",
        "contact force",
        "contour",
        "sequential",
        "Size of the force of self-contact on each point.",
    ),
)


def chosen(names: Sequence[OutputField]) -> tuple[ShownField, ...]:
    """The shown fields of these names, in their order on the page."""
    return tuple(field for field in SHOWN if field.name in names)


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
        With ``ranges`` [low, high] of the colours of each frame, and ``range``, which covers them all.
    """
    ranges = [colour_range(row, field.colours) for row in values]
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
        "ranges": [_widened(ends, least) for ends in ranges],
    }


def colour_range(values: FloatArray, colours: str) -> list[float]:
    """Ends of the colours of one state: outer quantiles; for signed fields as far on both sides of zero."""
    finite = values[np.isfinite(values)]
    if finite.size == 0:
        return [0.0, 0.0]
    if colours == "diverging":
        end = float(np.quantile(np.abs(finite), 1.0 - 2.0 * _OUTER))
        return [-end, end]
    low, high = (float(end) for end in np.quantile(finite, (_OUTER, 1.0 - _OUTER)))
    if high > low:
        return [low, high]
    # Nearly everywhere one value (hardly any contact yet, say): show what there is.
    return [float(finite.min()), float(finite.max())]


def _widened(ends: list[float], least: float) -> list[float]:
    """At least so wide, about the same middle; a range without any width becomes 1 wide."""
    middle, half = 0.5 * (ends[0] + ends[1]), 0.5 * max(ends[1] - ends[0], least)
    return [middle - half, middle + half] if half > 0.0 else [middle - 0.5, middle + 0.5]
