"""The picture of a folded slice, drawn from plain arrays and without any global state of matplotlib."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path as Outline
from numpy.typing import ArrayLike, NDArray

from gyrify.mesh import GREY, WHITE
from gyrify.report.drawn_slice import DrawnSlice, closed_slice, periodic_slice
from gyrify.report.layout import (
    COLOURS,
    LINE_MM,
    OUTLINE,
    header,
    legend,
    line,
    page,
    scale_bar,
    write_header,
)
from gyrify.store.files import whole_file

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


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
    mark: str = "",
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
    mark : str
        What a reader of the numbers must know, below them.
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
    drawing = closed_slice(*slice_arrays) if period is None else periodic_slice(*slice_arrays, period)
    text = header(title, _index_text(gi, n_gyri, closing_radius), width_mm)
    text += [(mark, 7, "normal")] if mark else []
    holes = [x[[*loop, loop[0]]] for loop in _holes(triangles, outer)]
    return _drawn(drawing, text, [drawing.floor] if drawing.is_periodic else holes, width_mm)


def _drawn(
    drawing: DrawnSlice, text: list[tuple[str, int, str]], clamped: list[FloatArray], width_mm: float
) -> Figure:
    """Draw what a drawing holds, under a header."""
    figure, axes = page(drawing.low, drawing.high, width_mm, header_mm=2.8 + LINE_MM * len(text))
    draw_tissues(axes, drawing.points, drawing.cells, drawing.region)
    # Below the contour, so that the outline shows where it leaves the tissue.
    for piece in drawing.exposed:
        axes.add_line(line(piece, **OUTLINE))
    for thin in (*clamped, drawing.interface):
        axes.add_line(line(thin, color=COLOURS["line"], linewidth=0.4))
    axes.add_line(line(drawing.contour, color=COLOURS["line"], linewidth=0.9))
    write_header(figure, text)
    scale_bar(figure, drawing.low, drawing.high)
    edge: dict[str, Any] = {"edgecolor": COLOURS["line"], "linewidth": 0.4}
    grey = Patch(facecolor=COLOURS["grey"], label="grey matter", **edge)
    white = Patch(facecolor=COLOURS["white"], label="white matter", **edge)
    legend(figure, (grey, white, Line2D([], [], label="exposed outline", **OUTLINE)))
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
    # A lower level of compression writes a picture a third faster for a tenth more bytes.
    fast: dict[str, Any] = {"pil_kwargs": {"compress_level": 3}} if kind == "png" else {}
    # TrueType fonts in the file: journals ask for them, and Type 3 cannot be edited.
    with whole_file(target) as partial, mpl.rc_context({"svg.hashsalt": "gyrify", "pdf.fonttype": 42}):
        figure.savefig(partial, format=kind, dpi=dpi, metadata=undated, **fast)


def draw_tissues(axes: Axes, points: FloatArray, cells: IntArray, region: IntArray) -> None:
    """Fill each tissue as one shape, which is much faster than thousands of triangles and has no seams."""
    for kind, colour in ((WHITE, COLOURS["white"]), (GREY, COLOURS["grey"])):
        shape = tissue_path(points, boundary_loops(cells[region == kind]))
        # The limits are set already: `add_patch` would look for those of every edge.
        axes.add_artist(PathPatch(shape, facecolor=colour, edgecolor="none"))


def tissue_path(points: FloatArray, loops: Sequence[IntArray]) -> Outline:
    """Return closed loops of point indices as one path; holes run the other way round and stay empty."""
    vertices = [points[[*loop, loop[0]]] for loop in loops]
    codes = [[Outline.MOVETO, *[Outline.LINETO] * (len(loop) - 1), Outline.CLOSEPOLY] for loop in loops]
    return Outline(np.concatenate(vertices), np.concatenate(codes)) if vertices else Outline(np.zeros((0, 2)))


def boundary_loops(cells: IntArray) -> list[IntArray]:
    """Return the boundary of oriented triangles as closed loops of point indices, tissue on the left."""
    if not len(cells):
        return []
    edges = np.concatenate([cells[:, [0, 1]], cells[:, [1, 2]], cells[:, [2, 0]]])
    # An inner edge is also run through the other way, by the cell on its other side.
    key = edges.min(axis=1) * (int(edges.max(initial=0)) + 1) + edges.max(axis=1)
    order = np.argsort(key, kind="stable")
    is_new = np.append(True, np.diff(key[order]) > 0)
    alone = order[is_new & np.append(is_new[1:], True)]
    after = dict(edges[np.sort(alone)].tolist())
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
    return [loop for loop in boundary_loops(cells) if not np.isin(loop[0], contour)]


def _index_text(gi: float | None, n_gyri: int | None, closing_radius: float) -> str:
    """Return what the header says about folding."""
    index = "" if gi is None else f"GI {gi:.2f} (closing, {closing_radius:g} mm)"
    count = "" if n_gyri is None else f"{n_gyri} {'gyrus' if n_gyri == 1 else 'gyri'}"
    return "   ".join(part for part in (index, count) if part)
