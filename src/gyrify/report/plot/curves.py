"""Stacked panels of curves over one abscissa."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gyrify.report.layout import COLOURS, LINE_MM, MARGIN_MM
from gyrify.report.plot.shown import Shown
from gyrify.report.plot.slices import Label, write_label
from gyrify.report.plot.style import add_axes, letter, new_figure, style_axes

LEFT_MM: Final = 14.0
RIGHT_MM: Final = 3.0
BOTTOM_MM: Final = 9.5
_GAP_MM: Final = 4.0
_LABEL_MM: Final = 9.5
_TOP_MM: Final = 2.0


def curves(
    title: Label, x_label: str, y_labels: Sequence[str], width_mm: float, heights_mm: Sequence[float]
) -> tuple[Figure, list[Axes]]:
    """Return a page with panels one above the other that share their abscissa, a letter each."""
    top = _TOP_MM + LINE_MM * (len(title.wrapped(width_mm)) + bool(title.note)) + 3.0
    height = top + sum(heights_mm) + _GAP_MM * (len(heights_mm) - 1) + BOTTOM_MM
    figure = new_figure(width_mm, height)
    write_label(figure, title, MARGIN_MM, height - _TOP_MM, width_mm, weight="bold")
    panels: list[Axes] = []
    upper = height - top
    for number, (label, tall) in enumerate(zip(y_labels, heights_mm, strict=True)):
        box = (LEFT_MM, upper - tall, width_mm - LEFT_MM - RIGHT_MM, tall)
        axes = add_axes(figure, box, share=panels[0] if panels else None)
        is_last = number == len(heights_mm) - 1
        style_axes(axes, x_label if is_last else "", label)
        axes.tick_params(labelbottom=is_last)
        axes.yaxis.set_label_coords(-_LABEL_MM / box[2], 0.5)
        if len(heights_mm) > 1:
            letter(figure, number, 1.0, upper + 3.5)  # above the label of the axis
        panels.append(axes)
        upper -= tall + _GAP_MM
    return figure, panels


def title_of(states: Sequence[Shown], subject: str) -> Label:
    """Title of a page of curves: the run, or what is compared; and the runs that did not complete."""
    if len(states) == 1:
        return Label((states[0].name,), states[0].note)
    notes = "; ".join(f"{state.name}: {state.note}" for state in states if state.note)
    return Label((subject,), notes)


def mark_onset(axes: Axes, time: float, label: str = "") -> None:
    """Mark a growth time by a vertical line, named at its top."""
    axes.axvline(time, color=COLOURS["line"], linewidth=0.6, linestyle=(0, (4, 2)), zorder=1)
    if label:
        axes.annotate(
            label,
            (time, 1.0),
            xycoords=axes.get_xaxis_transform(),
            xytext=(2, 0),
            textcoords="offset points",
            va="top",
            fontsize=7,
            color=COLOURS["line"],
        )
