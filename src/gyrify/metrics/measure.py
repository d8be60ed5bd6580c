"""All metrics of one state in one call, sharing what they have in common."""

from __future__ import annotations

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
from gyrify.metrics.folds import folds_about, require_detectable, shape_of_hull
from gyrify.metrics.gap import simple_gap
from gyrify.metrics.gyri import gyrus_shapes
from gyrify.metrics.gyrification import closing_length, exposed_length
from gyrify.metrics.measures import Measures
from gyrify.metrics.order import notice_unfit, ordered_contour
from gyrify.metrics.sharpness import fold_sharpness
from gyrify.metrics.strip import measure_strip
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
        Period in x [mm] of a strip; see `gyrify.metrics.strip`.

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

    ``earlier`` measures as gyrify 0.1.0 did at first: bumps without sulci count as gyri, and the index by the
    closing exceeds the hull's by what chords miss of arcs.
    """
    closing_radius = require_positive("closing_radius", closing_radius)
    gyrus_prominence, samples = require_detectable(gyrus_prominence, samples)
    lengths = (closing_radius, gyrus_prominence, samples)
    if period is not None:
        return measure_strip(
            contour, interface, require_positive("period", period), *lengths, earlier=earlier
        )
    return _measure_ring(contour, interface, *lengths, earlier)


def _measure_ring(
    vertices: FloatArray,
    inner: FloatArray,
    closing_radius: float,
    gyrus_prominence: float,
    samples: int,
    earlier: bool,
) -> Measures:
    """Measure a closed contour."""
    crossing = not shapely.linearrings(vertices).is_simple
    tissue = filled(vertices) if crossing else shapely.Polygon(vertices)
    radius = closing_radius if earlier else fitting_radius(tissue, closing_radius)
    offset = offset_outline(tissue, radius, QUARTER_SEGMENTS if earlier else None)
    hull = tissue.convex_hull
    shape = shape_of_hull(hull)
    folds = folds_about(shape, vertices, gyrus_prominence, samples, None if earlier else hull)
    depth = depth_below(folds.fundus_points, offset, radius) if folds.n_gyri else np.zeros(1)
    crown, fundus = thickness_at_folds(folds, inner)
    gyri = gyrus_shapes(folds)
    length = float(edge_lengths(vertices).sum())
    exposed = exposed_length(tissue, radius, np.inf if earlier else mean_radius(tissue))
    return Measures(
        gi_hull=length / float(hull.length),
        gi_closing=length / closing_length(offset, radius, 0.0 if earlier else float(hull.length)),
        gi_exposed=length / exposed if exposed > 0 else float("inf"),
        closing_radius=float(closing_radius),
        n_gyri=folds.n_gyri,
        sulcal_depth_max=float(depth.max()),
        sulcal_depth_mean=float(depth.mean()),
        thickness_crown=crown,
        thickness_fundus=fundus,
        gyrus_width=gyri.mean_width,
        gyrus_flatness=gyri.mean_flatness,
        fold_sharpness=fold_sharpness(folds),
        contour_length=length,
        min_gap=0.0 if crossing else simple_gap(vertices),
        self_intersecting=crossing,
    )
