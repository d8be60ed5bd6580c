"""Journal style: sizes in mm, 8 pt type, panel letters, and colours that all eyes tell apart."""

from __future__ import annotations

from typing import Any, Final

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from gyrify.report.layout import COLOURS, FONT, MM

# One and two columns of most journals [mm].
SINGLE: Final = 90.0
DOUBLE: Final = 180.0
POINTS: Final = 8
SMALL_POINTS: Final = 7
# Okabe and Ito's colours, dark ones first; line styles tell curves apart in grey, too.
HUES: Final = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000", "#E69F00", "#56B4E9", "#8C6D1F")
DASHES: Final = (
    "-",
    (0, (5, 1.5)),
    (0, (1, 1.2)),
    (0, (5, 1.2, 1, 1.2)),
    "-",
    "-",
    (0, (5, 1.5)),
    (0, (1, 1.2)),
)
TIME_LABEL: Final = "growth time [model units]"
_TEXT: Final[dict[str, Any]] = {"family": FONT, "color": COLOURS["line"]}


def new_figure(width_mm: float, height_mm: float) -> Figure:
    """Empty white page with a canvas of its own."""
    figure = Figure(figsize=(width_mm * MM, height_mm * MM), facecolor="white")
    FigureCanvasAgg(figure)
    return figure


def add_axes(figure: Figure, box_mm: tuple[float, float, float, float], share: Axes | None = None) -> Axes:
    """Axes in a box (left, bottom, width, height) in mm."""
    width, height = figure.get_size_inches() / MM
    left, bottom, wide, tall = box_mm
    return figure.add_axes((left / width, bottom / height, wide / width, tall / height), sharex=share)


def style_axes(axes: Axes, x_label: str, y_label: str) -> None:
    """Axes of a curve: open frame, labels with units, 8 pt."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set(linewidth=0.6, color=COLOURS["line"])
    style_ticks(axes)
    axes.set_xlabel(x_label, fontsize=POINTS, labelpad=2, **_TEXT)
    axes.set_ylabel(y_label, fontsize=POINTS, labelpad=3, **_TEXT)


def style_ticks(axes: Axes) -> None:
    """Ticks of 8 pt, set on the axes, so that they do not depend on who saves the figure."""
    axes.tick_params(
        labelsize=POINTS,
        labelfontfamily=FONT,
        labelcolor=COLOURS["line"],
        color=COLOURS["line"],
        width=0.6,
        length=2.5,
        pad=2,
    )


def write(figure: Figure, x_mm: float, y_mm: float, text: str, **style: Any) -> None:
    """Write a line with its upper left corner at a place in mm; dollars are dollars."""
    width, height = figure.get_size_inches() / MM
    look = {"fontsize": POINTS, "va": "top", "ha": "left", **_TEXT, **style}
    figure.text(x_mm / width, y_mm / height, literal(text), **look)


def letter(figure: Figure, number: int, x_mm: float, y_mm: float) -> None:
    """Write the bold letter of a panel with its upper left corner at a place in mm."""
    write(figure, x_mm, y_mm, letter_of(number), fontweight="bold", fontsize=POINTS + 1)


def letter_of(number: int) -> str:
    """Letter of a panel: a to z, then aa, ab and so on."""
    alphabet = "abcdefghijklmnopqrstuvwxyz"
    first, last = divmod(number, len(alphabet))
    return (letter_of(first - 1) if first else "") + alphabet[last]


def add_legend(axes: Axes, **place: Any) -> None:
    """Name the curves of some axes."""
    style = {"frameon": False, "handlelength": 2.2, "borderaxespad": 0.2, "labelspacing": 0.3, **place}
    axes.legend(prop={"family": FONT, "size": SMALL_POINTS}, labelcolor=COLOURS["line"], **style)


def literal(text: str) -> str:
    """Text that is drawn as it is: no dollar begins a formula."""
    return text.replace("$", r"\$")
