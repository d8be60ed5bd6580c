"""The picture of a folded body in space: three views and a section, to one scale."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray

from gyrify.mesh import Mesh
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
from gyrify.report.surface_drawing import VIEWS, DrawnBody, paint, section_caption

FloatArray = NDArray[np.float64]
Bounds = tuple[FloatArray, FloatArray]

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
    body, lines = DrawnBody(mesh, points, depth), text or []
    low, high = body.bounds
    size, middle = high - low, 0.5 * (low + high)
    # two panels a row: side and above; front and section
    widest = max(size[0], size[1])
    scale = (width_mm - 2.0 * MARGIN_MM - _GAP) / (2.0 * widest)
    rows = [max(size[2], size[1]) * scale, size[2] * scale]
    top = 2.8 + LINE_MM * len(lines)
    height = top + sum(rows) + 2.0 * _CAPTION + _GAP + FOOTER_MM
    figure = new_figure(width_mm, height)
    write_header(figure, lines)
    second = MARGIN_MM + widest * scale + _GAP
    upper = height - top - rows[0] - _CAPTION
    lower = upper - rows[1] - _CAPTION - _GAP
    section = section_caption(float(middle[0]), float(widest))
    places = {
        "from the side": (MARGIN_MM, upper, rows[0]),
        "from above": (second, upper, rows[0]),
        "from the front": (MARGIN_MM, lower, rows[1]),
        section: (second, lower, rows[1]),
    }
    for number, (name, place) in enumerate(places.items()):
        frame = in_view(name, low, high)
        axes = panel(figure, place, scale, frame)
        _caption(figure, number, name, place)
        paint(axes, body.surface(name) if name in VIEWS else body.section(float(middle[0])))
    scale_bar(figure, low, high)
    legend(figure, tissue_patches())
    return figure


def tissue_patches() -> list[Patch]:
    """What the legend of a body names."""
    edge: dict[str, Any] = {"edgecolor": COLOURS["line"], "linewidth": 0.4}
    tissues = (("grey", "grey matter"), ("white", "white matter"))
    return [Patch(facecolor=COLOURS[name], label=label, **edge) for name, label in tissues]


def in_view(view: str, low: FloatArray, high: FloatArray) -> Bounds:
    """Bounds of a body in the plane of a view, or of a section across x."""
    if view not in VIEWS:
        return low[1:], high[1:]
    axes = np.array(VIEWS[view])
    ends = np.stack([axes[:2] @ low, axes[:2] @ high])
    return ends.min(axis=0), ends.max(axis=0)


def panel(figure: Figure, place: tuple[float, float, float], scale: float, frame: Bounds) -> Axes:
    """Axes without a frame, to scale, in the middle of a row.

    Parameters
    ----------
    figure : Figure
        The page.
    place : (float, float, float)
        Left and lower end, and height of the row [mm of the page].
    scale : float
        Millimetres of the page to one of the body.
    frame : (array, array)
        Lower left and upper right corner of what is shown [mm].
    """
    (left, bottom, height), (low, high) = place, frame
    width, tall = (high - low) * scale
    axes = add_axes(figure, (left, bottom + 0.5 * (height - tall), width, tall))
    axes.set_axis_off()
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    return axes


def _caption(figure: Figure, number: int, caption: str, place: tuple[float, float, float]) -> None:
    """Letter and caption above a panel."""
    left, bottom, height = place
    letter(figure, number, left, bottom + height + _CAPTION)
    write(figure, left + 4.0, bottom + height + _CAPTION, caption)
