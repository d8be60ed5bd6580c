"""Pictures of a study of convergence: metrics against the resolution, and the folded shapes side by side."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, MaxNLocator, NullLocator
from numpy.typing import NDArray

from gyrify.convergence import Convergence, Family, Level
from gyrify.convergence.plan import resolution
from gyrify.report.figures import save_figure
from gyrify.report.layout import COLOURS
from gyrify.store.history import History

FloatArray = NDArray[np.float64]

# Okabe and Ito's colours, told apart by every common colour vision; markers tell them apart too.
HUES: Final = ("#0072B2", "#D55E00", "#009E73")
MARKERS: Final = ("o", "s", "^")
_SHARED: Final = (
    ("gyri", ("n_gyri",)),
    ("growth time", ("visible_growth_time", "onset_growth_time")),
    ("sulcal depth [mm]", ("sulcal_depth_mm_max", "sulcal_depth_mm_mean")),
)
PANELS: Final[dict[int, tuple[tuple[str, tuple[str, ...]], ...]]] = {
    2: (
        ("GI", ("gi_closing", "gi_hull")),
        ("GI, exposed", ("gi_exposed",)),
        *_SHARED,
        ("elastic energy [mJ/mm]", ("elastic_energy_mJ_per_mm",)),
    ),
    3: (
        ("GI by area", ("gi_area_closing", "gi_area_hull")),
        ("GI of sections", ("gi_sections",)),
        *_SHARED,
        ("elastic energy [mJ]", ("elastic_energy_mJ",)),
    ),
}
_RESOLUTIONS: Final = {
    "mesh": "distance of contour nodes [mm]",
    "increments": "increment / duration of growth",
    "contact": "contact distance [mm]",
}


@dataclass(frozen=True, eq=False)
class Shape:
    """Lines of a deformed slice.

    Attributes
    ----------
    contour, interface, clamped : (n, 2) float arrays
        Positions along the lines, in order [mm].
    period : float or None
        Period in x [mm] of a strip, None for a ring.
    """

    contour: FloatArray
    interface: FloatArray
    clamped: FloatArray
    period: float | None = None

    @staticmethod
    def of(history: History) -> Shape:
        """Lines of the last state of a run."""
        x, mesh = history.points(), history.mesh
        return Shape(x[mesh.contour], x[mesh.interface], x[mesh.clamped], mesh.period)

    def polygon(self, line: FloatArray) -> FloatArray:
        """A line as a polygon; that of a strip is closed along the clamped side."""
        if self.period is None:
            return np.concatenate([line, line[:1]])
        floor = float(self.clamped[:, 1].min())
        end = line[:1] + np.array([[self.period, 0.0]])
        return np.concatenate([line, end, [[end[0, 0], floor], [line[0, 0], floor]]])


def write_pictures(convergence: Convergence, folder: Path) -> list[Path]:
    """Write ``<subject>-metrics.png``, and in the plane ``<subject>-shapes.png``, for every subject.

    Parameters
    ----------
    convergence : Convergence
        The study.
    folder : Path
        Where to.

    Returns
    -------
    list of Path
        The files.
    """
    files = []
    for family in convergence.families:
        if not any(level.is_complete for level in family.levels):
            continue
        drawn = {"metrics": metrics_figure}
        if convergence.config.geometry.n_dim == 2:
            drawn["shapes"] = shapes_figure
        for kind, draw in drawn.items():
            files.append(folder / f"{family.subject}-{kind}.png")
            save_figure(draw(family), files[-1], dpi=200)
    return files


def metrics_figure(family: Family) -> Figure:
    """Every metric against what is halved from level to level; dashed, the limit where there is an order."""
    figure = Figure(figsize=(8.4, 4.8), layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    n_dim = family.levels[0].config.geometry.n_dim
    for axes, (label, keys) in zip(figure.subplots(2, 3).ravel(), PANELS[n_dim], strict=True):
        _panel(axes, family, keys)
        axes.set_title(label, fontsize=9, loc="left")
    refined = _RESOLUTIONS[family.subject]
    if family.subject == "mesh" and n_dim == 3:
        refined = "edge on the outer surface [mm]"
    figure.supxlabel(f"{refined} (finer to the right)", fontsize=9)
    return figure


def shapes_figure(family: Family) -> Figure:
    """Folded shapes of the levels side by side, at one scale."""
    levels = [level for level in family.levels if level.is_complete]
    shapes = [Shape.of(History.load(level.folder)) for level in levels]
    return slices_figure(shapes, [_title(level, family) for level in levels])


def slices_figure(shapes: Sequence[Shape], names: Sequence[str], columns: int = 4) -> Figure:
    """Folded slices side by side, at one scale.

    Parameters
    ----------
    shapes : sequence of Shape
        The slices.
    names : sequence of str
        What to write above each.
    columns : int
        Most slices in a row.

    Returns
    -------
    matplotlib.figure.Figure
    """
    width = min(columns, len(shapes))
    height = -(-len(shapes) // width)
    outlines = np.concatenate([shape.polygon(shape.contour) for shape in shapes])
    low, high = outlines.min(axis=0), outlines.max(axis=0)
    size = 2.6 * width, height * (0.45 + 2.6 * float((high[1] - low[1]) / (high[0] - low[0])))
    figure = Figure(figsize=size, layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    panels = figure.subplots(height, width, squeeze=False).ravel()
    for axes in panels:
        axes.set_axis_off()
    pad = 0.02 * (high - low)
    for axes, shape, name in zip(panels, shapes, names, strict=False):
        _draw(axes, shape)
        axes.set(xlim=(low[0] - pad[0], high[0] + pad[0]), ylim=(low[1] - pad[1], high[1] + pad[1]))
        axes.set_aspect("equal")
        axes.set_title(name, fontsize=8, color=COLOURS["line"])
    return figure


def _panel(axes: Axes, family: Family, keys: Sequence[str]) -> None:
    sizes = np.array([resolution(level.config, family.subject) for level in family.levels])
    names = {metric.key: metric.name for metric in family.metrics}
    for key, hue, marker in zip(keys, HUES, MARKERS, strict=False):
        verdict = family.verdicts[key]
        values = np.array([np.nan if value is None else value for value in verdict.values])
        axes.plot(sizes, values, marker=marker, color=hue, markersize=5, linewidth=1.2, label=names[key])
        if verdict.limit is not None:
            axes.axhline(verdict.limit, color=hue, linewidth=0.9, linestyle="--")
    if all(value is None for key in keys for value in family.verdicts[key].values):
        axes.clear()
        axes.set_axis_off()
        axes.text(0.5, 0.5, "no level has a value", ha="center", va="center", fontsize=8, color="0.4")
        return
    axes.set_xscale("log")
    axes.invert_xaxis()
    axes.xaxis.set_major_locator(FixedLocator(list(sizes)))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xticks(sizes, [f"{size:.3g}" for size in sizes])
    if keys == ("n_gyri",):
        axes.yaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    axes.tick_params(labelsize=8)
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(True, axis="y", color="0.92", linewidth=0.7)
    if len(keys) > 1:
        axes.legend(fontsize=7, frameon=False)


def _title(level: Level, family: Family) -> str:
    gi, gyri = level.metrics["gi_closing"], level.metrics["n_gyri"]
    return f"{level.name(family.subject)}\nGI {gi:.3f}, {gyri:.0f} gyri"


def _draw(axes: Axes, shape: Shape) -> None:
    """Fill cortex and white matter as the areas within the contour, the interface and the hole."""
    for points, colour in ((shape.contour, COLOURS["grey"]), (shape.interface, COLOURS["white"])):
        outline = shape.polygon(points)
        line = outline if shape.period is None else outline[:-2]
        axes.fill(outline[:, 0], outline[:, 1], facecolor=colour, edgecolor="none")
        axes.plot(line[:, 0], line[:, 1], color=COLOURS["line"], linewidth=0.5)
    if shape.period is None:
        hole = shape.clamped
        axes.fill(hole[:, 0], hole[:, 1], facecolor="white", edgecolor=COLOURS["line"], linewidth=0.4)
