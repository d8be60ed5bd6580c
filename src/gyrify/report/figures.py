"""The picture of a folded slice, drawn from plain arrays and without any global state of matplotlib."""

from __future__ import annotations

import math
import os
import textwrap
from pathlib import Path
from typing import Any, Final

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path as Outline
from numpy.typing import ArrayLike, NDArray

from gyrify.mesh import GREY, WHITE
from gyrify.report.sheet import closed_sheet, periodic_sheet

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

FONT: Final = "DejaVu Sans"
# Tissues differ in lightness, the outline in hue as well (Okabe-Ito): all eyes tell them apart, in print too.
COLOURS: Final = {"grey": "#a39c97", "white": "#f3eee3", "line": "#1f1f1f", "outline": "#d55e00"}
OUTLINE: Final[dict[str, Any]] = {
    "color": COLOURS["outline"],
    "linewidth": 1.0,
    "linestyle": (0, (3, 1.5)),
}
MM: Final = 1 / 25.4
MARGIN_MM: Final = 3.0
FOOTER_MM: Final = 13.0
LINE_MM: Final = 4.6
CHARACTERS_PER_MM: Final = 0.5


def folded_figure(
    points: ArrayLike,
    cells: ArrayLike,
    region: ArrayLike,
    contour: ArrayLike,
    interface: ArrayLike,
    *,
    closing_radius: float = 10.0,
    gi: float | None = None,
    n_gyri: int | None = None,
    title: str = "",
    width_mm: float = 90.0,
    period: float | None = None,
) -> Figure:
    """Draw a folded slice: tissues, contour, exposed outline, scale bar and gyrification index.

    Parameters
    ----------
    points : (n_points, 2) array_like
        Deformed positions [mm].
    cells : (n_cells, 3) int array_like
        Point indices of the triangles, positively oriented.
    region : (n_cells,) int array_like
        `gyrify.mesh.WHITE` or `gyrify.mesh.GREY`.
    contour, interface : (n,) int array_like
        Point indices of the outer contour and of the grey-white interface, in order: closed, or one period
        towards +x.
    closing_radius : float
        Radius of the closing whose outline is drawn as the exposed one [mm], > 0.
    gi, n_gyri : float and int, optional
        Gyrification index by that closing and number of gyri, to be printed.
    title : str
        Written above the picture, wrapped to its width.
    width_mm : float
        Width of the figure [mm]; 90 is one column of most journals.
    period : float, optional
        Period in x [mm] of a strip, of which one is drawn.

    Returns
    -------
    matplotlib.figure.Figure
        With an Agg canvas of its own; pass it to `save_figure`, or show it in a notebook.

    Raises
    ------
    ConfigError, MeshError
        If the closing radius is not positive, if the contour is malformed.
    """
    x = np.asarray(points, dtype=np.float64)
    triangles, tissue = np.asarray(cells, dtype=np.int64), np.asarray(region, dtype=np.int64)
    outer, inner = np.asarray(contour, dtype=np.int64), np.asarray(interface, dtype=np.int64)
    slice_arrays = (x, triangles, tissue, outer, inner, closing_radius)
    sheet = closed_sheet(*slice_arrays) if period is None else periodic_sheet(*slice_arrays, period)
    header = _header(title, _index_text(gi, n_gyri, closing_radius), width_mm)
    figure, axes = _page(sheet.low, sheet.high, width_mm, header_mm=2.8 + LINE_MM * len(header))
    _draw_tissues(axes, sheet.points, sheet.cells, sheet.region)
    # Below the contour, so that the outline shows where it leaves the tissue.
    for piece in sheet.exposed:
        axes.add_line(_line(piece, **OUTLINE))
    clamped = [sheet.floor] if sheet.is_periodic else [x[[*h, h[0]]] for h in _holes(triangles, outer)]
    for line in (*clamped, sheet.interface):
        axes.add_line(_line(line, color=COLOURS["line"], linewidth=0.4))
    axes.add_line(_line(sheet.contour, color=COLOURS["line"], linewidth=0.9))
    _write_header(figure, header)
    _scale_bar(figure, sheet.low, sheet.high)
    _legend(figure)
    return figure


def save_figure(figure: Figure, path: str | os.PathLike[str], *, dpi: int = 300) -> None:
    """Write a figure, by atomic rename, such that the same figure gives the same bytes.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        From `folded_figure`.
    path : path-like
        File to write; the suffix (``.png``, ``.pdf``, ``.svg``) decides the format.
    dpi : int
        Pixels per inch of a ``.png``.
    """
    target = Path(path)
    kind = target.suffix.lstrip(".").lower() or "png"
    undated = {"png": {"Software": None}, "pdf": {"CreationDate": None}, "svg": {"Date": None}}.get(kind)
    partial = target.with_name(target.name + ".partial")
    with mpl.rc_context({"svg.hashsalt": "gyrify"}):
        figure.savefig(partial, format=kind, dpi=dpi, metadata=undated)
    os.replace(partial, target)


def _page(low: FloatArray, high: FloatArray, width_mm: float, header_mm: float) -> tuple[Figure, Axes]:
    """Return a figure as high as the slice needs, with bare axes in mm between a header and a footer."""
    span = high - low
    inside = width_mm - 2 * MARGIN_MM
    tall = inside * float(span[1] / span[0])
    height_mm = header_mm + tall + FOOTER_MM
    figure = Figure(figsize=(width_mm * MM, height_mm * MM), facecolor="white")
    FigureCanvasAgg(figure)
    box = (MARGIN_MM / width_mm, FOOTER_MM / height_mm, inside / width_mm, tall / height_mm)
    axes = figure.add_axes(box)
    axes.set_axis_off()
    pad = 0.01 * span
    axes.set(
        xlim=(low[0] - pad[0], high[0] + pad[0]), ylim=(low[1] - pad[1], high[1] + pad[1]), aspect="equal"
    )
    return figure, axes


def _draw_tissues(axes: Axes, points: FloatArray, cells: IntArray, region: IntArray) -> None:
    """Fill each tissue as one shape, which is much faster than thousands of triangles and has no seams."""
    for kind, colour in ((WHITE, COLOURS["white"]), (GREY, COLOURS["grey"])):
        shape = _tissue_outline(points, cells[region == kind])
        axes.add_patch(PathPatch(shape, facecolor=colour, edgecolor="none"))


def _tissue_outline(points: FloatArray, cells: IntArray) -> Outline:
    """Return the boundary of some cells as one path; holes run the other way round and stay empty."""
    vertices, codes = [], []
    for loop in _boundary_loops(cells):
        vertices.append(points[[*loop, loop[0]]])
        codes += [Outline.MOVETO, *[Outline.LINETO] * (len(loop) - 1), Outline.CLOSEPOLY]
    return Outline(np.concatenate(vertices), codes) if vertices else Outline(np.zeros((0, 2)))


def _boundary_loops(cells: IntArray) -> list[IntArray]:
    """Return the boundary of oriented triangles as closed loops of point indices, tissue on the left."""
    edges = np.concatenate([cells[:, [0, 1]], cells[:, [1, 2]], cells[:, [2, 0]]])
    n = int(edges.max(initial=0)) + 1
    # An inner edge is also run through the other way, by the cell on its other side.
    alone = ~np.isin(edges[:, 0] * n + edges[:, 1], edges[:, 1] * n + edges[:, 0])
    after = dict(edges[alone].tolist())
    loops = []
    while after:
        start, point = after.popitem()
        loop = [start]
        while point != start:
            loop.append(point)
            point = after.pop(point)
        loops.append(np.array(loop))
    return loops


def _holes(cells: IntArray, contour: IntArray) -> list[IntArray]:
    """Return the boundary loops of the mesh other than its contour."""
    return [loop for loop in _boundary_loops(cells) if not np.isin(loop[0], contour)]


def _line(line: FloatArray, **style: Any) -> Line2D:
    """Return a line through vertices."""
    return Line2D(line[:, 0], line[:, 1], solid_joinstyle="round", **style)


def _index_text(gi: float | None, n_gyri: int | None, closing_radius: float) -> str:
    """Return what the header says about folding."""
    index = "" if gi is None else f"GI {gi:.2f} (closing, {closing_radius:g} mm)"
    count = "" if n_gyri is None else f"{n_gyri} {'gyrus' if n_gyri == 1 else 'gyri'}"
    return "   ".join(part for part in (index, count) if part)


def _header(title: str, text: str, width_mm: float) -> list[tuple[str, int, str]]:
    """Return the lines above the picture with size and weight, the title wrapped to the width."""
    lines = [(line, 9, "bold") for line in textwrap.wrap(title, int(CHARACTERS_PER_MM * width_mm))]
    return [*lines, (text, 8, "normal")] if text else lines


def _write_header(figure: Figure, lines: list[tuple[str, int, str]]) -> None:
    """Write lines at the upper left."""
    width_mm, height_mm = figure.get_size_inches() / MM
    for number, (line, size, weight) in enumerate(lines):
        top = 1 - (2.0 + LINE_MM * number) / height_mm
        style: dict[str, Any] = {
            "fontsize": size,
            "fontweight": weight,
            "family": FONT,
            "color": COLOURS["line"],
        }
        figure.text(MARGIN_MM / width_mm, top, line, va="top", ha="left", **style)


def _scale_bar(figure: Figure, low: FloatArray, high: FloatArray) -> None:
    """Draw a bar of a round length, about a fifth of the slice, at the left of the footer."""
    length = _round_length(0.2 * float(high[0] - low[0]))
    to_pixels = figure.axes[0].transData.transform
    width_mm, height_mm = figure.get_size_inches() / MM
    start = MARGIN_MM / width_mm
    end = start + float(np.ptp(to_pixels([(0.0, 0.0), (length, 0.0)])[:, 0])) / figure.bbox.width
    y = 0.56 * FOOTER_MM / height_mm
    figure.add_artist(
        Line2D([start, end], [y, y], linewidth=2.0, solid_capstyle="butt", color=COLOURS["line"])
    )
    style: dict[str, Any] = {"fontsize": 8, "family": FONT, "color": COLOURS["line"]}
    figure.text(0.5 * (start + end), y - 1.2 / height_mm, f"{length:g} mm", va="top", ha="center", **style)


def _round_length(wanted: float) -> float:
    """Return the largest of 1, 2, 5 times a power of ten that is not above ``wanted``."""
    power = 10.0 ** math.floor(math.log10(wanted))
    return max(step * power for step in (1, 2, 5) if step * power <= wanted * (1 + 1e-9))


def _legend(figure: Figure) -> None:
    """Name the tissues and the dashed outline at the lower right."""
    edge: dict[str, Any] = {"edgecolor": COLOURS["line"], "linewidth": 0.4}
    handles = [
        Patch(facecolor=COLOURS["grey"], label="grey matter", **edge),
        Patch(facecolor=COLOURS["white"], label="white matter", **edge),
        Line2D([], [], label="exposed outline", **OUTLINE),
    ]
    figure.legend(
        handles=handles,
        loc="center right",
        bbox_to_anchor=(1.0, 0.5 * FOOTER_MM * MM / figure.get_figheight()),
        ncols=2,
        frameon=False,
        prop={"family": FONT, "size": 7},
        handlelength=1.8,
        columnspacing=1.2,
        borderaxespad=0.3,
    )
