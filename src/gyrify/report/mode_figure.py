"""The picture of the onset of folding: the state that loses stability, and the mode that it leaves along."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike

from gyrify.report.layout import (
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
from gyrify.solve.stability import Onset

# Largest displacement of the drawn mode, over the width of the slice.
AMPLITUDE: Final = 0.03
WIDTH_MM: Final = 90.0
_THIN: Final[dict[str, Any]] = {"color": COLOURS["line"], "linewidth": 0.4}
_THICK: Final = {**_THIN, "linewidth": 0.9}


def wave_words(onset: Onset) -> str:
    """What the mode of an onset moves, in words."""
    if onset.mode_number == 0:
        return onset.kind
    words = f"mode {onset.mode_number}, wavelength {onset.wavelength:.3g} mm"
    return words if onset.kind == "fold" else f"{words}, {onset.kind}"


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
    lines = ModeLines.of(points, mode, contour, interface, clamped, period)
    low, high = lines.frame
    text = header(title, subtitle, WIDTH_MM)
    figure, axes = page(low, high, WIDTH_MM, header_mm=2.8 + LINE_MM * len(text))
    lines.draw(axes)
    write_header(figure, text)
    scale_bar(figure, low, high)
    legend(figure, mode_handles())
    return figure


@dataclass(frozen=True, eq=False)
class ModeLines:
    """Lines of a state and of the same state displaced along a mode, (n, 2) each [mm]."""

    before: FloatArray
    contour: FloatArray
    interface: FloatArray
    clamped: FloatArray

    @staticmethod
    def of(
        points: ArrayLike,
        mode: ArrayLike,
        contour: ArrayLike,
        interface: ArrayLike,
        clamped: ArrayLike,
        period: float | None = None,
    ) -> ModeLines:
        """Lines from the arrays of `mode_figure`."""
        x, v = np.asarray(points, dtype=np.float64), np.asarray(mode, dtype=np.float64)
        outer, inner, held = (np.asarray(ids, dtype=np.int64) for ids in (contour, interface, clamped))
        width = float(np.ptp(x[outer, 0]))
        displaced = x + AMPLITUDE * width / float(np.linalg.norm(v[outer], axis=1).max()) * v
        ways = (x[outer], displaced[outer], displaced[inner], x[held])
        return ModeLines(*(_ended(vertices, period) for vertices in ways))

    @property
    def frame(self) -> tuple[FloatArray, FloatArray]:
        """Corners [mm] of what is to be seen."""
        low, high = self.contour.min(axis=0), self.contour.max(axis=0)
        return np.minimum(low, self.clamped.min(axis=0)), high

    def draw(self, axes: Axes) -> None:
        """Draw the state dashed, and displaced in full lines."""
        for vertices, style in ((self.interface, _THIN), (self.clamped, _THIN), (self.before, OUTLINE)):
            axes.add_line(line(vertices, **style))
        axes.add_line(line(self.contour, **_THICK))


def mode_handles() -> tuple[Line2D, Line2D]:
    """What the legend names."""
    before = Line2D([], [], label="state at onset", **OUTLINE)
    return before, Line2D([], [], label="with its mode", **_THICK)


def _ended(vertices: FloatArray, period: float | None) -> FloatArray:
    """The line up to where it starts again."""
    shift = (0.0, 0.0) if period is None else (period, 0.0)
    return np.concatenate([vertices, np.add(vertices[:1], shift)])
