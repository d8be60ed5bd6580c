"""Pages of pictures: bare axes in mm under a header, with a scale bar and a legend below."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

FONT: Final = "DejaVu Sans"
# Tissues differ in lightness, the outline in hue as well (Okabe-Ito): all eyes tell them apart, in print too.
COLOURS: Final = {"grey": "#a39c97", "white": "#f3eee3", "line": "#1f1f1f", "outline": "#d55e00"}
OUTLINE: Final[dict[str, Any]] = {
    "color": COLOURS["outline"],
    "linewidth": 1.0,
    "linestyle": (0, (3, 1.5)),
}
MM: Final = 1 / 25.4
MARGIN_MM: Final = 3.0
FOOTER_MM: Final = 13.0
LINE_MM: Final = 4.6
CHARACTERS_PER_MM: Final = 0.5


def page(low: FloatArray, high: FloatArray, width_mm: float, header_mm: float) -> tuple[Figure, Axes]:
    """Return a figure as high as the slice needs, with bare axes in mm between a header and a footer."""
    span = high - low
    inside = width_mm - 2 * MARGIN_MM
    tall = inside * float(span[1] / span[0])
    height_mm = header_mm + tall + FOOTER_MM
    figure = Figure(figsize=(width_mm * MM, height_mm * MM), facecolor="white")
    FigureCanvasAgg(figure)
    box = (MARGIN_MM / width_mm, FOOTER_MM / height_mm, inside / width_mm, tall / height_mm)
    axes = figure.add_axes(box)
    axes.set_axis_off()
    pad = 0.01 * span
    axes.set(
        xlim=(low[0] - pad[0], high[0] + pad[0]), ylim=(low[1] - pad[1], high[1] + pad[1]), aspect="equal"
    )
    return figure, axes


def line(line: FloatArray, **style: Any) -> Line2D:
    """Return a line through vertices."""
    return Line2D(line[:, 0], line[:, 1], solid_joinstyle="round", **style)


def header(title: str, text: str, width_mm: float) -> list[tuple[str, int, str]]:
    """Return the lines above the picture with size and weight, the title wrapped to the width."""
    lines = [(line, 9, "bold") for line in textwrap.wrap(title, int(CHARACTERS_PER_MM * width_mm))]
    return [*lines, (text, 8, "normal")] if text else lines


def write_header(figure: Figure, lines: list[tuple[str, int, str]]) -> None:
    """Write lines at the upper left."""
    width_mm, height_mm = figure.get_size_inches() / MM
    for number, (line, size, weight) in enumerate(lines):
        top = 1 - (2.0 + LINE_MM * number) / height_mm
        style: dict[str, Any] = {
            "fontsize": size,
            "fontweight": weight,
            "family": FONT,
            "color": COLOURS["line"],
        }
        figure.text(MARGIN_MM / width_mm, top, line, va="top", ha="left", **style)


def scale_bar(
    figure: Figure, low: FloatArray, high: FloatArray, y_mm: float = 0.56 * FOOTER_MM
) -> tuple[Line2D, Text]:
    """Draw a bar of a round length, about a fifth of the first axes, at the left of the footer."""
    length = _round_length(0.2 * float(high[0] - low[0]))
    to_pixels = figure.axes[0].transData.transform
    width_mm, height_mm = figure.get_size_inches() / MM
    start = MARGIN_MM / width_mm
    end = start + float(np.ptp(to_pixels([(0.0, 0.0), (length, 0.0)])[:, 0])) / figure.bbox.width
    y = y_mm / height_mm
    bar = Line2D([start, end], [y, y], linewidth=2.0, solid_capstyle="butt", color=COLOURS["line"])
    figure.add_artist(bar)
    style: dict[str, Any] = {"fontsize": 8, "family": FONT, "color": COLOURS["line"]}
    middle, below = 0.5 * (start + end), y - 1.2 / height_mm
    return bar, figure.text(middle, below, f"{length:g} mm", va="top", ha="center", **style)


def _round_length(wanted: float) -> float:
    """Return the largest of 1, 2, 5 times a power of ten that is not above ``wanted``."""
    power = 10.0 ** math.floor(math.log10(wanted))
    return max(step * power for step in (1, 2, 5) if step * power <= wanted * (1 + 1e-9))


def legend(
    figure: Figure, handles: Sequence[Artist], columns: int = 2, middle_mm: float = 0.5 * FOOTER_MM
) -> None:
    """Name what is drawn, at the lower right."""
    figure.legend(
        handles=list(handles),
        loc="center right",
        bbox_to_anchor=(1.0, middle_mm * MM / figure.get_figheight()),
        ncols=columns,
        frameon=False,
        prop={"family": FONT, "size": 7},
        handlelength=1.8,
        columnspacing=1.2,
        borderaxespad=0.3,
    )
