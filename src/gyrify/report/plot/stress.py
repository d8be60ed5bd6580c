"""Stress fields: von Mises, mean and circumferential, one colour scale for each over all panels."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from matplotlib.figure import Figure

from gyrify.config.run_sections import OutputField
from gyrify.errors import ConfigError
from gyrify.report.plot.bodies import Row, body_rows, in_space_paint
from gyrify.report.plot.field_colours import PAINTS, colour_bar, common_scale, draw_field
from gyrify.report.plot.shown import Shown, per_triangle
from gyrify.report.plot.slices import Board, Label, board, draw_slice
from gyrify.report.plot.style import DOUBLE, SINGLE
from gyrify.store.fields import fields

STRESSES: Final[dict[str, OutputField]] = {
    "von_mises": "von_mises",
    "mean": "mean_stress",
    "circumferential": "circumferential_stress",
}
_BAR_MM: Final = 11.0


def stress_plot(states: Sequence[Shown], width_mm: float | None, stress: str | None = None) -> Figure:
    """Cauchy stress of the cells: a row of panels per run and a column per stress, or runs in rows of three.

    Parameters
    ----------
    states : sequence of Shown
        The states.
    width_mm : float, optional
        Width of the page; that of two columns where there is more than one panel.
    stress : str, optional
        One of `STRESSES` instead of all.

    Raises
    ------
    ConfigError
        If there is no such stress.
    """
    names = _chosen(stress)
    panels = [(state, name) for state in states for name in names]
    if states[0].in_space:
        return _bodies(states, names, width_mm)
    columns = min(len(panels), 3)
    page = board(
        [(state.drawing.low, state.drawing.high) for state in states for _ in names],
        [_label(state, name, len(states) == 1) for state, name in panels],
        width_mm or (DOUBLE if columns > 1 else SINGLE),
        columns=columns,
        bars_mm=_BAR_MM,
        title=Label((f"{states[0].name}, {states[0].caption}",), states[0].note)
        if len(states) == 1
        else None,
    )
    for column, name in enumerate(names):
        _draw(page, panels, name, column)
    return page.figure


def _bodies(states: Sequence[Shown], names: Sequence[OutputField], width_mm: float | None) -> Figure:
    """A row for every stress of every state."""
    rows, is_alone = [], len(states) == 1
    for state in states:
        for name in names:
            paint, label = in_space_paint(name), _label(state, name, is_alone)
            rows.append(
                Row(
                    state.body, label, paint, paint.factor * fields(state.history, state.index, (name,))[name]
                )
            )
    title = Label((f"{states[0].name}, {states[0].caption}",), states[0].note) if is_alone else None
    return body_rows(rows, width_mm, title)


def _chosen(stress: str | None) -> list[OutputField]:
    if stress is None:
        return list(STRESSES.values())
    if stress not in STRESSES:
        raise ConfigError(
            f"stress = {stress[:60]!r} is not a stress.", f"Choose one of: {', '.join(STRESSES)}."
        )
    return [STRESSES[stress]]


def _label(state: Shown, name: OutputField, is_alone: bool) -> Label:
    field = (in_space_paint(name) if state.in_space else PAINTS[name]).label.split(" [")[0]
    return (
        Label((field,))
        if is_alone
        else Label((state.name, f"{field}, t = {state.growth_time:.4g}"), state.note)
    )


def _draw(page: Board, panels: Sequence[tuple[Shown, OutputField]], name: OutputField, column: int) -> None:
    """Draw all panels of one stress, and the colour bar under its column."""
    paint = PAINTS[name]
    chosen = [
        (axes, state) for axes, (state, other) in zip(page.panels, panels, strict=True) if other == name
    ]
    values = [paint.factor * fields(state.history, state.index, (name,))[name] for _, state in chosen]
    scale = common_scale(paint, values)
    drawn = []
    for (axes, state), array in zip(chosen, values, strict=True):
        of_triangles = per_triangle(state.history, array, state.drawing)
        drawn.append(draw_field(axes, state.drawing, of_triangles, paint, scale))
        draw_slice(axes, state, tissues=False, exposed=False)
    wide = page.panel_mm[0]
    box = (page.lefts[column] + 0.06 * wide, page.foot_mm - 2.5, 0.88 * wide, 2.5)
    colour_bar(page.figure, box, drawn[0], paint.label, np.concatenate(values))
