"""Folded slices: tissues, contour and exposed outline."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from gyrify.report.figures import folded_figure
from gyrify.report.layout import COLOURS, OUTLINE, legend
from gyrify.report.plot.bodies import Row, body_rows
from gyrify.report.plot.shown import Shown
from gyrify.report.plot.slices import BAR_MM, Label, board, draw_slice, grid_columns
from gyrify.report.plot.space_figure import space_figure
from gyrify.report.plot.style import DOUBLE, SINGLE


def folded_plot(states: Sequence[Shown], width_mm: float | None) -> Figure:
    """One slice as in ``folded.png``, or several at one scale."""
    if states[0].in_space:
        return _bodies(states, width_mm)
    if len(states) == 1:
        return _one(states[0], width_mm or SINGLE)
    width = width_mm or DOUBLE
    columns = grid_columns(len(states), width)
    frames = [(state.drawing.low, state.drawing.high) for state in states]
    labels = [Label((state.name, state.caption), state.note) for state in states]
    page = board(frames, labels, width, columns=columns)
    for axes, state in zip(page.panels, states, strict=True):
        draw_slice(axes, state, tissues=True, exposed=True)
    legend(page.figure, tissue_handles(), columns=3 if width == DOUBLE else 2, middle_mm=0.5 * BAR_MM)
    return page.figure


def _bodies(states: Sequence[Shown], width_mm: float | None) -> Figure:
    """One body as in ``folded.png``, or several, a row each."""
    if len(states) > 1:
        labels = [Label((f"{state.name}, {state.caption}",), state.note) for state in states]
        return body_rows(
            [Row(state.body, label) for state, label in zip(states, labels, strict=True)], width_mm
        )
    (state,) = states
    title = f"{state.name} ({state.note})" if state.note else state.name
    lines = [(title, 9, "bold"), (state.caption, 8, "normal")]
    body = state.body
    return space_figure(body.mesh, body.points, depth=body.depth, text=lines, width_mm=width_mm or DOUBLE)


def tissue_handles() -> list[Patch | Line2D]:
    """What the legend of a slice names."""
    grey, white = (
        Patch(facecolor=COLOURS[kind], edgecolor=COLOURS["line"], linewidth=0.4, label=f"{kind} matter")
        for kind in ("grey", "white")
    )
    return [grey, white, Line2D([], [], label="exposed outline", **OUTLINE)]


def _one(state: Shown, width_mm: float) -> Figure:
    mesh, history = state.history.mesh, state.history
    is_last = state.index == len(history) - 1
    title = state.name if is_last else f"{state.name}, growth time {state.growth_time:.4g}"
    return folded_figure(
        history.points(state.index),
        mesh.triangles,
        mesh.triangle_region,
        mesh.contour,
        mesh.interface,
        closing_radius=history.config.metrics.closing_radius,
        gi=state.measures.gi_closing,
        n_gyri=state.measures.n_gyri,
        title=f"{title} ({state.note})" if state.note else title,
        mark=state.mark,
        width_mm=width_mm,
        period=mesh.period,
    )
