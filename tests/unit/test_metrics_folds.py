"""Gyri, sulci and their depth against contours whose folds are known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gyrify.errors import ConfigError
from gyrify.metrics import find_folds, fold_wavelength, low_mode_shape, periodic_extrema, sulcal_depth


def polar(r: np.ndarray, stretch: float = 1.0) -> np.ndarray:
    angle = np.arange(len(r)) * (2 * np.pi / len(r))
    return np.column_stack([stretch * r * np.cos(angle), r * np.sin(angle)])


def rippled(k: int, amplitude: float, stretch: float = 1.2, n: int = 432) -> np.ndarray:
    angle = np.arange(n) * (2 * np.pi / n)
    return polar(45.0 + amplitude * np.cos(k * angle), stretch)


def slit_disc(width: float, depth: float, radius: float = 40.0) -> np.ndarray:
    """A disc with a parallel-walled slit of the given depth below its top."""
    half = math.asin(0.5 * width / radius)
    angle = np.linspace(math.pi / 2 + half, 2.5 * math.pi - half, 400)
    arc = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    bottom = radius - depth
    across = np.linspace(0.5 * width, -0.5 * width, 21)
    return np.concatenate([arc, np.column_stack([across, np.full(21, bottom)])])


@pytest.mark.parametrize("stretch", [1.0, 1.2, 2.0, 3.0])
def test_a_smooth_ellipse_has_no_folds(stretch: float) -> None:
    folds = find_folds(polar(np.full(216, 40.0), stretch))
    assert folds.n_gyri == 0
    assert len(folds.fundi) == 0
    assert np.ptp(folds.displacement) < 0.05


@pytest.mark.parametrize("mode", [2, 3, 4])
def test_a_slow_undulation_is_shape_and_not_folding(mode: int) -> None:
    angle = np.arange(216) * (2 * np.pi / 216)
    folds = find_folds(polar(40.0 + 2.0 * np.cos(mode * angle)))
    assert folds.n_gyri == 0


@pytest.mark.parametrize("k", [5, 6, 11, 16, 19, 30])
@pytest.mark.parametrize("amplitude", [0.25, 1.0, 3.0])
def test_ripples_are_counted(k: int, amplitude: float) -> None:
    folds = find_folds(rippled(k, amplitude))
    assert folds.n_gyri == k
    assert len(folds.fundi) == k


def test_ripples_below_the_prominence_are_not_counted() -> None:
    assert find_folds(rippled(16, 0.14, stretch=1.0)).n_gyri == 0
    assert find_folds(rippled(16, 0.14, stretch=1.0), gyrus_prominence=0.2).n_gyri == 16


def test_crowns_and_fundi_are_where_the_ripples_are_and_alternate() -> None:
    folds = find_folds(rippled(12, 2.0, stretch=1.0))
    for points, phase in ((folds.crown_points, 0.0), (folds.fundus_points, math.pi)):
        wave = 12 * np.arctan2(points[:, 1], points[:, 0]) - phase
        assert np.abs(np.angle(np.exp(1j * wave))).max() < 0.1
    order = np.argsort(np.concatenate([folds.crowns, folds.fundi]))
    assert np.all(np.diff((order < 12).astype(int)) != 0)


@pytest.mark.parametrize(("width", "depth"), [(1.0, 8.0), (3.0, 12.0), (6.0, 5.0)])
def test_a_slit_has_the_depth_below_the_arc_that_bridges_it(width: float, depth: float) -> None:
    """A disc of 10 mm enters by its sagitta, measured from the edges of the mouth."""
    radius, disc = 10.0, 40.0
    contour = slit_disc(width, depth)
    folds = find_folds(contour)
    assert folds.n_gyri == 1
    bottom = disc - depth
    assert folds.fundus_points[0, 1] == pytest.approx(bottom, abs=0.05)
    mouth = math.sqrt(disc**2 - (width / 2) ** 2)
    centre = mouth + math.sqrt(radius**2 - (width / 2) ** 2)
    middle = np.array([[0.0, bottom]])
    assert sulcal_depth(middle, contour, radius)[0] == pytest.approx(centre - radius - bottom, abs=0.01)
    at_fundus = sulcal_depth(folds.fundus_points, contour, radius)[0]
    assert centre - radius - bottom - 0.01 < at_fundus < depth + 0.01


def test_points_on_the_outline_have_no_depth() -> None:
    contour = polar(np.full(216, 40.0), 1.2)
    assert np.all(sulcal_depth(contour, contour) < 0.005)


def test_no_depth_is_negative() -> None:
    """Rounding would put about half of the points of a convex contour above its outline."""
    contour = polar(np.full(400, 40.0), 1.2)
    depth = sulcal_depth(contour, contour)
    assert (depth >= 0.0).all()
    assert depth.max() < 1e-2


def test_one_deep_slit_does_not_bend_the_shape() -> None:
    curve = low_mode_shape(slit_disc(3.0, 20.0)).contour()
    assert np.hypot(curve[:, 0], curve[:, 1]) == pytest.approx(np.full(400, 40.0), abs=0.02)


def test_the_shape_follows_the_ellipse_under_the_ripples() -> None:
    curve = low_mode_shape(rippled(16, 1.0)).contour() / [1.2, 1.0]
    radius = np.hypot(curve[:, 0], curve[:, 1])
    assert np.ptp(radius) < 0.1
    assert 45.0 < radius.mean() < 46.0


@pytest.mark.parametrize("shift", range(0, 40, 7))
def test_extrema_at_the_seam_count_once(shift: int) -> None:
    profile = np.roll(np.cos(np.arange(40) * (2 * np.pi / 20)), shift)
    maxima, minima = periodic_extrema(profile, 1.0)
    assert sorted((maxima - shift) % 40) == [0, 20]
    assert sorted((minima - shift) % 40) == [10, 30]


def test_prominence_is_measured_around_the_circle() -> None:
    """The middle bump rises 1 above its higher neighbour valley and 4 above the other."""
    profile = np.array([0.0, 5.0, 3.0, 4.0, 0.0, 2.0, 1.5, 2.5])
    assert list(periodic_extrema(profile, 1.5)[0]) == [1, 7]
    assert list(periodic_extrema(profile, 0.9)[0]) == [1, 3, 7]
    assert list(periodic_extrema(profile, 0.4)[0]) == [1, 3, 5, 7]
    for prominence in (0.4, 0.9, 1.5):
        maxima, minima = periodic_extrema(profile, prominence)
        assert len(maxima) == len(minima)


def test_twin_crowns_of_equal_height_are_one_gyrus() -> None:
    profile = np.tile([0.0, 1.0, 0.9, 1.0], 6)
    maxima, minima = periodic_extrema(profile, 0.3)
    assert len(maxima) == len(minima) == 6


def test_of_two_crowns_of_almost_equal_height_the_higher_one_is_the_gyrus() -> None:
    """They differ by three thousandths of the range; the first is the higher one, then the second."""
    profile = np.interp(np.arange(100), [0, 30, 50, 70, 100], [0.0, 1.0, 0.95, 0.997, 0.0])
    assert periodic_extrema(profile, 0.5)[0].tolist() == [30]
    assert periodic_extrema(profile[::-1], 0.5)[0].tolist() == [69]


def test_wavelength_is_the_outline_per_gyrus() -> None:
    assert fold_wavelength(300.0, 20) == 15.0
    assert fold_wavelength(300.0, 0) == math.inf


def test_bad_parameters_are_refused() -> None:
    with pytest.raises(ConfigError, match="gyrus_prominence = 0"):
        find_folds(rippled(8, 1.0), gyrus_prominence=0.0)
    with pytest.raises(ConfigError, match="samples = 3"):
        find_folds(rippled(8, 1.0), samples=3)
