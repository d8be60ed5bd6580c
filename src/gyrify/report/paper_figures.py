"""Draws the paper's figures from stored runs: rows of folded slices with the parameters of the captions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from gyrify.paper.cases import Case
from gyrify.paper.row import Row
from gyrify.report.figures import save_figure
from gyrify.report.layout import COLOURS, FONT, MM
from gyrify.report.paper_layout import LAYOUTS, Layout
from gyrify.study import StoredPoint

FloatArray = NDArray[np.float64]

PANEL_MM: Final = 43.0
TITLE_MM: Final = 9.5
BAR_MM: Final = 6.0
GAP_MM: Final = 3.0
_BAR: Final = 20.0
_LETTERS: Final = "abcdefgh"


@dataclass(frozen=True, eq=False)
class Outlines:
    """Lines of a deformed slice, in order [mm].

    Attributes
    ----------
    contour, interface, hole : (n, 2) float arrays
        Outer contour, grey-white interface and clamped boundary.
    """

    contour: FloatArray
    interface: FloatArray
    hole: FloatArray

    @classmethod
    def of(cls, stored: StoredPoint) -> Outlines:
        """Those of a stored run."""
        x, mesh = stored.points, stored.mesh
        return cls(x[mesh.contour], x[mesh.interface], x[mesh.clamped])

    @property
    def size(self) -> FloatArray:
        """Width and height of the contour [mm]."""
        return np.asarray(np.ptp(self.contour, axis=0))


def write_figures(
    rows: Mapping[Case, Row],
    stored: Callable[[str], StoredPoint],
    folder: Path,
    layouts: tuple[Layout, ...] = LAYOUTS,
) -> list[Path]:
    """Write all figures as PNG and PDF.

    Parameters
    ----------
    rows : mapping
        Results by case.
    stored : callable
        Gives the stored run of a key.
    folder : Path
        Where to.
    layouts : tuple of Layout
        Which ones; all by default.

    Returns
    -------
    list of Path
        The files.
    """
    folder.mkdir(parents=True, exist_ok=True)
    wanted = {case for layout in layouts for panels in layout.panels for case in panels}
    outlines = {
        case: Outlines.of(stored(rows[case].key))
        for case in wanted
        if case in rows and rows[case].is_complete
    }
    files = []
    for layout in layouts:
        figure = paper_figure(layout, rows, outlines)
        for suffix in ("png", "pdf"):
            files.append(folder / f"{layout.name}.{suffix}")
            save_figure(figure, files[-1], dpi=200)
    return files


def paper_figure(layout: Layout, rows: Mapping[Case, Row], outlines: Mapping[Case, Outlines]) -> Figure:
    """Draw one figure.

    Parameters
    ----------
    layout : Layout
        Which one.
    rows : mapping
        Results by case, for the index and for the reason where a run failed.
    outlines : mapping
        Slices by case.

    Returns
    -------
    matplotlib.figure.Figure
    """
    n_rows, n_columns = len(layout.panels), max(map(len, layout.panels))
    shown = [outlines[case] for panels in layout.panels for case in panels if case in outlines]
    largest = np.max([outline.size for outline in shown], axis=0) if shown else np.array([1.0, 1.0])
    shape = max((float(outline.size[1] / outline.size[0]) for outline in shown), default=1.0)
    tall = PANEL_MM * shape + TITLE_MM + BAR_MM
    size = np.array([n_columns * (PANEL_MM + GAP_MM) + GAP_MM, n_rows * tall + GAP_MM])
    figure = Figure(figsize=tuple(size * MM), facecolor="white")
    FigureCanvasAgg(figure)
    number = 0
    for i, panels in enumerate(layout.panels):
        for j, case in enumerate(panels):
            left = GAP_MM + j * (PANEL_MM + GAP_MM)
            bottom = size[1] - (i + 1) * tall + BAR_MM
            box = (left / size[0], bottom / size[1], PANEL_MM / size[0], PANEL_MM * shape / size[1])
            axes = figure.add_axes(box)
            axes.set_axis_off()
            letter = f"({_LETTERS[number]}) " if n_rows * n_columns > 1 else ""
            _panel(axes, layout, case, rows.get(case), outlines.get(case), letter, largest, shape)
            number += 1
    return figure


def _panel(
    axes: Axes,
    layout: Layout,
    case: Case,
    row: Row | None,
    outline: Outlines | None,
    letter: str,
    largest: FloatArray,
    shape: float,
) -> None:
    """One slice, its parameters above and a scale bar below; or why there is none."""
    style: dict[str, Any] = {"fontsize": 7, "family": FONT, "color": COLOURS["line"]}
    index = f"GI = {row.gi:.2f}" if row is not None and row.is_complete else ""
    axes.set_title(f"{letter}{layout.heading(case)}\n{index}", pad=2, linespacing=1.25, **style)
    if outline is None:
        reason = "not run" if row is None else f"run {row.status}"
        axes.text(0.5, 0.5, reason, transform=axes.transAxes, ha="center", va="center", **style)
        return
    span = outline.size if layout.own_scale else largest
    draw_slice(axes, outline)
    middle = 0.5 * (outline.contour.min(axis=0) + outline.contour.max(axis=0))
    half = 0.51 * max(span[0], span[1] / shape) * np.array([1.0, shape])
    axes.set(xlim=(middle[0] - half[0], middle[0] + half[0]), ylim=(middle[1] - half[1], middle[1] + half[1]))
    axes.set_aspect("equal", anchor="C")
    start, below = middle[0] - half[0], middle[1] - 1.06 * half[1]
    axes.plot(
        [start, start + _BAR],
        [below, below],
        color=COLOURS["line"],
        linewidth=1.4,
        clip_on=False,
        solid_capstyle="butt",
    )
    axes.text(start + _BAR + 0.03 * span[0], below, f"{_BAR:g} mm", va="center", **(style | {"fontsize": 6}))


def draw_slice(axes: Axes, outline: Outlines) -> None:
    """Fill cortex, white matter and hole, each with its line."""
    fills = ((outline.contour, "grey", 0.6), (outline.interface, "white", 0.3))
    for line, colour, width in fills:
        axes.fill(
            *line.T, facecolor=COLOURS[colour], edgecolor=COLOURS["line"], linewidth=width, joinstyle="round"
        )
    axes.fill(*outline.hole.T, facecolor="white", edgecolor=COLOURS["line"], linewidth=0.3)
