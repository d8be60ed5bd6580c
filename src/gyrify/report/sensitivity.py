"""What folding owes to dissipation: index and gyri against the drag number, with the spread of seeds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator

from gyrify.report.layout import MM
from gyrify.report.study_data import INDEX, Cell, axis_label

# Okabe and Ito's colours, told apart by every common colour vision; markers tell them apart too.
HUES: Final = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#1f1f1f", "#f0e442")
MARKERS: Final = ("o", "s", "^", "D", "v", "P", "X", "*")
NUMBER: Final = "dissipation.number"
MOST_LINES: Final = len(HUES)
_WIDTH_MM, _HEIGHT_MM = 180.0, 80.0


def sensitivity_figure(cells: Sequence[Cell], keys: Sequence[str], index: str = INDEX) -> Figure:
    """Draw gyrification index and number of gyri against the dissipation number.

    Parameters
    ----------
    cells : sequence of Cell
        Runs by the values of the parameters.
    keys : sequence of str
        Dotted keys of the parameters, the dissipation number first; a line for each combination of the
        others, eight at most.
    index : str
        What the index is called.

    Returns
    -------
    matplotlib.figure.Figure
        Lines are means over seeds, bars reach from the least to the greatest.
    """
    figure = Figure(figsize=(_WIDTH_MM * MM, _HEIGHT_MM * MM), layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2, sharex=True)
    groups: dict[tuple[Any, ...], list[Cell]] = {}
    for cell in cells:
        groups.setdefault(cell.at[1:], []).append(cell)
    smallest = min((cell.at[0] for cell in cells if cell.at[0] > 0.0), default=1.0)
    for (others, group), hue, marker in zip(groups.items(), HUES, MARKERS, strict=False):
        style: dict[str, Any] = {"color": hue, "marker": marker, "label": _name(keys[1:], others)}
        ordered = sorted((cell for cell in group if cell.gi), key=lambda cell: cell.at[0])
        _draw(left, ordered, [cell.gi for cell in ordered], style)
        _draw(right, ordered, [cell.gyri for cell in ordered], style)
    for axes, label in ((left, index), (right, "gyri")):
        _set_axes(axes, label, smallest, any(cell.at[0] == 0.0 for cell in cells))
    right.yaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    if len(keys) > 1:
        handles, labels = left.get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper center", ncols=4, fontsize=7, frameon=False)
    seeds = max((len(cell.gi) + cell.n_failed for cell in cells), default=1)
    if seeds > 1:
        text = f"Means of up to {seeds} seeds; bars from the least to the greatest."
        figure.supxlabel(text, fontsize=7, color="0.3")
    return figure


def _draw(axes: Axes, cells: Sequence[Cell], values: Sequence[tuple[float, ...]], style: Any) -> None:
    mean = np.array([np.mean(found) for found in values])
    spread = np.array([[np.mean(found) - min(found), max(found) - np.mean(found)] for found in values])
    numbers = [cell.at[0] for cell in cells]
    bars = spread.reshape(-1, 2).T.clip(0.0)
    axes.errorbar(numbers, mean, bars, linewidth=1.2, markersize=4.5, capsize=2.5, elinewidth=0.9, **style)


def _set_axes(axes: Axes, label: str, smallest: float, has_zero: bool) -> None:
    if has_zero:
        axes.set_xscale("symlog", linthresh=smallest, linscale=0.5)
    else:
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.set_xlabel("dissipation number [–]", fontsize=8)
    axes.set_ylabel(label, fontsize=8)
    axes.tick_params(labelsize=7)
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(True, axis="y", color="0.92", linewidth=0.7)


def _name(keys: Sequence[str], values: Sequence[Any]) -> str:
    shown = (f"{value:.3g}" if isinstance(value, float) else str(value) for value in values)
    return ", ".join(f"{axis_label(key)} {value}" for key, value in zip(keys, shown, strict=True))
