"""Width and flatness of gyri against profiles whose chords are known."""

from __future__ import annotations

import numpy as np
import pytest

from gyrify.metrics import find_folds, gyrus_shapes, measure
from gyrify.metrics.folds import Folds, periodic_extrema

N, WAVES, LENGTH = 1200, 6, 60.0
WAVELENGTH = LENGTH / WAVES
PHASE = 2 * np.pi * WAVES * np.arange(N) / N

PROFILES = {
    "cosine": (np.cos(PHASE), 1 / 2, 1 / 3),
    "cusped": (np.abs(np.cos(0.5 * PHASE)), 2 / 3, 2 * np.arccos(0.75) / np.pi),
    "triangle": (np.abs((PHASE / np.pi) % 2 - 1), 1 / 2, 1 / 4),
    "parabola": (-(((PHASE / np.pi) % 2 - 1) ** 2), np.sqrt(1 / 2), np.sqrt(1 / 4)),
}


def strip_folds(profile: np.ndarray, height: float = 2.0) -> Folds:
    """One period of a strip with this profile, its end point repeated as in the metrics of a strip."""
    points = np.column_stack([np.linspace(0, LENGTH, N + 1), np.append(profile, profile[0]) * height])
    return Folds(points, points[:, 1], *periodic_extrema(points[:, 1], 0.3))


@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize("turn", [0, 37, 100, 150])
def test_known_profiles(name: str, turn: int) -> None:
    profile, width, flatness = PROFILES[name]
    shapes = gyrus_shapes(strip_folds(np.roll(profile, turn)), closed=False)
    assert len(shapes.width) == len(shapes.flatness) == WAVES
    assert shapes.width == pytest.approx(width * WAVELENGTH, rel=0.01)
    assert shapes.flatness == pytest.approx(flatness, rel=0.01)
    assert shapes.mean_width == pytest.approx(width * WAVELENGTH, rel=0.01)


def test_a_flat_gyrus_between_slits() -> None:
    """A box: width all but the slit, flatness all but one."""
    phase = (PHASE / (2 * np.pi)) % 1
    shapes = gyrus_shapes(strip_folds(np.where(np.abs(phase - 0.5) < 0.05, 0.0, 1.0)), closed=False)
    assert shapes.width == pytest.approx(0.9 * WAVELENGTH, rel=0.02)
    assert shapes.flatness == pytest.approx(0.9, rel=0.02)


def test_sulci_of_unlike_depth_are_cut_above_the_higher_one() -> None:
    """A gyrus of height 2 between fundi at 0 and -2: half its height is 1, whatever the deeper one."""
    x = np.linspace(0, 40, 401)
    y = np.interp(x, [0, 10, 20, 30, 40], [-2.0, 2.0, 0.0, 2.0, -2.0])
    folds = Folds(np.column_stack([x, y]), y, np.array([100, 300]), np.array([0, 200]))
    shapes = gyrus_shapes(folds, closed=False)
    assert shapes.width == pytest.approx([2.5 + 5, 5 + 2.5])
    assert shapes.flatness == pytest.approx([0.5 * 7.5 / np.hypot(20, 2)] * 2)


def test_ripples_of_a_circle() -> None:
    k, radius = 20, 45.0
    angle = np.arange(4000) * (2 * np.pi / 4000)
    r = radius + 1.0 * np.cos(k * angle)
    contour = np.column_stack([r * np.cos(angle), r * np.sin(angle)])
    shapes = gyrus_shapes(find_folds(contour))
    assert shapes.mean_width == pytest.approx(np.pi * radius / k, rel=0.01)
    exact = (radius + 0.5) * np.sin(np.pi / (3 * k)) / ((radius - 1) * np.sin(np.pi / k))
    assert shapes.mean_flatness == pytest.approx(exact, rel=2e-3)
    together = measure(contour, contour * 0.9)
    assert together.gyrus_width == shapes.mean_width
    assert together.gyrus_flatness == shapes.mean_flatness


def test_a_mushroom_is_no_flatter_than_a_box() -> None:
    """Walls that overhang: the chord of 9 is wider than the distance of the fundi, 5."""
    points = np.array([(0.0, 0.0), (-2.0, 3.0), (-2.0, 4.0), (2.5, 4.1), (7.0, 4.0), (7.0, 3.0), (5.0, 0.0)])
    fundi, crown = np.array([0]), np.array([3])
    shapes = gyrus_shapes(Folds(points, points[:, 1], crown, fundi), closed=False)
    assert shapes.width == pytest.approx(5 + 2 * 2 * 2.05 / 3)
    assert shapes.flatness == pytest.approx(1.0)


def test_nothing_folded_has_no_width() -> None:
    circle = 40.0 * np.column_stack([np.cos(PHASE[:200]), np.sin(PHASE[:200])])
    shapes = gyrus_shapes(find_folds(circle))
    assert (shapes.mean_width, shapes.mean_flatness, len(shapes.width)) == (0.0, 0.0, 0)
