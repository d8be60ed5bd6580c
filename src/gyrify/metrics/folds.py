"""Gyri and sulci: extrema of the normal displacement of the contour from its overall shape."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from gyrify.base.arguments import whole_number
from gyrify.metrics.contour import (
    FloatArray,
    following,
    require_positive,
    resample,
    ring_vertices,
    vertex_numbers,
)
from gyrify.metrics.order import ordered_contour
from gyrify.metrics.peaks import prominent_maxima
from gyrify.metrics.sawtooth import without_sawteeth
from gyrify.metrics.sulci import has_sulcus

# Undulations with up to this many periods around the brain are its shape; folds are five or more.
SHAPE_MODES = 4
# Points of the convex hull the shape is fitted to.
_SHAPE_SAMPLES = 512
# Slope that ranks equal heights, relative to their range.
_TIE = 1e-9


@dataclass(frozen=True, eq=False)
class LowModeShape:
    """The overall shape of a contour: an ellipse and a few slow undulations along its normal.

    Attributes
    ----------
    centre : (2,) float array
        Centre of the ellipse [mm].
    to_circle : (2, 2) float array
        Symmetric map [1/mm] that takes the ellipse to the unit circle.
    modes : (SHAPE_MODES + 1,) complex array
        Fourier coefficients [mm] of the undulation over the angle on that circle, of mode 0, 1, ….
    """

    centre: FloatArray
    to_circle: FloatArray
    modes: NDArray[np.complex128]

    def displacement(self, points: FloatArray) -> FloatArray:
        """Return the (n,) outward normal displacements [mm] of (n, 2) points, to first order."""
        height, phase = _elliptic(points, self.centre, self.to_circle)
        above: FloatArray = height - _undulation(self.modes, phase)
        return above

    def contour(self, samples: int = 400) -> FloatArray:
        """Return (samples, 2) points of the shape [mm], to draw it."""
        angle = np.arange(samples) * (2 * np.pi / samples)
        circle = np.column_stack([np.cos(angle), np.sin(angle)])
        normal = circle @ self.to_circle
        normal /= np.hypot(normal[:, 0], normal[:, 1])[:, None]
        undulation = _undulation(self.modes, np.exp(1j * angle))
        ellipse = self.centre + circle @ np.linalg.inv(self.to_circle)
        curve: FloatArray = ellipse + undulation[:, None] * normal
        return curve


@dataclass(frozen=True, eq=False)
class Folds:
    """Where a contour is folded.

    Attributes
    ----------
    points : (n_points, 2) float array
        The contour at equal arc length and at its vertices, in order [mm].
    displacement : (n_points,) float array
        Normal displacement from the low-mode shape [mm], positive outwards.
    crowns, fundi : (n_gyri,) int arrays
        Indices into ``points`` of the gyral crowns and sulcal fundi, ascending; they alternate along the
        contour.
    n_sawteeth : int
        Crowns that are no gyri, because they follow the points of the contour (`gyrify.metrics.sawtooth`).
    """

    points: FloatArray
    displacement: FloatArray
    crowns: NDArray[np.int64]
    fundi: NDArray[np.int64]
    n_sawteeth: int = 0

    @property
    def n_gyri(self) -> int:
        """Number of gyri, which is also the number of sulci."""
        return len(self.crowns)

    @property
    def crown_points(self) -> FloatArray:
        """(n_gyri, 2) positions of the crowns [mm]."""
        return self.points[self.crowns]

    @property
    def fundus_points(self) -> FloatArray:
        """(n_gyri, 2) positions of the fundi [mm]."""
        return self.points[self.fundi]


def find_folds(contour: ArrayLike, gyrus_prominence: float = 0.3, samples: int = 2000) -> Folds:
    """Find the bumps of a closed contour and the dents between them: its gyri and sulci, if it has any.

    Parameters
    ----------
    contour : (n, 2) array_like
        Vertices in order [mm], in either direction.
    gyrus_prominence : float
        How far a crown must stand out above the sulci beside it, and a fundus lie below its gyri [mm], > 0.
    samples : int
        Number of points at equal arc length the contour is resampled to, beside its vertices; at least 16.

    Returns
    -------
    Folds

    Raises
    ------
    ConfigError
        If the prominence or the number of samples is out of range.
    MeshError
        If the contour is malformed.

    See Also
    --------
    low_mode_shape : what the displacement is measured from.
    measure : counts them as gyri only if a sulcus lies below the convex hull by the prominence.
    periodic_extrema : the detection alone, for any periodic profile such as the surface of a strip.
    """
    gyrus_prominence, samples = require_detectable(gyrus_prominence, samples)
    vertices = ordered_contour(contour)
    return folds_about(low_mode_shape(vertices), vertices, gyrus_prominence, samples)


def gyri_of(vertices: FloatArray, gyrus_prominence: float, samples: int) -> Folds:
    """`find_folds` of a contour that is known to be one; none where nothing is a sulcus, as in `measure`."""
    hull = shapely.linestrings(vertices).convex_hull
    return folds_about(shape_of_hull(hull), vertices, gyrus_prominence, samples, hull)


def require_detectable(gyrus_prominence: object, samples: object) -> tuple[float, int]:
    """Return prominence and number of samples; raise `ConfigError` if gyri cannot be sought with them."""
    return require_positive("gyrus_prominence", gyrus_prominence), whole_number("samples", samples, 16)


def folds_about(
    shape: LowModeShape,
    contour: FloatArray,
    prominence: float,
    samples: int,
    hull: shapely.Polygon | None = None,
    *,
    earlier: bool = False,
) -> Folds:
    """`find_folds` about a shape that is known already; without a hull, bumps without sulci count too.

    ``earlier`` counts crowns that follow the points of the contour, as gyrify 0.1.0 did at first.
    """
    points = resample(contour, samples, keep_vertices=True)
    displacement = shape.displacement(points)
    extrema = periodic_extrema(displacement, prominence)
    numbers = vertex_numbers(contour, samples)
    found = (*extrema, 0) if earlier else without_sawteeth(displacement, numbers, len(contour), *extrema)
    crowns, fundi, n_sawteeth = found
    if hull is not None and not has_sulcus(points[fundi], hull, prominence):
        crowns = fundi = np.empty(0, dtype=np.int64)
    return Folds(points, displacement, crowns, fundi, n_sawteeth)


def low_mode_shape(contour: ArrayLike) -> LowModeShape:
    """Overall shape of a closed contour: what it would be without its folds.

    The convex hull is fitted, in which sulci do not show, so that a single deep sulcus does not bend the
    shape. The ellipse has the hull's area moments; the undulations are the hull's first Fourier modes about
    that ellipse.

    Parameters
    ----------
    contour : (n, 2) array_like
        Vertices in order [mm].

    Returns
    -------
    LowModeShape

    Raises
    ------
    MeshError
        If the contour is malformed.
    """
    return shape_of_hull(shapely.linestrings(ordered_contour(contour)).convex_hull)


def shape_of_hull(convex_hull: shapely.Polygon) -> LowModeShape:
    """`low_mode_shape` of a contour whose convex hull is known already."""
    hull = ring_vertices(convex_hull.exterior)
    centre, to_circle = _area_ellipse(hull)
    height, phase = _elliptic(resample(hull, _SHAPE_SAMPLES), centre, to_circle)
    turn = np.angle(following(phase) * np.conj(np.roll(phase, 1)))
    modes = (height * turn / turn.sum()) @ np.vander(np.conj(phase), SHAPE_MODES + 1, increasing=True)
    modes[1:] *= 2
    return LowModeShape(centre, to_circle, modes)


def periodic_extrema(profile: FloatArray, prominence: float) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Maxima and minima of a periodic profile that stand out by at least the prominence.

    Parameters
    ----------
    profile : (n,) float array
        One period [mm].
    prominence : float
        Smallest prominence [mm].

    Returns
    -------
    maxima, minima : int arrays
        Ascending indices; as many of one as of the other, and alternating.
    """
    # Of twin crowns of exactly the same height both would stand out: an imperceptible slope ranks them.
    ranked = profile + np.arange(len(profile)) * (_TIE * np.ptp(profile) / len(profile))
    return _periodic_maxima(ranked, prominence), _periodic_maxima(-ranked, prominence)


def fold_wavelength(exposed_length: float, n_gyri: int) -> float:
    """Mean distance between crowns along the exposed outline [mm]; infinite where nothing is folded."""
    return exposed_length / n_gyri if n_gyri else float("inf")


def _periodic_maxima(profile: FloatArray, prominence: float) -> NDArray[np.int64]:
    """Return the maxima; cut open at the lowest point, a period has the prominences it has on the circle."""
    lowest = int(np.argmin(profile))
    cut = np.concatenate([profile[lowest:], profile[: lowest + 1]])
    peaks = prominent_maxima(cut, prominence)
    return np.sort((peaks + lowest) % len(profile)).astype(np.int64)


def _area_ellipse(polygon: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return centre and map to the unit circle of the ellipse with the polygon's second area moments."""
    origin = polygon.mean(axis=0)
    a = polygon - origin
    b = following(a)
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    area = cross.sum() / 2
    centre = (a + b).T @ cross / (6 * area)
    s = a + b
    moment = ((a * cross[:, None]).T @ a + (b * cross[:, None]).T @ b + (s * cross[:, None]).T @ s) / (
        24 * area
    )
    variance, axes = np.linalg.eigh(moment - np.outer(centre, centre))
    # A full ellipse has a variance of a quarter of the squared semi-axis.
    return origin + centre, (axes * (0.5 / np.sqrt(variance))) @ axes.T


def _elliptic(
    points: FloatArray, centre: FloatArray, to_circle: FloatArray
) -> tuple[FloatArray, NDArray[np.complex128]]:
    """Return first-order heights [mm] of points above the ellipse and their unit phases around it."""
    mapped = (points - centre) @ to_circle
    radius = np.hypot(mapped[:, 0], mapped[:, 1])
    radius = np.where(radius > 0, radius, 1.0)
    unit = mapped / radius[:, None]
    slope = unit @ to_circle
    height = (radius - 1) / np.hypot(slope[:, 0], slope[:, 1])
    return height, unit[:, 0] + 1j * unit[:, 1]


def _undulation(modes: NDArray[np.complex128], phase: NDArray[np.complex128]) -> FloatArray:
    """Return the real Fourier series with coefficients of mode 0, 1, … at unit phases."""
    return np.asarray(np.polynomial.polynomial.polyval(phase, modes).real, dtype=np.float64)
