"""Metrics of one period of a strip against closed forms, wherever the period is cut."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from gyrify.errors import ConfigError
from gyrify.metrics import Measures, measure

PERIOD, DEPTH, WIDTH, RADIUS = 30.0, 4.0, 2.0, 10.0


def cut_at(line: np.ndarray, start: int) -> np.ndarray:
    """The same periodic line from another vertex on."""
    return np.concatenate([line[start:], line[:start] + np.array([PERIOD, 0.0])])


def straight(corners: list[tuple[float, float]], pieces: int = 8) -> np.ndarray:
    """Polyline through the corners and on to the first one a period further, each side in equal pieces."""
    ends = np.array([*corners, (corners[0][0] + PERIOD, corners[0][1])])
    t = np.linspace(0, 1, pieces, endpoint=False)[:, None]
    return np.concatenate([a + t * (b - a) for a, b in itertools.pairwise(ends)])


def cleft() -> np.ndarray:
    """A flat surface at y = 5 with one V-shaped sulcus, 2 mm wide and 4 mm deep."""
    return straight([(0, 5), (14, 5), (15, 1), (16, 5)])


def measured(line: np.ndarray, **arguments: float) -> Measures:
    return measure(line, line - np.array([0.0, 1.5]), RADIUS, period=PERIOD, **arguments)


@pytest.mark.parametrize("start", [0, 5, 12, 16, 19, 27])
def test_one_cleft(start: int) -> None:
    ours = measured(cut_at(cleft(), start))
    length = 28 + 2 * math.hypot(1, 4)
    # a disc of 10 mm rests on both lips and dips below them by its sagitta
    lip_to_lip, sagitta = 2 * RADIUS * math.asin(0.1), RADIUS - math.sqrt(99)
    assert ours.contour_length == pytest.approx(length, rel=1e-12)
    assert ours.gi_hull == pytest.approx(length / PERIOD, rel=1e-12)
    assert ours.gi_closing == pytest.approx(length / (28 + lip_to_lip), rel=1e-5)
    # up to where the disc touches within a thousandth of its radius
    assert ours.gi_exposed == pytest.approx(length / 28, rel=0.02)
    assert ours.n_gyri == 1
    assert ours.sulcal_depth_max == pytest.approx(DEPTH - sagitta, abs=2e-3)
    assert ours.sulcal_depth_mean == ours.sulcal_depth_max
    # to the interface: straight down from the flat, obliquely from the fundus, 1.5 mm times sin(atan(1/4))
    assert ours.thickness_crown == pytest.approx(1.5, abs=1e-9)
    assert ours.thickness_fundus == pytest.approx(1.5 / math.sqrt(17), rel=1e-9)
    assert not ours.self_intersecting


@pytest.mark.parametrize("start", [0, 5, 12, 16, 19, 27, 33])
def test_parallel_walls_are_as_far_apart_as_they_are(start: int) -> None:
    """A rectangular sulcus, 2 mm wide, also where the period is cut inside it."""
    line = straight([(0, 5), (14, 5), (14, 1), (16, 1), (16, 5)])
    ours = measured(cut_at(line, start))
    assert ours.min_gap == pytest.approx(WIDTH, rel=1e-12)
    assert ours.gi_hull == pytest.approx((PERIOD + 2 * DEPTH) / PERIOD, rel=1e-12)


@pytest.mark.parametrize("start", [0, 100, 250])
def test_waves(start: int) -> None:
    """Three waves of 1 mm: length by quadrature, depths of 2 mm less what a small disc still enters."""
    x = PERIOD * np.arange(600) / 600
    k = 2 * np.pi * 3 / PERIOD
    ours = measured(cut_at(np.stack([x, np.sin(k * x)], axis=1), start))
    fine = np.linspace(0, PERIOD, 200001)
    length = np.trapezoid(np.sqrt(1 + (k * np.cos(k * fine)) ** 2), fine)
    assert ours.contour_length == pytest.approx(length, rel=1e-5)
    assert ours.n_gyri == 3
    assert ours.gi_exposed > ours.gi_hull > ours.gi_closing > 1


def test_small_disc_follows_a_gentle_wave_everywhere() -> None:
    """Troughs of radius 1/(A k^2) = 2.5 mm are entered by a disc of 1 mm: everything is exposed."""
    x = PERIOD * np.arange(600) / 600
    k = 2 * np.pi * 3 / PERIOD
    line = np.stack([x, np.sin(k * x)], axis=1)
    ours = measure(line, line - np.array([0.0, 1.5]), 1.0, period=PERIOD)
    assert ours.gi_closing == pytest.approx(1.0, abs=1e-4)
    assert ours.gi_exposed == pytest.approx(1.0, abs=1e-3)
    assert ours.sulcal_depth_max == pytest.approx(0.0, abs=1e-3)


def test_flat_strip() -> None:
    x = PERIOD * np.arange(50) / 50
    ours = measured(np.stack([x, np.full(50, 5.0)], axis=1))
    assert ours.gi_hull == pytest.approx(1.0, rel=1e-12)
    assert ours.gi_closing == pytest.approx(1.0, rel=1e-9)
    assert ours.gi_exposed == pytest.approx(1.0, rel=1e-9)
    assert (ours.n_gyri, ours.sulcal_depth_max, ours.min_gap) == (0, 0.0, math.inf)
    assert (ours.thickness_crown, ours.thickness_fundus) == pytest.approx((1.5, 1.5))


def test_two_periods_are_twice_one() -> None:
    """The same surface described with the double period: twice the length and gyri, the same ratios."""
    line = cleft()
    twice = np.concatenate([line, line + np.array([PERIOD, 0.0])])
    one = measured(line)
    two = measure(twice, twice - np.array([0.0, 1.5]), RADIUS, period=2 * PERIOD)
    assert two.contour_length == pytest.approx(2 * one.contour_length, rel=1e-12)
    assert two.n_gyri == 2 * one.n_gyri
    for name in ("gi_hull", "gi_closing", "gi_exposed", "sulcal_depth_mean", "min_gap", "thickness_crown"):
        assert getattr(two, name) == pytest.approx(getattr(one, name), rel=1e-6), name


def test_overlap_with_an_image_is_seen() -> None:
    """One mushroom as wide as 1.2 periods: it crosses its images, not itself."""
    line = straight([(0, 0), (12, 0), (-3, 6), (33, 6), (18, 0), (29, 0)])
    ours = measured(line)
    assert ours.self_intersecting
    assert ours.min_gap == 0.0
    assert ours.contour_length > PERIOD


def test_overhanging_gyri_of_neighbouring_periods_nearly_touch() -> None:
    """A mushroom 29.5 mm wide in a period of 30 mm: its rims are 0.5 mm from those of its images."""
    line = straight([(0, 0), (12, 0), (0.25, 6), (29.75, 6), (18, 0), (29, 0)])
    ours = measured(line)
    assert not ours.self_intersecting
    assert ours.min_gap == pytest.approx(0.5, rel=1e-9)


def test_period_must_be_positive() -> None:
    with pytest.raises(ConfigError, match="period"):
        measure(cleft(), cleft() - 1.5, period=-1.0)
