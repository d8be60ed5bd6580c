"""The picture of the onset of folding: the state that loses stability, and the mode that it leaves along."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike

from gyrify.report.page import (
    COLOURS,
    LINE_MM,
    OUTLINE,
    FloatArray,
    header,
    legend,
    line,
    page,
    scale_bar,
    write_header,
)

# Largest displacement of the drawn mode, over the width of the slice.
AMPLITUDE: Final = 0.03
WIDTH_MM: Final = 90.0


def mode_figure(
    points: ArrayLike,
    mode: ArrayLike,
    contour: ArrayLike,
    interface: ArrayLike,
    clamped: ArrayLike,
    *,
    title: str = "",
    subtitle: str = "",
    period: float | None = None,
) -> Figure:
    """Draw a state (dashed) and the same state displaced along a mode.

    Parameters
    ----------
    points : (n_points, 2) array_like
        Deformed positions of the state [mm].
    mode : (n_points, 2) array_like
        Mode, of any size.
    contour, interface, clamped : (n,) int array_like
        Point indices of the lines to draw, in order: closed, or one period towards +x.
    title, subtitle : str
        Written above the picture.
    period : float, optional
        Period in x [mm] of a strip.

    Returns
    -------
    matplotlib.figure.Figure
        Pass it to `gyrify.report.figures.save_figure`.
    """
    x, v = np.asarray(points, dtype=np.float64), np.asarray(mode, dtype=np.float64)
    outer, inner, held = (np.asarray(line, dtype=np.int64) for line in (contour, interface, clamped))
    width = float(np.ptp(x[outer, 0]))
    displaced = x + AMPLITUDE * width / float(np.linalg.norm(v[outer], axis=1).max()) * v
    low, high = displaced[outer].min(axis=0), displaced[outer].max(axis=0)
    low = np.minimum(low, x[held].min(axis=0))
    text = header(title, subtitle, WIDTH_MM)
    figure, axes = page(low, high, WIDTH_MM, header_mm=2.8 + LINE_MM * len(text))
    thin: dict[str, Any] = {"color": COLOURS["line"], "linewidth": 0.4}
    thick = {**thin, "linewidth": 0.9}
    for vertices, style in ((displaced[inner], thin), (x[held], thin), (x[outer], OUTLINE)):
        axes.add_line(line(_ended(vertices, period), **style))
    axes.add_line(line(_ended(displaced[outer], period), **thick))
    write_header(figure, text)
    scale_bar(figure, low, high)
    before = Line2D([], [], label="state at onset", **OUTLINE)
    legend(figure, (before, Line2D([], [], label="with its mode", **thick)))
    return figure


def _ended(vertices: FloatArray, period: float | None) -> FloatArray:
    """The line up to where it starts again."""
    shift = (0.0, 0.0) if period is None else (period, 0.0)
    return np.concatenate([vertices, np.add(vertices[:1], shift)])
