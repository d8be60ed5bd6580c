"""The phase diagram of a study: gyrification index and phenotype over two parameters, with theory's onset."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib import colormaps, patheffects
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import Normalize, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import NullLocator
from numpy.typing import NDArray

from gyrify.report.layout import MM
from gyrify.report.onset_curve import OnsetCurve
from gyrify.report.study_data import INDEX, Cell, axis_label, is_logarithmic

FloatArray = NDArray[np.float64]
Box = tuple[float, float, float, float]

# Differ in lightness and hue (after Okabe and Ito); initials tell them apart in print too.
PHENOTYPES: Final = {
    "smooth": ("#f2f2f2", "S"),
    "lissencephaly": ("#56b4e9", "L"),
    "pachygyria": ("#0072b2", "P"),
    "normal": ("#009e73", "N"),
    "polymicrogyria": ("#f0e442", "M"),
    "sinusoidal": ("#cc79a7", "W"),
}
_COLOURS: Final = colormaps["cividis"]
_WIDTH_MM, _HEIGHT_MM = 180.0, 92.0
_MOST_TEXTS: Final = 120
_MOST_TICKS: Final = 9
_ONSET: Final = "#d55e00"


def phase_figure(
    cells: Sequence[Cell],
    keys: tuple[str, str],
    onset: OnsetCurve,
    *,
    n_seeds: int = 1,
    index: str = INDEX,
) -> Figure:
    """Draw gyrification index and phenotype over two parameters.

    Parameters
    ----------
    cells : sequence of Cell
        Runs by the values of the two parameters.
    keys : (str, str)
        Dotted keys of the parameters along x and y.
    onset : OnsetCurve
        What theory says, drawn on top.
    n_seeds : int
        Largest number of runs in a cell, for the caption.
    index : str
        What the index is called.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(_WIDTH_MM * MM, _HEIGHT_MM * MM), layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2, sharex=True, sharey=True)
    places = np.array([cell.at for cell in cells], dtype=np.float64).reshape(-1, 2)
    logs = tuple(is_logarithmic(places[:, axis]) for axis in (0, 1))
    boxes = _boxes(places, logs)
    known = [float(np.mean(cell.gi)) for cell in cells if cell.gi]
    norm = Normalize(min(known, default=1.0), max([*known, min(known, default=1.0) + 0.01]))
    for axes, is_index in ((left, True), (right, False)):
        _set_axes(axes, keys, logs)
        _draw_cells(axes, cells, boxes, norm, is_index)
        _limit(axes, places, boxes)
        for line in onset.lines:
            casing = [patheffects.withStroke(linewidth=3.4, foreground="white")]
            axes.plot(line[:, 0], line[:, 1], color=_ONSET, linewidth=1.6, path_effects=casing, zorder=4)
    left.set_title(f"a  {index}", loc="left", fontsize=8)
    right.set_title("b  phenotype", loc="left", fontsize=8)
    right.set_ylabel("")
    figure.colorbar(_scale(norm), ax=left, shrink=0.9, pad=0.02).ax.tick_params(labelsize=7)
    _legend(figure, cells, onset)
    seeds = f"Mean of up to {n_seeds} seeds; their most frequent phenotype. " if n_seeds > 1 else ""
    figure.supxlabel(f"{seeds}{onset.note}", fontsize=7, color="0.3")
    return figure


def _scale(norm: Normalize) -> Any:
    from matplotlib.cm import ScalarMappable

    return ScalarMappable(norm, _COLOURS)


def _set_axes(axes: Axes, keys: tuple[str, str], logs: tuple[bool, ...]) -> None:
    axes.set_xscale("log" if logs[0] else "linear")
    axes.set_yscale("log" if logs[1] else "linear")
    axes.set_xlabel(axis_label(keys[0]), fontsize=8)
    axes.set_ylabel(axis_label(keys[1]), fontsize=8)
    axes.tick_params(labelsize=7, which="both")


def _boxes(places: FloatArray, logs: tuple[bool, ...]) -> list[Box] | None:
    """Left, bottom, right and top of every cell of a full grid; None for scattered points."""
    columns = [np.unique(places[:, axis]) for axis in (0, 1)]
    if len(places) < columns[0].size * columns[1].size or min(map(len, columns)) < 2:
        return None
    edges = [_edges(values, log) for values, log in zip(columns, logs, strict=True)]
    at = [np.searchsorted(values, places[:, axis]) for axis, values in enumerate(columns)]
    return [
        (float(edges[0][i]), float(edges[1][j]), float(edges[0][i + 1]), float(edges[1][j + 1]))
        for i, j in zip(*at, strict=True)
    ]


def _edges(values: FloatArray, is_log: bool) -> FloatArray:
    """Lines half-way between values, and as far beyond the outermost."""
    x = np.log(values) if is_log else values
    middle = 0.5 * (x[1:] + x[:-1])
    edges = np.array([2 * x[0] - middle[0], *middle, 2 * x[-1] - middle[-1]])
    return np.exp(edges) if is_log else edges


def _limit(axes: Axes, places: FloatArray, boxes: list[Box] | None) -> None:
    """Frame the cells, and name their values where there are few."""
    if boxes is None:
        axes.margins(0.08)
        axes.autoscale_view()
        return
    corners = np.array(boxes)
    axes.set(xlim=(corners[:, 0].min(), corners[:, 2].max()), ylim=(corners[:, 1].min(), corners[:, 3].max()))
    for axis, values in ((axes.xaxis, np.unique(places[:, 0])), (axes.yaxis, np.unique(places[:, 1]))):
        if values.size <= _MOST_TICKS:
            axis.set_ticks(values, labels=[f"{value:.3g}" for value in values])
            axis.set_minor_locator(NullLocator())


def _draw_cells(
    axes: Axes, cells: Sequence[Cell], boxes: list[Box] | None, norm: Normalize, is_index: bool
) -> None:
    for number, cell in enumerate(cells):
        colour, text = _look(cell, norm, is_index)
        if boxes is None:
            marker: dict[str, Any] = {"markerfacecolor": colour, "markeredgecolor": "0.2"}
            shape = "o" if cell.gi else "X"
            axes.plot(*cell.at, shape, markersize=9, markeredgewidth=0.5, zorder=5, **marker)
        else:
            x0, y0, x1, y1 = boxes[number]
            box = Rectangle((x0, y0), x1 - x0, y1 - y0, facecolor=colour, edgecolor="white", linewidth=0.4)
            if not cell.gi:
                box.set_hatch("////")
            axes.add_patch(box)
        if len(cells) <= _MOST_TEXTS and (boxes is not None or (cell.gi and not is_index)):
            _write(axes, cell, text, colour)


def _write(axes: Axes, cell: Cell, text: str, colour: Any) -> None:
    """Write into a cell, legible on its colour."""
    dark = np.dot(to_rgb(colour), (0.299, 0.587, 0.114)) < 0.5
    halo = [patheffects.withStroke(linewidth=1.5, foreground=colour)]
    style: dict[str, Any] = {"fontsize": 6, "ha": "center", "va": "center", "path_effects": halo}
    axes.text(cell.at[0], cell.at[1], text, color="white" if dark else "#1f1f1f", zorder=6, **style)


def _look(cell: Cell, norm: Normalize, is_index: bool) -> tuple[Any, str]:
    """Colour and text of a cell."""
    if not cell.gi:
        return "#dddddd", "×"
    if is_index:
        return _COLOURS(norm(np.mean(cell.gi))), f"{np.mean(cell.gi):.2f}"
    return PHENOTYPES.get(cell.phenotype, ("#ffffff", "?"))


def _legend(figure: Figure, cells: Sequence[Cell], onset: OnsetCurve) -> None:
    """Phenotypes that occur, runs that failed, and the curve, in a row above."""
    there = {cell.phenotype for cell in cells}
    edge: dict[str, Any] = {"edgecolor": "0.4", "linewidth": 0.4}
    entries: list[Any] = [
        Patch(facecolor=colour, label=f"{initial}  {name}", **edge)
        for name, (colour, initial) in PHENOTYPES.items()
        if name in there
    ]
    if any(not cell.gi for cell in cells):
        entries.append(Patch(facecolor="#dddddd", hatch="////", label="×  not completed", **edge))
    if onset.lines:
        entries.append(Line2D([], [], color=_ONSET, linewidth=1.6, label="onset by theory"))
    figure.legend(handles=entries, loc="outside upper center", ncols=4, fontsize=7, frameon=False)
