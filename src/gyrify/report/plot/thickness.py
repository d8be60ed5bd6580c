"""Cortical thickness: as colour, and along the contour with crowns and fundi marked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from gyrify.mesh import GREY
from gyrify.metrics.folds import gyri_of, periodic_extrema
from gyrify.report.drawn_slice import FloatArray
from gyrify.report.figures import draw_tissues
from gyrify.report.layout import COLOURS, LINE_MM, MARGIN_MM, MM, scale_bar
from gyrify.report.plot.bodies import Row, body_rows
from gyrify.report.plot.field_colours import PAINTS, colour_bar, common_scale, draw_field
from gyrify.report.plot.shown import Shown, per_triangle
from gyrify.report.plot.slices import Label, clamped_line, common_frame, draw_lines, set_frame, write_label
from gyrify.report.plot.style import (
    DOUBLE,
    HUES,
    add_axes,
    add_legend,
    letter,
    new_figure,
    style_axes,
)
from gyrify.store.fields import fields

_PAINT: Final = PAINTS["thickness"]
_FOOT_MM: Final = 14.0
_TOP_MM: Final = 2.0
_HIGHEST: Final = 42.0
_MARKS: Final[tuple[tuple[str, str, str], ...]] = (("crowns", "^", HUES[1]), ("fundi", "v", HUES[0]))


@dataclass(frozen=True, eq=False)
class Profile:
    """Thickness along a contour.

    Attributes
    ----------
    arc : (n + 1,) float array
        Arc length from the first point of the contour [mm], up to where it starts again.
    thickness : (n + 1,) float array
        Stored thickness of each point [mm], the first one repeated.
    crowns, fundi : (n_gyri,) float arrays
        Arc lengths of the extrema [mm].
    """

    arc: FloatArray
    thickness: FloatArray
    crowns: FloatArray
    fundi: FloatArray

    @staticmethod
    def of(state: Shown) -> Profile:
        """Profile of a state."""
        history = state.history
        mesh, contour = history.mesh, history.contour(state.index)
        shift = np.zeros(2) if mesh.period is None else np.array([mesh.period, 0.0])
        arc = _arc(np.concatenate([contour, contour[:1] + shift]))
        of_points = fields(history, state.index, ("thickness",))["thickness"][mesh.contour]
        crowns, fundi = _folds(state, contour, arc)
        return Profile(arc, np.append(of_points, of_points[0]), crowns, fundi)


def _arc(line: FloatArray) -> FloatArray:
    edges = np.diff(line, axis=0)
    return np.concatenate([[0.0], np.cumsum(np.hypot(edges[:, 0], edges[:, 1]))])


def _folds(state: Shown, contour: FloatArray, arc: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Arc lengths of crowns and fundi; those of a strip lie on points, between which its height is linear."""
    chosen = state.history.config.metrics
    if state.history.mesh.period is None:
        folds = gyri_of(contour, chosen.gyrus_prominence, chosen.samples)
        along = _arc(folds.points)
        return along[folds.crowns], along[folds.fundi]
    crowns, fundi = periodic_extrema(contour[:, 1], chosen.gyrus_prominence)
    return arc[crowns], arc[fundi]


def thickness_plot(states: Sequence[Shown], width_mm: float | None) -> Figure:
    """A row per run: the cortex coloured by thickness, and thickness along the contour.

    Of a body in space the surface is coloured.
    """
    if states[0].in_space:
        return _bodies(states, width_mm)
    profiles = [Profile.of(state) for state in states]
    scale = common_scale(_PAINT, [profile.thickness for profile in profiles], beyond=0.0)
    frame = common_frame([(state.drawing.low, state.drawing.high) for state in states])
    figure, slices, lines = _page(states, frame, width_mm or DOUBLE)
    drawn = [
        _draw_slice(axes, state, profile, scale)
        for axes, state, profile in zip(slices, states, profiles, strict=True)
    ]
    for axes, profile in zip(lines, profiles, strict=True):
        _draw_curve(axes, profile)
    highest = 1.25 * max(float(profile.thickness.max()) for profile in profiles)
    for axes in lines:
        axes.set(ylim=(0.0, highest), xlim=(0.0, max(float(profile.arc[-1]) for profile in profiles)))
    add_legend(lines[0], loc="upper right", ncols=3)
    scale_bar(figure, *frame, y_mm=6.0)
    wide = slices[0].get_position().width * figure.get_figwidth() / MM
    colour_bar(
        figure,
        (MARGIN_MM + 0.45 * wide, 8.5, 0.52 * wide, 2.5),
        drawn[0],
        _PAINT.label,
        profiles[0].thickness,
    )
    return figure


def _bodies(states: Sequence[Shown], width_mm: float | None) -> Figure:
    rows = [
        Row(
            state.body,
            Label((f"{state.name}, {state.caption}",), state.note),
            _PAINT,
            fields(state.history, state.index, ("thickness",))["thickness"],
        )
        for state in states
    ]
    return body_rows(rows, width_mm)


def _page(
    states: Sequence[Shown], frame: tuple[FloatArray, FloatArray], width: float
) -> tuple[Figure, list[Axes], list[Axes]]:
    """Rows of a slice and a curve beside it, the curve at half the height of the slice."""
    span = frame[1] - frame[0]
    wide = 0.42 * (width - 2 * MARGIN_MM)
    tall = wide * float(span[1] / span[0])
    height = min(max(tall, 24.0), _HIGHEST)
    head, row = LINE_MM * (2 + any(state.note for state in states)) + 3.0, max(tall, height + 8.0)
    total = _TOP_MM + len(states) * (head + row) + _FOOT_MM
    figure = new_figure(width, total)
    slices: list[Axes] = []
    lines: list[Axes] = []
    for number, state in enumerate(states):
        top = total - _TOP_MM - number * (head + row)
        left, middle = MARGIN_MM + wide + 15.0, top - head - 0.5 * row
        write_label(figure, Label((state.name, state.caption), state.note), MARGIN_MM + 4.0, top, width)
        slices.append(add_axes(figure, (MARGIN_MM, middle - 0.5 * tall, wide, tall)))
        box = (left, middle - 0.5 * height + 4.0, width - left - MARGIN_MM, height)
        lines.append(add_axes(figure, box))
        letter(figure, 2 * number, MARGIN_MM, top)
        letter(figure, 2 * number + 1, left - 11.0, middle + 0.5 * height + 6.0)
        set_frame(slices[-1], *frame)
        style_axes(lines[-1], "arc length along the contour [mm]", _PAINT.label)
    return figure, slices, lines


def _draw_slice(axes: Axes, state: Shown, profile: Profile, scale: Normalize) -> PolyCollection:
    """Fill each column of the cortex with the thickness where it meets the contour, at rest."""
    history, drawing = state.history, state.drawing
    mesh = history.mesh
    middles = mesh.cell_points.mean(axis=1)
    count = np.bincount(mesh.patch)[:, None]
    of_patches = np.stack([np.bincount(mesh.patch, middle) for middle in middles.T], axis=1) / count
    contour = mesh.points[mesh.contour]
    ring = np.concatenate(
        [contour, contour[:1] + ([0.0, 0.0] if mesh.period is None else [mesh.period, 0.0])]
    )
    at = shapely.line_locate_point(shapely.linestrings(ring), shapely.points(of_patches))
    of_column = np.interp(at, _arc(ring), profile.thickness)
    values = np.where(mesh.region == GREY, of_column[mesh.patch], np.nan)
    draw_tissues(axes, drawing.points, drawing.cells, drawing.region)
    shown = draw_field(
        axes, drawing, np.ma.masked_invalid(per_triangle(history, values, drawing)), _PAINT, scale
    )
    draw_lines(axes, drawing, clamped_line(state))
    axes.plot(*history.contour(state.index)[0], marker="o", markersize=3.5, color=COLOURS["line"], zorder=4)
    return shown


def _draw_curve(axes: Axes, profile: Profile) -> None:
    axes.plot(profile.arc, profile.thickness, color=COLOURS["line"], linewidth=0.9, zorder=2)
    for (name, marker, hue), places in zip(_MARKS, (profile.crowns, profile.fundi), strict=True):
        heights = np.interp(places, profile.arc, profile.thickness)
        style: dict[str, Any] = {"linestyle": "none", "markersize": 4, "color": hue, "zorder": 3}
        axes.plot(places, heights, marker=marker, label=name, **style)
    axes.plot([0.0], [profile.thickness[0]], marker="o", markersize=3.5, color=COLOURS["line"], clip_on=False)
