"""Gyrification index, sulcal depth and number of gyri against growth time."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from gyrify.metrics import Measures
from gyrify.report.drawn_slice import FloatArray
from gyrify.report.plot.curves import curves, mark_onset, title_of
from gyrify.report.plot.shown import Shown
from gyrify.report.plot.slices import Label
from gyrify.report.plot.style import DASHES, HUES, SINGLE, TIME_LABEL, add_legend, literal
from gyrify.run.summary import measure_state

_HEIGHTS: Final = (38.0, 26.0, 20.0)
_LABELS: Final = ("gyrification index [–]", "sulcal depth [mm]", "gyri [count]")


@dataclass(frozen=True, eq=False)
class Series:
    """Metrics of every state, (n_states,) each; NaN where an index is infinite or not defined.

    In the plane the indices are those of lengths, the other one by the exposed outline; in space those of
    areas, the other one the mean over sections.
    """

    time: FloatArray
    hull: FloatArray
    closing: FloatArray
    other: FloatArray
    depth_max: FloatArray
    depth_mean: FloatArray
    n_gyri: FloatArray

    @staticmethod
    def of(state: Shown) -> Series:
        """Measure every state of a run up to the shown one."""
        history = state.history
        rows = [
            (*_indices(m), m.sulcal_depth_max, m.sulcal_depth_mean, m.n_gyri)
            for m in (measure_state(history, index) for index in range(state.index + 1))
        ]
        columns = np.array(rows, dtype=np.float64).T
        columns[~np.isfinite(columns)] = np.nan
        return Series(history.growth_times[: state.index + 1], *columns)


def _indices(m: Measures) -> tuple[float, float, float]:
    if m.n_dim == 2:
        return m.gi_hull, m.gi_closing, m.gi_exposed
    return m.gi_area_hull, m.gi_area_closing, np.nan if m.gi_sections is None else m.gi_sections


def gi_plot(states: Sequence[Shown], width_mm: float | None) -> Figure:
    """Indices of one run in their three definitions, or the index by the closing of several runs."""
    width = width_mm or SINGLE
    title = title_of(states, "Folding against growth")
    title = Label(title.lines, "; ".join(filter(None, (title.note, _checked(states)))))
    figure, panels = curves(title, TIME_LABEL, _LABELS, width, _HEIGHTS)
    if len(states) == 1:
        _one(panels, states[0])
    else:
        _several(panels, states)
    panels[2].yaxis.set_major_locator(MaxNLocator(integer=True, nbins=4))
    for axes in panels[1:]:
        axes.set_ylim(bottom=0.0)
    panels[2].set_ylim(top=max(1.0, panels[2].get_ylim()[1]))
    panels[0].set_xlim(0.0, max(state.history.config.growth.duration for state in states))
    return figure


def _checked(states: Sequence[Shown]) -> str:
    """What is known of the meshes of the runs, in a few words."""
    counts = Counter(state.mark.removeprefix("mesh ") for state in states)
    if len(counts) == 1:
        return f"{'mesh' if len(states) == 1 else 'meshes'} {next(iter(counts))}"
    return "meshes: " + ", ".join(f"{count} {words}" for words, count in counts.items())


def _one(panels: Sequence[Axes], state: Shown) -> None:
    series, radius = Series.of(state), state.history.config.metrics.closing_radius
    kind = "area, " if state.in_space else ""
    indices = (
        (series.closing, f"{kind}closing, {radius:.4g} mm"),
        (series.hull, f"{kind}convex hull"),
        (series.other, "mean of sections" if state.in_space else f"exposed, {radius:g} mm"),
    )
    for (values, label), hue, dash in zip(indices, HUES, DASHES, strict=False):
        panels[0].plot(series.time, values, color=hue, linestyle=dash, linewidth=1.2, label=label)
    for values, label, hue, dash in (
        (series.depth_max, "deepest", HUES[0], DASHES[0]),
        (series.depth_mean, "mean", HUES[1], DASHES[1]),
    ):
        panels[1].plot(series.time, values, color=hue, linestyle=dash, linewidth=1.2, label=label)
    panels[2].plot(series.time, series.n_gyri, color=HUES[0], linewidth=1.2, drawstyle="steps-post")
    onset = state.history.onset
    if onset is not None:
        for number, axes in enumerate(panels):
            mark_onset(axes, onset.growth_time, "" if number else "onset")
    for axes in panels[:2]:
        add_legend(axes, loc="upper left")


def _several(panels: Sequence[Axes], states: Sequence[Shown]) -> None:
    for state, hue, dash in zip(states, HUES, DASHES, strict=False):
        series = Series.of(state)
        name = literal(state.name)
        style: dict[str, Any] = {"color": hue, "linestyle": dash, "linewidth": 1.2}
        panels[0].plot(series.time, series.closing, label=name, **style)
        panels[1].plot(series.time, series.depth_max, label=name, **style)
        panels[2].plot(series.time, series.n_gyri, label=name, drawstyle="steps-post", **style)
        onset = state.history.onset
        if onset is not None:
            height = np.interp(onset.growth_time, series.time, series.closing)
            panels[0].plot([onset.growth_time], [height], marker="o", markersize=3.5, color=hue)
    panels[0].set_ylabel("GI by area, closing [–]" if states[0].in_space else "GI, closing [–]")
    panels[1].set_ylabel("depth, max [mm]")
    add_legend(panels[0], loc="upper left")
