"""Sharpness of sulci against profiles whose turning is known in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from gyrify.metrics import find_folds, fold_sharpness, measure
from gyrify.metrics.folds import Folds, periodic_extrema

N, WAVES, LENGTH = 2400, 4, 40.0
X = np.linspace(0, LENGTH, N + 1)
PHASE = 2 * np.pi * WAVES * X / LENGTH


def folds_of(height: np.ndarray) -> Folds:
    return Folds(np.column_stack([X, height]), height, *periodic_extrema(height, 0.01))


@pytest.mark.parametrize("turn", [0, 50, 300, 333])
@pytest.mark.parametrize("amplitude", [0.1, 1.0, 3.0])
def test_a_sine_wave_is_the_same_below_as_above(amplitude: float, turn: int) -> None:
    wave = amplitude * np.cos(PHASE - 2 * np.pi * WAVES * turn / N)
    assert fold_sharpness(folds_of(wave), closed=False) == pytest.approx(1.0, abs=0.01)


def test_shallow_cusps() -> None:
    """h |cos(φ/2)|, h small: slopes are angles; the corner turns by h, the crown by h sin(π/8)."""
    amplitude = 0.05
    ours = fold_sharpness(folds_of(amplitude * np.abs(np.cos(0.5 * PHASE))), closed=False)
    assert ours == pytest.approx(1 / np.sin(np.pi / 8), rel=0.02)


def test_cusps_upside_down_have_the_inverse() -> None:
    cusped = 0.5 * np.abs(np.cos(0.5 * PHASE))
    down, up = (fold_sharpness(folds_of(sign * cusped), closed=False) for sign in (1, -1))
    assert down > 2
    assert up == pytest.approx(1 / down, rel=0.05)


@pytest.mark.parametrize("direction", [1, -1])
def test_a_ring_compares_with_a_strip(direction: int) -> None:
    angle = np.arange(4000) * (2 * np.pi / 4000)
    r = 45.0 + np.cos(16 * angle)
    ring = np.column_stack([r * np.cos(angle), r * np.sin(angle)])[::direction]
    assert fold_sharpness(find_folds(ring)) == pytest.approx(1.0, abs=0.06)


def test_a_slit_is_not_balanced_by_its_lips() -> None:
    """Slits that turn by nearly two right angles; the crowns are at their lips."""
    angle = np.arange(4000) * (2 * np.pi / 4000)
    r = 45.0 - 4.0 * np.exp(-(((angle % (2 * np.pi / 8)) - np.pi / 8) ** 2) / 0.01**2)
    ring = np.column_stack([r * np.cos(angle), r * np.sin(angle)])
    assert fold_sharpness(find_folds(ring)) > 2


def test_nothing_folded_is_as_sharp_everywhere() -> None:
    angle = np.arange(400) * (2 * np.pi / 400)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    assert measure(40 * circle, 38 * circle).fold_sharpness == 1.0
