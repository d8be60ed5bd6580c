"""Patterns of the mesh are no gyri, whatever their height; folds are counted beside them."""

from __future__ import annotations

import numpy as np
import pytest

from gyrify.metrics import find_folds, measure
from gyrify.metrics.periodic import strip_sawteeth
from gyrify.metrics.sawtooth import without_sawteeth


def ring(height: np.ndarray, stretch: float = 1.2) -> np.ndarray:
    angle = np.arange(len(height)) * (2 * np.pi / len(height))
    r = 40.0 + height
    return np.column_stack([stretch * r * np.cos(angle), r * np.sin(angle)])


def zigzag(n: int, every: int = 2) -> np.ndarray:
    """Height of 1 mm at every so many points."""
    return 1.0 * (np.arange(n) % every == 0)


@pytest.mark.parametrize("n", [72, 144, 216])
def test_a_sawtooth_has_no_gyri(n: int) -> None:
    folds = find_folds(ring(zigzag(n)))
    assert folds.n_gyri == 0
    assert len(folds.fundi) == 0
    assert folds.n_sawteeth == n // 2
    assert measure(ring(zigzag(n)), ring(np.full(n, -1.5))).n_gyri == 0


def test_three_points_for_each_crown_are_a_pattern_of_the_mesh_too() -> None:
    folds = find_folds(ring(zigzag(144, 3)))
    assert folds.n_gyri == 0
    assert folds.n_sawteeth == 48


@pytest.mark.parametrize("k", [18, 24, 36])
def test_gyri_of_four_points_and_more_are_counted(k: int) -> None:
    n = 144
    folds = find_folds(ring(2.0 * np.cos(2 * np.pi * k * np.arange(n) / n)))
    assert folds.n_gyri == k
    assert folds.n_sawteeth == 0


def test_a_sawtooth_on_a_part_leaves_the_folds_of_the_rest() -> None:
    n = 240
    height = 2.0 * np.cos(2 * np.pi * 12 * np.arange(n) / n)
    height[:40] = 2.0 * zigzag(40)
    folds = find_folds(ring(height))
    assert folds.n_gyri == len(folds.fundi) == pytest.approx(10, abs=1)
    assert folds.n_sawteeth >= 15
    together = np.sort(np.concatenate([folds.crowns, folds.fundi]))
    is_crown = np.isin(together, folds.crowns)
    assert np.all(is_crown != np.roll(is_crown, 1))


def test_the_fundus_that_is_kept_between_two_gyri_is_the_lowest() -> None:
    profile = np.array([0.0, 1.0, 3.0, 1.0, -1.0, 2.0, -2.0, 1.0, 3.0, 1.0])
    crowns, fundi = np.array([2, 5, 8]), np.array([0, 4, 6])
    kept, low, dropped = without_sawteeth(profile, np.arange(10.0), 100, crowns, fundi)
    # Between crowns 2 and 8 two fundi are left, of which 6 is the lower one.
    np.testing.assert_array_equal(kept, [2, 8])
    np.testing.assert_array_equal(low, [0, 6])
    assert dropped == 1


def test_a_single_gyrus_is_no_sawtooth() -> None:
    profile = np.array([0.0, 1.0, 2.0, 1.0])
    kept, low, dropped = without_sawteeth(profile, np.arange(4.0), 8, np.array([2]), np.array([0]))
    assert (len(kept), len(low), dropped) == (1, 1, 0)


def test_a_strip_is_treated_alike() -> None:
    n, period = 96, 40.0
    x = np.arange(n) * period / n
    saw = np.column_stack([x, 18.0 + zigzag(n)])
    folded = np.column_stack([x, 18.0 + 2.0 * np.cos(2 * np.pi * 4 * np.arange(n) / n)])
    inner = np.column_stack([x, np.full(n, 16.0)])
    assert measure(saw, inner, period=period).n_gyri == 0
    assert strip_sawteeth(saw, period, 0.3, 2000) == 48
    assert measure(folded, inner, period=period).n_gyri == 4
    assert strip_sawteeth(folded, period, 0.3, 2000) == 0
