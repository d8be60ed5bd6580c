"""The picture of a folded body in space: three views and a section, to one scale."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray

from gyrify.mesh import Mesh
from gyrify.metrics.surface import vertex_normals
from gyrify.report.layout import (
    COLOURS,
    FOOTER_MM,
    LINE_MM,
    MARGIN_MM,
    legend,
    scale_bar,
    write_header,
)
from gyrify.report.plot.style import DOUBLE, add_axes, letter, new_figure, write
from gyrify.report.surface_drawing import VIEWS, draw_section, draw_surface

FloatArray = NDArray[np.float64]

_GAP: Final = 5.0
_CAPTION: Final = 4.5


def space_figure(
    mesh: Mesh,
    points: FloatArray,
    *,
    depth: FloatArray | None = None,
    text: list[tuple[str, int, str]] | None = None,
    width_mm: float = DOUBLE,
) -> Figure:
    """Draw a body in space from the side, from above and from the front, and cut across.

    Parameters
    ----------
    mesh : Mesh
        The reference mesh.
    points : (n_points, 3) float array
        Deformed positions [mm].
    depth : (n_contour,) float array, optional
        Depth of the points of the outer surface below its closing [mm]: sulci are drawn darker.
    text : list of (str, int, str)
        Lines above the picture, with size and weight.
    width_mm : float
        Width of the figure [mm].

    Returns
    -------
    matplotlib.figure.Figure
        With an Agg canvas of its own.
    """
    corners = mesh.unwrapped(mesh.faces) + (points - mesh.points)[mesh.faces]
    low, high = corners.reshape(-1, 3).min(axis=0), corners.reshape(-1, 3).max(axis=0)
    if mesh.period is not None:
        low[2] = min(float(points[:, 2].min()), float(low[2]))
    size = high - low
    # two panels a row: side and above; front and section
    scale = (width_mm - 2.0 * MARGIN_MM - _GAP) / (size[0] + max(size[0], size[1]))
    rows = [max(size[2], size[1]) * scale, size[2] * scale]
    lines = text or []
    top = 2.8 + LINE_MM * len(lines)
    height = top + sum(rows) + 2.0 * _CAPTION + _GAP + FOOTER_MM
    figure = new_figure(width_mm, height)
    write_header(figure, lines)
    faces = np.searchsorted(mesh.contour, mesh.faces)
    smooth = vertex_normals(mesh.contour.size, faces, corners)[faces].sum(axis=1)
    smooth /= np.linalg.norm(smooth, axis=1, keepdims=True)
    shade = None
    if depth is not None:
        # a dent of less than a hundredth of the body casts no shadow
        shade = depth[faces].mean(axis=1) / max(float(depth.max()), 0.01 * float(size.max()))
    second = MARGIN_MM + size[0] * scale + _GAP
    places = {
        "from the side": (MARGIN_MM, height - top - rows[0] - _CAPTION, 0),
        "from above": (second, height - top - rows[0] - _CAPTION, 0),
        "from the front": (MARGIN_MM, height - top - sum(rows) - 2.0 * _CAPTION - _GAP, 1),
    }
    for number, (name, (left, bottom, row)) in enumerate(places.items()):
        view = np.array(VIEWS[name])
        axes = _panel(figure, number, name, left, bottom, rows[row], scale, *_bounds(view, low, high))
        draw_surface(axes, corners, smooth, VIEWS[name], shade)
    middle = 0.5 * (low + high)
    left, bottom, row = second, places["from the front"][1], 1
    caption = f"section at x = {middle[0]:.3g} mm"
    axes = _panel(figure, 3, caption, left, bottom, rows[row], scale, low[1:], high[1:])
    if mesh.period is None:
        draw_section(axes, points, mesh.cells, mesh.region, 0, float(middle[0]))
    else:
        cells, x = _apart(mesh, points)
        draw_section(axes, x, cells, mesh.region, 0, float(middle[0]))
    scale_bar(figure, low, high)
    edge: dict[str, Any] = {"edgecolor": COLOURS["line"], "linewidth": 0.4}
    tissues = (("grey", "grey matter"), ("white", "white matter"))
    legend(figure, [Patch(facecolor=COLOURS[name], label=label, **edge) for name, label in tissues])
    return figure


def _apart(mesh: Mesh, points: FloatArray) -> tuple[NDArray[np.int64], FloatArray]:
    """Cells with corners of their own, those of one next to each other."""
    corners = mesh.cell_points + (points - mesh.points)[mesh.cells]
    n_cells, n_nodes, _ = corners.shape
    return np.arange(n_cells * n_nodes).reshape(n_cells, n_nodes), corners.reshape(-1, 3)


def _bounds(view: FloatArray, low: FloatArray, high: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Bounds of a body in the plane of a view."""
    ends = np.stack([view[:2] @ low, view[:2] @ high])
    return ends.min(axis=0), ends.max(axis=0)


def _panel(
    figure: Figure,
    number: int,
    caption: str,
    left: float,
    bottom: float,
    height: float,
    scale: float,
    low: FloatArray,
    high: FloatArray,
) -> Axes:
    """Axes without a frame, to scale, with letter and caption above."""
    width, tall = (high - low) * scale
    axes = add_axes(figure, (left, bottom + 0.5 * (height - tall), width, tall))
    axes.set_axis_off()
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    letter(figure, number, left, bottom + height + _CAPTION)
    write(figure, left + 4.0, bottom + height + _CAPTION, caption)
    return axes
