"""Fields as colours: unit, colour map and common limits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from gyrify.config.run_sections import OutputField
from gyrify.report.drawn_slice import DrawnSlice, FloatArray
from gyrify.report.layout import COLOURS, FONT
from gyrify.report.plot.style import POINTS, add_axes, style_ticks

# Share of the values beyond either end of a colour scale, so that a few cells do not take all contrast [%].
_BEYOND: Final = 1.0


@dataclass(frozen=True)
class Paint:
    """How a field is coloured.

    Attributes
    ----------
    label : str
        Name with unit.
    colours : str
        Colour map of matplotlib: perceptually uniform, or diverging about ``centre``; safe for all eyes.
    factor : float
        From the stored unit to that of the label.
    centre : float or None
        Value at the middle of a diverging map.
    """

    label: str
    colours: str = "viridis"
    factor: float = 1.0
    centre: float | None = None


PAINTS: Final[dict[OutputField, Paint]] = {
    "von_mises": Paint("von Mises stress [kPa]", factor=1e-3),
    "mean_stress": Paint("mean stress [kPa]", "RdBu_r", 1e-3, 0.0),
    "circumferential_stress": Paint("circumferential stress [kPa]", "RdBu_r", 1e-3, 0.0),
    "growth_stretch": Paint("growth stretch [–]", "cividis"),
    "J": Paint("volume ratio J [–]", "cividis"),
    "J_elastic": Paint("elastic volume ratio [–]", "PuOr_r", 1.0, 1.0),
    "thickness": Paint("cortical thickness [mm]", "viridis"),
}


def common_scale(paint: Paint, values: Sequence[FloatArray], beyond: float = _BEYOND) -> Normalize:
    """One colour scale for all panels: from percentile to percentile, symmetric about a centre."""
    everything = np.concatenate([array[np.isfinite(array)] for array in values])
    low, high = (float(end) for end in np.percentile(everything, [beyond, 100.0 - beyond]))
    if paint.centre is not None:
        reach = max(high - paint.centre, paint.centre - low)
        low, high = paint.centre - reach, paint.centre + reach
    if high - low < 1e-9 * max(abs(low), abs(high), 1e-12):  # a uniform field still needs a scale
        low, high = low - 0.5 * max(abs(low), 1.0), high + 0.5 * max(abs(high), 1.0)
    return Normalize(low, high)


def draw_field(
    axes: Axes, drawing: DrawnSlice, values: FloatArray, paint: Paint, scale: Normalize
) -> PolyCollection:
    """Fill each triangle with its colour; without seams, and as pixels in a file of lines."""
    corners: Any = drawing.points[drawing.cells]
    shown = PolyCollection(
        corners,
        array=values,
        cmap=paint.colours,
        norm=scale,
        edgecolors="none",
        linewidths=0,
    )
    shown.set(antialiased=False, rasterized=True)
    axes.add_collection(shown, autolim=False)
    return shown


def colour_bar(
    figure: Figure,
    box_mm: tuple[float, float, float, float],
    shown: ScalarMappable,
    label: str,
    values: FloatArray,
) -> Axes:
    """Horizontal bar with units in a box in mm; its ends are pointed where any of the values lie beyond."""
    axes = add_axes(figure, box_mm)
    low, high = shown.get_clim()
    ends = bool(np.any(values < low)), bool(np.any(values > high))
    extend = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}[
        ends
    ]
    bar = figure.colorbar(shown, cax=axes, orientation="horizontal", extend=extend, ticks=MaxNLocator(5))
    solids: Any = bar.solids
    solids.set(rasterized=True)
    bar.outline.set(linewidth=0.5, edgecolor=COLOURS["line"])
    style_ticks(axes)
    bar.set_label(label, fontsize=POINTS, labelpad=1, family=FONT, color=COLOURS["line"])
    return axes
