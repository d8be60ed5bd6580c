"""Metrics of a strip: one period of a contour that runs towards +x, the tissue below it.

All lengths are per period. Exposed lengths are those of a body of n + 1 periods, cut vertically at the
deepest point of the contour and level far below, less those of a body of n periods and of the period on the
lower side: what the cut sides add is the same in both. The convex hull is the level line on the highest
crowns, one period long.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
import shapely

from gyrify.metrics.contour import (
    BLOCK,
    QUARTER_SEGMENTS,
    FloatArray,
    filled,
    offset_outline,
)
from gyrify.metrics.folds import Folds, periodic_extrema
from gyrify.metrics.gap import DETOUR
from gyrify.metrics.gyri import GyrusShapes, gyrus_shapes
from gyrify.metrics.gyrification import at_least_hull, closing_length, exposed_length
from gyrify.metrics.sawtooth import without_sawteeth
from gyrify.metrics.sulci import depth_below
from gyrify.metrics.thickness import thickness_at_folds

# Relative to the length of the contour, as in `gyrify.metrics.gap`.
_ROUNDING = 1e-9
# Radius over the period above which the closing is the level line on the highest crowns, to 1e-5 of it, and
# so many periods a disc is tried on at most.
_LARGEST = 100.0
# A touch is judged to this many periods where the disc is larger.
_WIDE = 10.0


@dataclass(frozen=True, eq=False)
class Strip:
    """One period of a contour; see `gyrify.metrics.deformed`, and `measure_valid` for the parameters.

    Heights are measured from the mean level of the contour. The gap counts neighbours as in
    `gyrify.metrics.min_gap`, images included; a contour without folds has none, and it is infinite.
    """

    contour: FloatArray
    interface: FloatArray
    period: float
    closing_radius: float
    gyrus_prominence: float
    samples: int
    earlier: bool = False
    is_closed: ClassVar[bool] = False

    @cached_property
    def line(self) -> FloatArray:
        """The contour from its deepest vertex on."""
        return _from_lowest(self.contour, self.period)

    @cached_property
    def crosses_itself(self) -> bool:
        return not shapely.linestrings(_repeated(self.line, self.period, range(-1, 3))).is_simple

    @cached_property
    def radius(self) -> float:
        """Radius of the disc that is used [mm]."""
        return self.closing_radius if self.earlier else min(self.closing_radius, _LARGEST * self.period)

    @cached_property
    def _lengths(self) -> tuple[float, float, shapely.LinearRing]:
        return _exposed_lengths(self.line, self.period, self.radius)

    @cached_property
    def length(self) -> float:
        return float(_arc(self.line, self.period)[-1])

    @property
    def hull_length(self) -> float:
        return self.period

    @cached_property
    def closed_length(self) -> float:
        closing = self._lengths[0]
        return closing if self.earlier else at_least_hull(closing, self.period, self.radius)

    @property
    def exposed_length(self) -> float:
        return self._lengths[1]

    @cached_property
    def folds(self) -> Folds:
        return _folds(self.line, self.period, self.gyrus_prominence, self.samples, earlier=self.earlier)

    @cached_property
    def depth(self) -> FloatArray:
        fundi = self.folds.fundus_points
        return depth_below(fundi, self._lengths[2], self.radius) if self.folds.n_gyri else np.zeros(1)

    @cached_property
    def thickness(self) -> tuple[float, float]:
        inner = _repeated(self.interface, self.period, range(-1, 3))
        return thickness_at_folds(self.folds, inner, closed=False)

    @cached_property
    def gyri(self) -> GyrusShapes:
        return gyrus_shapes(self.folds, closed=False)

    @cached_property
    def gap(self) -> float:
        return 0.0 if self.crosses_itself else _gap(self.line, self.period)


def _repeated(line: FloatArray, period: float, periods: range) -> FloatArray:
    """Return copies of one period, in order from left to right."""
    return np.concatenate([line + np.array([k * period, 0.0]) for k in periods])


def _arc(line: FloatArray, period: float) -> FloatArray:
    """Return the (n + 1,) arc length [mm] from the first vertex to each one and to the end of the period."""
    edges = np.diff(np.concatenate([line, line[:1] + np.array([period, 0.0])]), axis=0)
    return np.concatenate([[0.0], np.cumsum(np.hypot(edges[:, 0], edges[:, 1]))])


def _folds(
    line: FloatArray, period: float, prominence: float, samples: int, *, earlier: bool = False
) -> Folds:
    """Return gyri and sulci: extrema of the height above the mean level."""
    arc = _arc(line, period)
    at = np.sort(np.concatenate([np.arange(samples) * (arc[-1] / samples), arc[1:-1]]))
    end = line[0] + np.array([period, 0.0])
    points = np.column_stack([np.interp(at, arc, np.append(line[:, i], end[i])) for i in (0, 1)])
    height = np.append(line[:, 1], end[1])
    level = float(np.sum(np.diff(arc) * 0.5 * (height[1:] + height[:-1])) / arc[-1])
    above = points[:, 1] - level
    vertex = np.interp(at, arc, np.arange(len(arc)))
    extrema = periodic_extrema(above, prominence)
    found = (*extrema, 0) if earlier else without_sawteeth(above, vertex, len(line), *extrema)
    return Folds(points, above, *found)


def strip_sawteeth(contour: FloatArray, period: float, prominence: float, samples: int) -> int:
    """Crowns of one period that are no gyri; parameters as in `gyrify.metrics.measure`."""
    return _folds(_from_lowest(contour, period), period, prominence, samples).n_sawteeth


def strip_closing_outline(contour: FloatArray, period: float, closing_radius: float) -> list[FloatArray]:
    """Outline of the closing along one period and a little more on both sides, in pieces, to draw it.

    Parameters
    ----------
    contour : (n, 2) float array
        One period of the contour towards +x [mm].
    period : float
        Period in x [mm], > 0.
    closing_radius : float
        Radius of the closing [mm], > 0.

    Returns
    -------
    list of (m, 2) float arrays
        Vertices of each piece [mm].
    """
    line, radius = _from_lowest(contour, period), min(closing_radius, _LARGEST * period)
    body = _body(line, period, _count(line, period, radius) + 4, radius)
    closed = offset_outline(body, radius, QUARTER_SEGMENTS)
    outline = shapely.Polygon(closed).buffer(-radius, quad_segs=QUARTER_SEGMENTS).exterior
    margin, left = 0.1 * period, float(contour[0, 0])
    below, above = float(line[0, 1]) - radius, float(line[:, 1].max()) + radius
    piece = shapely.clip_by_rect(outline, left - margin, below, left + period + margin, above)
    merged = shapely.line_merge(piece) if piece.geom_type == "MultiLineString" else piece
    return [shapely.get_coordinates(part) for part in shapely.get_parts(merged)]


def _from_lowest(contour: FloatArray, period: float) -> FloatArray:
    """Return the period that starts at the deepest vertex."""
    lowest = int(np.argmin(contour[:, 1]))
    return np.concatenate([contour[lowest:], contour[:lowest] + np.array([period, 0.0])])


def _exposed_lengths(
    line: FloatArray, period: float, radius: float
) -> tuple[float, float, shapely.LinearRing]:
    """Return the lengths of the closing's outline and of the exposed contour, and the offset outline.

    The period from ``line[0]``, the deepest vertex, lies in the middle of the body whose outline is returned.
    """
    n = _count(line, period, radius)
    bodies = [_body(line, period, count, radius) for count in (n, n + 1)]
    offsets = [offset_outline(body, radius, QUARTER_SEGMENTS) for body in bodies]
    closing = closing_length(offsets[1], radius) - closing_length(offsets[0], radius) - period
    size = _WIDE * period
    exposed = exposed_length(bodies[1], radius, size) - exposed_length(bodies[0], radius, size) - period
    return closing, exposed, offsets[1]


def _count(line: FloatArray, period: float, radius: float) -> int:
    """Return so many periods that a disc, wherever it lies, feels at most one of the ends."""
    overhang = float(np.ptp(line[:, 0])) - period
    return 1 + math.ceil((4 * radius + 2 * max(overhang, 0.0)) / period)


def _body(line: FloatArray, period: float, count: int, radius: float) -> shapely.Polygon:
    """Return some periods of tissue above a level floor that is farther from the contour than any disc."""
    top = _repeated(line, period, range(-(count // 2), count - count // 2))
    end = top[:1] + np.array([count * period, 0.0])
    floor = float(line[0, 1]) - 2.0 * float(np.ptp(line[:, 1])) - 4.0 * radius
    corners = np.array([[end[0, 0], floor], [top[0, 0], floor]])
    return filled(np.concatenate([top, end, corners]))


def _gap(line: FloatArray, period: float) -> float:
    """Return the smallest distance from a vertex of the period to an edge, images included, no neighbours."""
    arc = _arc(line, period)
    plane = line[:, 0] + 1j * line[:, 1]
    edge = np.diff(np.append(plane, plane[0] + period))
    lengths = np.abs(edge)
    backwards = np.conj(edge) / lengths
    smallest = math.inf
    every = np.arange(len(line))
    for block in np.array_split(every, 1 + len(every) ** 2 // BLOCK):
        for image in (-1, 0, 1):
            local = (plane[block, None] - plane - image * period) * backwards
            along = np.clip(local.real, 0.0, lengths)
            distance = np.hypot(local.real - along, local.imag)
            way = np.abs(arc[:-1] + image * arc[-1] + along - arc[block, None])
            apart = way > DETOUR * distance + _ROUNDING * arc[-1]
            smallest = min(smallest, float(np.min(distance[apart], initial=np.inf)))
    return smallest


def strip_sulcal_depth(contour: FloatArray, period: float, closing_radius: float) -> FloatArray:
    """Depth of the points of a strip's contour below the outline of the closing.

    Parameters
    ----------
    contour : (n, 2) float array
        One period of the contour towards +x [mm].
    period : float
        Period in x [mm], > 0.
    closing_radius : float
        Radius of the closing [mm], > 0.

    Returns
    -------
    (n,) float array
        Shortest distance to the outline [mm]; 0 on it.
    """
    lowest = int(np.argmin(contour[:, 1]))
    line = _from_lowest(contour, period)
    radius = min(closing_radius, _LARGEST * period)
    body = _body(line, period, _count(line, period, radius) + 1, radius)
    return np.roll(depth_below(line, offset_outline(body, radius), radius), lowest)
