"""Panels of slices at one scale: common frame, common scale bar, a letter each."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gyrify.report.drawn_slice import DrawnSlice, FloatArray
from gyrify.report.figures import draw_tissues
from gyrify.report.layout import CHARACTERS_PER_MM, COLOURS, LINE_MM, MARGIN_MM, OUTLINE, line, scale_bar
from gyrify.report.plot.shown import Shown
from gyrify.report.plot.style import SINGLE, SMALL_POINTS, add_axes, letter, new_figure, write

GAP_MM = 4.0
BAR_MM = 9.0
# Panels that are narrower have no room for their labels.
_NARROWEST_MM = 24.0
_NOTE = COLOURS["outline"]


@dataclass(frozen=True)
class Label:
    """Lines above a panel, and a note on a run that did not complete."""

    lines: tuple[str, ...]
    note: str = ""

    def wrapped(self, width_mm: float) -> list[str]:
        """Every line, broken to a width that a letter narrows."""
        room = int(CHARACTERS_PER_MM * 1.25 * (width_mm - 5.0))
        return [part for text in self.lines for part in textwrap.wrap(text, max(room, 8))]


@dataclass(frozen=True, eq=False)
class Board:
    """A page of slices.

    Attributes
    ----------
    figure : Figure
        The page.
    panels : list of Axes
        Bare axes in mm, by rows.
    low, high : (2,) float arrays
        Corners of the common frame [mm].
    panel_mm : (float, float)
        Size of each panel on paper.
    foot_mm : float
        Height kept free under the panels.
    """

    figure: Figure
    panels: list[Axes]
    low: FloatArray
    high: FloatArray
    panel_mm: tuple[float, float]
    foot_mm: float
    columns: int
    lefts: list[float] = field(default_factory=list)


def board(
    frames: Sequence[tuple[FloatArray, FloatArray]],
    labels: Sequence[Label],
    width_mm: float,
    *,
    columns: int = 1,
    bars_mm: float = 0.0,
    title: Label | None = None,
) -> Board:
    """Lay out slices of one scale on a page.

    Parameters
    ----------
    frames : sequence of (low, high)
        Corners [mm] of what each panel shows.
    labels : sequence of Label
        What is written above each.
    width_mm : float
        Width of the page.
    columns : int
        Panels in a row.
    bars_mm : float
        Height kept for colour bars between the panels and the scale bar.
    title : Label, optional
        Written above everything.

    Returns
    -------
    Board
        With the scale bar at the lower left.
    """
    low, high = common_frame(frames)
    rows, columns = -(-len(frames) // columns), min(columns, len(frames))
    wide = (width_mm - 2 * MARGIN_MM - (columns - 1) * GAP_MM) / columns
    tall = wide * float((high[1] - low[1]) / (high[0] - low[0]))
    heads = [len(label.wrapped(wide)) + bool(label.note) for label in labels]
    head = LINE_MM * max(heads) + 1.5
    top = 0.0 if title is None else 2.0 + LINE_MM * (len(title.wrapped(width_mm)) + bool(title.note))
    height = 2.0 + top + rows * (head + tall + GAP_MM) + bars_mm + BAR_MM
    figure = new_figure(width_mm, height)
    if title is not None:
        write_label(figure, title, MARGIN_MM, height - 2.0, width_mm, weight="bold")
    panels, lefts = [], []
    for number, label in enumerate(labels):
        row, column = divmod(number, columns)
        left, upper = MARGIN_MM + column * (wide + GAP_MM), height - 2.0 - top - row * (head + tall + GAP_MM)
        letter(figure, number, left, upper)
        write_label(figure, label, left + 4.0, upper, wide)
        axes = add_axes(figure, (left, upper - head - tall, wide, tall))
        set_frame(axes, low, high)
        panels.append(axes)
        lefts.append(left)
    scale_bar(figure, low, high, y_mm=0.7 * BAR_MM)
    return Board(figure, panels, low, high, (wide, tall), bars_mm + BAR_MM, columns, lefts)


def grid_columns(count: int, width_mm: float) -> int:
    """Columns of a grid of slices: two or three, and more where there are many."""
    if count <= 9:
        return 2 if width_mm == SINGLE or count in (2, 4) else 3
    most = int((width_mm - 2 * MARGIN_MM + GAP_MM) / (_NARROWEST_MM + GAP_MM))
    return max(2, min(math.ceil(math.sqrt(count)), most))


def common_frame(frames: Sequence[tuple[FloatArray, FloatArray]]) -> tuple[FloatArray, FloatArray]:
    """Corners of the frame that holds all, each centred in x, with a margin of 1 %."""
    low = np.min([frame[0] for frame in frames], axis=0)
    high = np.max([frame[1] for frame in frames], axis=0)
    pad = 0.01 * (high - low)
    return low - pad, high + pad


def set_frame(axes: Axes, low: FloatArray, high: FloatArray) -> None:
    """Bare axes that show a frame in mm."""
    axes.set_axis_off()
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal", autoscale_on=False)


def draw_slice(axes: Axes, shown: Shown, *, tissues: bool, exposed: bool) -> None:
    """Draw tissues and lines of a state; with its exposed outline if asked for."""
    drawing = shown.drawing
    if tissues:
        draw_tissues(axes, drawing.points, drawing.cells, drawing.region)
    if exposed:
        for piece in drawing.exposed:
            axes.add_line(line(piece, **OUTLINE))
    draw_lines(axes, drawing, clamped_line(shown))


def draw_lines(axes: Axes, drawing: DrawnSlice, clamped: FloatArray) -> None:
    """Draw contour, interface and where the tissue is held."""
    for thin in (clamped, drawing.interface):
        axes.add_line(line(thin, color=COLOURS["line"], linewidth=0.35))
    axes.add_line(line(drawing.contour, color=COLOURS["line"], linewidth=0.6))


def clamped_line(shown: Shown) -> FloatArray:
    """The hole of a slice, or the floor of a strip."""
    mesh = shown.history.mesh
    return shown.drawing.floor if shown.drawing.is_periodic else mesh.points[[*mesh.clamped, mesh.clamped[0]]]


def write_label(
    figure: Figure, label: Label, x_mm: float, y_mm: float, width_mm: float, weight: str = "normal"
) -> None:
    lines = label.wrapped(width_mm)
    for number, text in enumerate(lines):
        write(figure, x_mm, y_mm - LINE_MM * number, text, fontweight=weight)
    if label.note:
        note_y = y_mm - LINE_MM * len(lines)
        write(figure, x_mm, note_y, label.note, color=_NOTE, fontsize=SMALL_POINTS + 1)
