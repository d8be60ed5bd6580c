"""What a picture shows: a slice as it is, or one period of a strip with its neighbours, cut by the frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gyrify.metrics.contour import closing_of
from gyrify.metrics.periodic import strip_closing_outline

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class DrawnSlice:
    """Triangles and lines to draw; lengths in mm.

    Attributes
    ----------
    points : (n_points, 2) float array
        Deformed positions.
    cells : (n_cells, 3) int array
        Point indices of the triangles, positively oriented.
    region : (n_cells,) int array
        Tissue of each triangle.
    contour, interface : (n, 2) float arrays
        Vertices of the lines; a closed one ends where it starts.
    exposed : list of (n, 2) float arrays
        Pieces of the exposed outline.
    low, high : (2,) float arrays
        Corners of the frame.
    is_periodic : bool
        Whether the frame cuts the tissue on both sides.
    """

    points: FloatArray
    cells: IntArray
    region: IntArray
    contour: FloatArray
    interface: FloatArray
    exposed: list[FloatArray]
    low: FloatArray
    high: FloatArray
    is_periodic: bool = False

    @property
    def floor(self) -> FloatArray:
        """(2, 2) the clamped line of a strip, beyond the frame on both sides."""
        margin = 0.1 * (self.high[0] - self.low[0])
        return np.array([[self.low[0] - margin, self.low[1]], [self.high[0] + margin, self.low[1]]])


def closed_slice(
    points: FloatArray,
    cells: IntArray,
    region: IntArray,
    contour: IntArray,
    interface: IntArray,
    radius: float,
) -> DrawnSlice:
    """Return a slice in the frame of its exposed outline."""
    exposed = closing_of(points[contour], radius)
    outer, inner = (np.concatenate([line, line[:1]]) for line in (points[contour], points[interface]))
    low, high = exposed.min(axis=0), exposed.max(axis=0)
    return DrawnSlice(
        points, cells, region, outer, inner, [np.concatenate([exposed, exposed[:1]])], low, high
    )


def periodic_slice(
    points: FloatArray,
    cells: IntArray,
    region: IntArray,
    contour: IntArray,
    interface: IntArray,
    radius: float,
    period: float,
) -> DrawnSlice:
    """Return three periods of a strip in a frame as wide as the one in the middle.

    A cell belongs to the period of its first corner, and its other corners to the nearest images.
    """
    n_points = points.shape[0]
    images = np.arange(-2, 3)
    tiled = np.concatenate([points + np.array([k * period, 0.0]) for k in images])
    x = points[cells][:, :, 0]
    across = -np.round((x - x[:, :1]) / period).astype(np.int64)
    own = cells + (across + 2) * n_points
    left = float(points[contour[0], 0])
    outer, inner = (
        np.concatenate([points[line] + np.array([k * period, 0.0]) for k in images])
        for line in (contour, interface)
    )
    exposed = strip_closing_outline(points[contour], period, radius)
    top = max(float(piece[:, 1].max()) for piece in exposed)
    return DrawnSlice(
        tiled,
        np.concatenate([own + k * n_points for k in (-1, 0, 1)]),
        np.tile(region, 3),
        outer,
        inner,
        exposed,
        np.array([left, float(points[:, 1].min())]),
        np.array([left + period, top]),
        is_periodic=True,
    )
