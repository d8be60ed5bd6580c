"""All metrics of one state in one call, sharing what they have in common."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
import shapely
from numpy.typing import ArrayLike

from gyrify.metrics.contour import (
    QUARTER_SEGMENTS,
    FloatArray,
    edge_lengths,
    filled,
    fitting_radius,
    mean_radius,
    offset_outline,
    require_positive,
)
from gyrify.metrics.folds import Folds, folds_about, require_detectable, shape_of_hull
from gyrify.metrics.gap import simple_gap
from gyrify.metrics.gyri import GyrusShapes, gyrus_shapes
from gyrify.metrics.gyrification import closing_length, exposed_length
from gyrify.metrics.measures import Measures
from gyrify.metrics.order import notice_unfit, ordered_contour
from gyrify.metrics.periodic import Strip
from gyrify.metrics.sulci import depth_below
from gyrify.metrics.thickness import thickness_at_folds


def measure(
    contour: ArrayLike,
    interface: ArrayLike,
    closing_radius: float = 10.0,
    gyrus_prominence: float = 0.3,
    samples: int = 2000,
    period: float | None = None,
) -> Measures:
    """Measure one deformed state of a ring, or of one period of a strip.

    Parameters
    ----------
    contour : (n, 2) array_like
        Vertices of the outer contour in order [mm]: closed, or one period of it towards +x.
    interface : (m, 2) array_like
        Vertices of the grey-white interface in order [mm], likewise.
    closing_radius : float
        Radius of the morphological closing [mm], > 0.
    gyrus_prominence : float
        Smallest prominence of a gyrus [mm], > 0.
    samples : int
        Points of the arc-length resampling on which gyri are sought, at least 16.
    period : float, optional
        Period in x [mm] of a strip; see `gyrify.metrics.periodic`.

    Returns
    -------
    Measures

    Raises
    ------
    ConfigError
        If a parameter is out of range.
    MeshError
        If the contour or the interface is malformed, has a point twice or is not in order.

    Warns
    -----
    UserWarning
        If the closing radius is larger than the body or much smaller than its edges.
    """
    closing_radius = require_positive("closing_radius", closing_radius)
    is_closed = period is None
    vertices = ordered_contour(contour, closed=is_closed)
    inner = ordered_contour(interface, "The interface", closed=is_closed)
    if is_closed:
        notice_unfit(vertices, closing_radius)
    return measure_valid(vertices, inner, closing_radius, gyrus_prominence, samples, period)


def measure_valid(
    contour: FloatArray,
    interface: FloatArray,
    closing_radius: float,
    gyrus_prominence: float,
    samples: int,
    period: float | None,
    *,
    earlier: bool = False,
) -> Measures:
    """`measure` lines that are known to be contours, such as those of a stored state.

    ``earlier`` measures as gyrify 0.1.0 did: bumps without sulci and crowns that follow the points of
    the contour count as gyri, and the index by the closing exceeds the hull's by what chords miss of arcs.
    """
    closing_radius = require_positive("closing_radius", closing_radius)
    gyrus_prominence, samples = require_detectable(gyrus_prominence, samples)
    lengths = (closing_radius, gyrus_prominence, samples)
    if period is not None:
        line = Strip(contour, interface, require_positive("period", period), *lengths, earlier)
        return Measures.of(line)
    return Measures.of(Ring(contour, interface, *lengths, earlier))


@dataclass(frozen=True, eq=False)
class Ring:
    """A closed contour; see `gyrify.metrics.deformed`, and `measure_valid` for the parameters."""

    contour: FloatArray
    interface: FloatArray
    closing_radius: float
    gyrus_prominence: float
    samples: int
    earlier: bool = False
    is_closed: ClassVar[bool] = True

    @cached_property
    def crosses_itself(self) -> bool:
        return not shapely.linearrings(self.contour).is_simple

    @cached_property
    def tissue(self) -> shapely.Polygon:
        """What the contour encloses."""
        return filled(self.contour) if self.crosses_itself else shapely.Polygon(self.contour)

    @cached_property
    def radius(self) -> float:
        """Radius of the disc that is used [mm]."""
        return self.closing_radius if self.earlier else fitting_radius(self.tissue, self.closing_radius)

    @cached_property
    def offset(self) -> shapely.LinearRing:
        """Outline at this distance outside."""
        return offset_outline(self.tissue, self.radius, QUARTER_SEGMENTS if self.earlier else None)

    @cached_property
    def hull(self) -> shapely.Polygon:
        """Convex hull."""
        return self.tissue.convex_hull

    @cached_property
    def length(self) -> float:
        return float(edge_lengths(self.contour).sum())

    @cached_property
    def hull_length(self) -> float:
        return float(self.hull.length)

    @cached_property
    def closed_length(self) -> float:
        return closing_length(self.offset, self.radius, 0.0 if self.earlier else self.hull_length)

    @cached_property
    def exposed_length(self) -> float:
        return exposed_length(self.tissue, self.radius, np.inf if self.earlier else mean_radius(self.tissue))

    @cached_property
    def folds(self) -> Folds:
        hull = None if self.earlier else self.hull
        smooth = shape_of_hull(self.hull)
        return folds_about(
            smooth, self.contour, self.gyrus_prominence, self.samples, hull, earlier=self.earlier
        )

    @cached_property
    def depth(self) -> FloatArray:
        fundi = self.folds.fundus_points
        return depth_below(fundi, self.offset, self.radius) if self.folds.n_gyri else np.zeros(1)

    @cached_property
    def thickness(self) -> tuple[float, float]:
        return thickness_at_folds(self.folds, self.interface)

    @cached_property
    def gyri(self) -> GyrusShapes:
        return gyrus_shapes(self.folds)

    @cached_property
    def gap(self) -> float:
        return 0.0 if self.crosses_itself else simple_gap(self.contour)
