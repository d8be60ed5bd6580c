"""Bodies in space, a row each: three views and a section, to one scale, by tissue or coloured by a field."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from gyrify.config.run_sections import OutputField
from gyrify.mesh import Mesh
from gyrify.mesh.boundary import boundary_faces
from gyrify.report.drawn_slice import FloatArray
from gyrify.report.layout import FOOTER_MM, LINE_MM, MARGIN_MM, legend, scale_bar
from gyrify.report.plot.field_colours import PAINTS, Paint, colour_bar, common_scale
from gyrify.report.plot.slices import Label, write_label
from gyrify.report.plot.space_figure import in_view, panel, tissue_patches
from gyrify.report.plot.style import DOUBLE, letter, new_figure, write
from gyrify.report.surface_drawing import VIEWS, DrawnBody, paint, section_caption

_GAP_MM: Final = 4.0
_TOP_MM: Final = 2.0
_BAR_MM: Final = 11.0
_SECTION: Final = "section"


@dataclass(frozen=True, eq=False)
class Row:
    """What a row of panels shows.

    Attributes
    ----------
    body : DrawnBody
        The state.
    label : Label
        Written above it.
    paint : Paint or None
        How its field is coloured; None where tissues are shown.
    values : float array
        Of every cell, or of every point (NaN off the surface), in the unit of the paint.
    """

    body: DrawnBody
    label: Label
    paint: Paint | None = None
    values: FloatArray = field(default_factory=lambda: np.empty(0))

    def colours(self, scale: Normalize) -> tuple[FloatArray, FloatArray | None]:
        """Colours of the triangles of the surface; those of the cells, unless the field is of points."""
        assert self.paint is not None
        colour = ScalarMappable(scale, self.paint.colours).to_rgba
        on_surface, in_cells = surface_values(self.body.mesh, self.values)
        inside = None if in_cells is None else np.asarray(colour(in_cells))[:, :3]
        return np.asarray(colour(on_surface))[:, :3], inside


def in_space_paint(name: OutputField) -> Paint:
    """How a field of a body in space is coloured."""
    paint = PAINTS[name]
    # it has two directions along the layers, and the field is their mean
    return replace(paint, label=paint.label.replace("circumferential stress", "stress along the layers"))


def surface_values(mesh: Mesh, values: FloatArray) -> tuple[FloatArray, FloatArray | None]:
    """Values of the triangles of the outer surface and, where they are those of cells, of the cells."""
    if values.size == mesh.n_cells:
        _, owners = boundary_faces(mesh)
        return values[owners[: len(mesh.faces)]], values
    return np.asarray(values[mesh.faces].mean(axis=1)), None


def body_rows(rows: Sequence[Row], width_mm: float | None, title: Label | None = None) -> Figure:
    """Draw rows of three views and a section at x in the middle.

    Parameters
    ----------
    rows : sequence of Row
        What to draw; rows with one paint have one colour scale.
    width_mm : float, optional
        Width of the page; that of two columns by default.
    title : Label, optional
        Written above everything.
    """
    width = width_mm or DOUBLE
    bounds = [row.body.bounds for row in rows]
    low, high = np.min([b[0] for b in bounds], axis=0), np.max([b[1] for b in bounds], axis=0)
    frames = {name: in_view(name, low, high) for name in (*VIEWS, _SECTION)}
    wide = [float(ends[1][0] - ends[0][0]) for ends in frames.values()]
    scale = (width - 2.0 * MARGIN_MM - 3.0 * _GAP_MM) / sum(wide)
    tall = scale * max(float(ends[1][1] - ends[0][1]) for ends in frames.values())
    heads = [LINE_MM * (len(row.label.wrapped(width)) + bool(row.label.note)) + 5.5 for row in rows]
    top = 0.0 if title is None else LINE_MM * (len(title.wrapped(width)) + bool(title.note)) + 1.0
    paints = list(dict.fromkeys(row.paint for row in rows if row.paint is not None))
    foot = FOOTER_MM + (_BAR_MM if paints else 0.0)
    total = _TOP_MM + top + sum(heads) + len(rows) * (tall + _GAP_MM) + foot
    figure = new_figure(width, total)
    if title is not None:
        write_label(figure, title, MARGIN_MM, total - _TOP_MM, width, weight="bold")
    scales = {each: common_scale(each, [r.values for r in rows if r.paint == each]) for each in paints}
    upper = total - _TOP_MM - top
    for number, (row, head) in enumerate(zip(rows, heads, strict=True)):
        letter(figure, number, MARGIN_MM, upper)
        write_label(figure, row.label, MARGIN_MM + 4.0, upper, width)
        _draw(figure, row, frames, scale, (upper - head - tall, tall), scales)
        upper -= head + tall + _GAP_MM
    scale_bar(figure, low, high)
    if paints:
        _bars(figure, rows, scales, width)
    if any(row.paint is None or row.values.size != row.body.mesh.n_cells for row in rows):
        legend(figure, tissue_patches())
    return figure


def _draw(
    figure: Figure,
    row: Row,
    frames: dict[str, tuple[FloatArray, FloatArray]],
    scale: float,
    place: tuple[float, float],
    scales: dict[Paint, Normalize],
) -> None:
    """Draw the panels of a row."""
    (bottom, tall), left = place, MARGIN_MM
    low, high = row.body.bounds
    middle, width = float(0.5 * (low[0] + high[0])), float(high[0] - low[0])
    surface, inside = (None, None) if row.paint is None else row.colours(scales[row.paint])
    for name, frame in frames.items():
        axes = panel(figure, (left, bottom, tall), scale, frame)
        caption = name if name in VIEWS else section_caption(middle, width)
        write(figure, left, bottom + tall + 4.5, caption, fontsize=7)
        paint(axes, row.body.surface(name, surface) if name in VIEWS else row.body.section(middle, inside))
        left += scale * float(frame[1][0] - frame[0][0]) + _GAP_MM


def _bars(figure: Figure, rows: Sequence[Row], scales: dict[Paint, Normalize], width: float) -> None:
    """A colour bar for each paint, side by side above the footer."""
    room = (width - 2.0 * MARGIN_MM - _GAP_MM * (len(scales) - 1)) / len(scales)
    for number, (each, scale) in enumerate(scales.items()):
        box = (MARGIN_MM + number * (room + _GAP_MM) + 0.08 * room, FOOTER_MM + 7.0, 0.84 * room, 2.5)
        shown = ScalarMappable(scale, each.colours)
        colour_bar(
            figure, box, shown, each.label, np.concatenate([r.values for r in rows if r.paint == each])
        )
