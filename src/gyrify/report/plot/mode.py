"""The mode along which a run first lost stability."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from matplotlib.figure import Figure

from gyrify.errors import ConfigError
from gyrify.report.drawn_slice import FloatArray, IntArray
from gyrify.report.layout import legend
from gyrify.report.mode_figure import AMPLITUDE, ModeLines, mode_figure, mode_handles, wave_words
from gyrify.report.plot.bodies import Row, body_rows
from gyrify.report.plot.field_colours import Paint
from gyrify.report.plot.shown import Shown
from gyrify.report.plot.slices import BAR_MM, Label, board, grid_columns
from gyrify.report.plot.style import DOUBLE, SINGLE
from gyrify.report.surface_drawing import DrawnBody
from gyrify.run.onset.space_waves import normal_displacement
from gyrify.solve.stability import Onset

_PAINT: Final = Paint("normal displacement of the mode, relative [–]", "RdBu_r", 1.0, 0.0)
Arrays = tuple[FloatArray, FloatArray, IntArray, IntArray, IntArray]


def mode_plot(states: Sequence[Shown], width_mm: float | None) -> Figure:
    """State at onset and the same displaced along its mode, for one run or for several at one scale.

    Raises
    ------
    ConfigError
        If a run has no onset.
    """
    onsets = [onset_of(state) for state in states]
    if states[0].in_space:
        return body_rows([mode_row(s, o) for s, o in zip(states, onsets, strict=True)], width_mm)
    width = width_mm or (SINGLE if len(states) == 1 else DOUBLE)
    if len(states) == 1 and width == SINGLE:
        return _one(states[0], onsets[0])
    lines = [_lines(state, onset) for state, onset in zip(states, onsets, strict=True)]
    labels = [
        Label(
            (
                state.name,
                f"t = {onset.growth_time:.5g}, n = {onset.mode_number}, λ = {onset.wavelength:.3g} mm",
            ),
            state.note,
        )
        for state, onset in zip(states, onsets, strict=True)
    ]
    columns = grid_columns(len(states), width)
    page = board([each.frame for each in lines], labels, width, columns=columns)
    for axes, each in zip(page.panels, lines, strict=True):
        each.draw(axes)
    legend(page.figure, mode_handles(), middle_mm=0.5 * BAR_MM)
    return page.figure


def mode_row(state: Shown, onset: Onset) -> Row:
    """The body at onset, displaced along its mode, and coloured by the mode's normal displacement."""
    mesh, n = state.history.mesh, state.history.mesh.n_points
    x, v = mesh.points + onset.displacement[:n], onset.vector[:n]
    height = np.full(n, np.nan)
    height[mesh.contour] = normal_displacement(mesh, onset.displacement[:n], v)
    size = float(np.linalg.norm(v[mesh.contour], axis=1).max()) or 1.0
    width = float(np.ptp(x[mesh.contour, 0]))
    label = f"{state.name}, loss of stability at growth time {onset.growth_time:.5g}, {wave_words(onset)}"
    values = height / (float(np.nanmax(np.abs(height))) or 1.0)
    return Row(DrawnBody(mesh, x + AMPLITUDE * width / size * v), Label((label,), state.note), _PAINT, values)


def onset_of(state: Shown) -> Onset:
    """Onset of a run.

    Raises
    ------
    ConfigError
        If it has none, with the reason.
    """
    history = state.history
    if history.onset is not None:
        return history.onset
    if not history.config.stability.detect:
        raise ConfigError(
            f"{state.name}: the loss of stability was not looked for (stability.detect = false).",
            "Run again with --set stability.detect=true.",
        )
    raise ConfigError(
        f"{state.name}: no onset was found up to growth time {float(history.growth_times[-1]):.6g}, so that "
        "there is no mode to show.",
        "Grow for longer, or choose another picture with --what.",
    )


def _arrays(state: Shown, onset: Onset) -> Arrays:
    mesh = state.history.mesh
    x = mesh.points + onset.displacement[: mesh.n_points]
    return x, onset.vector[: mesh.n_points], mesh.contour, mesh.interface, mesh.clamped


def _lines(state: Shown, onset: Onset) -> ModeLines:
    return ModeLines.of(*_arrays(state, onset), state.history.mesh.period)


def _one(state: Shown, onset: Onset) -> Figure:
    title = f"Loss of stability at growth time {onset.growth_time:.5g}"
    return mode_figure(
        *_arrays(state, onset),
        title=f"{title} ({state.note})" if state.note else title,
        subtitle=wave_words(onset),
        period=state.history.mesh.period,
    )
