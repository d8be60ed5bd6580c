"""The index by the closing lies between 1 and the hull's, whatever the radius; a gyrus has a sulcus."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from gyrify.errors import ConfigError, MeshError
from gyrify.metrics import closing_outline, find_folds, measure
from gyrify.metrics.contour import edge_lengths
from gyrify.metrics.gyrification import at_least_hull, index_of
from gyrify.metrics.measure import measure_valid
from gyrify.run.summary import measure_state, metrics_rows
from gyrify.store import History

N = 432
ANGLE = np.arange(N) * (2 * np.pi / N)
CIRCLE = np.column_stack([np.cos(ANGLE), np.sin(ANGLE)])
RADII = [1e-6, 1e-3, 0.1, 1.0, 3.0, 10.0, 48.0, 200.0, 1e3, 1e4, 1e6, 1e9]
PERIOD = 30.0


def wavy(k: int, amplitude: float) -> np.ndarray:
    return (48.0 + amplitude * np.cos(k * ANGLE))[:, None] * CIRCLE


def strip(amplitude: float, n: int = 120) -> np.ndarray:
    x = PERIOD * np.arange(n) / n
    return np.stack([x, amplitude * np.cos(2 * np.pi * 3 * x / PERIOD)], axis=1)


@pytest.mark.parametrize("radius", RADII)
@pytest.mark.parametrize("shape", [wavy(18, 4.0), wavy(6, 10.0), wavy(3, 0.0) * [1.2, 1.0], wavy(40, 2.0)])
def test_the_closing_lies_between_contour_and_hull(shape: np.ndarray, radius: float) -> None:
    found = measure_valid(shape, 0.95 * shape, radius, 0.3, 2000, None)
    assert 1.0 - 1e-4 <= found.gi_closing <= found.gi_hull
    assert found.gi_closing == index_of(shape, "closing", radius)
    assert found.gi_exposed > 0.995 * found.gi_closing
    assert 0.0 <= found.sulcal_depth_max <= 30.0


@pytest.mark.parametrize("radius", [1.0, 10.0, 100.0, 1e3, 1e5])
@pytest.mark.parametrize("amplitude", [0.0, 0.1, 1.0, 4.0])
def test_the_closing_of_a_strip_lies_between_contour_and_level_line(amplitude: float, radius: float) -> None:
    line = strip(amplitude)
    found = measure(line, line - [0.0, 1.5], radius, period=PERIOD)
    assert 1.0 - 1e-4 <= found.gi_closing <= found.gi_hull


def below_hull(k: int, amplitude: float) -> tuple[float, float]:
    """How far the fundus of a wave lies below the line that touches it on both sides; length of that line."""
    angle = np.linspace(0.0, math.pi / k, 100_001)  # from a fundus to a crown
    r = 48.0 - amplitude * np.cos(k * angle)
    height = r * np.cos(angle)
    touch = int(height.argmax())
    return float(height[touch] - height[0]), float(2 * r[touch] * math.sin(angle[touch]))


@pytest.mark.parametrize("radius", [48.0, 100.0, 480.0, 4800.0, 1e6])
def test_a_disc_larger_than_the_body_sees_its_hull(radius: float) -> None:
    """Bridges between crowns are arcs of the radius, whose sagitta and excess of length are known."""
    shape = wavy(18, 4.0)
    deepest, chord = below_hull(18, 4.0)
    hull = float(shapely.polygons(shape).convex_hull.length)
    longer = 1 + 18 * (2 * radius * math.asin(chord / (2 * radius)) - chord) / hull
    found = measure_valid(shape, 0.95 * shape, radius, 0.3, 2000, None)
    assert found.gi_hull / found.gi_closing == pytest.approx(longer, abs=1e-3)
    sagitta = radius - math.sqrt(radius**2 - chord**2 / 4)
    assert found.sulcal_depth_max == pytest.approx(deepest - sagitta, abs=0.06)
    assert float(edge_lengths(closing_outline(shape, radius)).sum()) == pytest.approx(longer * hull, rel=4e-3)


def test_a_measurement_that_cannot_be_is_refused() -> None:
    assert at_least_hull(99.95, 100.0, 10.0) == 100.0
    with pytest.raises(MeshError, match="shorter than the convex hull's"):
        at_least_hull(99.0, 100.0, 10.0)


def test_no_state_of_a_run_has_an_index_above_the_hulls(folded: History) -> None:
    rows = metrics_rows(folded)
    assert all(row["gi_closing"] <= row["gi_hull"] for row in rows)
    assert rows[-1]["gi_closing"] < rows[-1]["gi_hull"]


@pytest.mark.parametrize(
    ("k", "amplitude", "n_gyri"),
    [(8, 0.5, 0), (10, 0.6, 0), (10, 1.0, 10), (19, 0.3, 0), (19, 0.5, 19), (6, 3.0, 6), (18, 4.0, 18)],
)
def test_a_bump_without_a_sulcus_is_no_gyrus(k: int, amplitude: float, n_gyri: int) -> None:
    shape = wavy(k, amplitude)
    found = measure(shape, 0.95 * shape)
    assert (below_hull(k, amplitude)[0] >= 0.3) == (n_gyri > 0)
    assert found.n_gyri == n_gyri
    if n_gyri == 0:
        assert (found.sulcal_depth_max, found.gyrus_width, found.fold_sharpness) == (0.0, 0.0, 1.0)


def test_bumps_are_still_found_where_they_are_asked_for() -> None:
    shape = wavy(8, 0.9)
    assert measure(shape, 0.95 * shape).n_gyri == 0
    assert find_folds(shape).n_gyri == 8


def test_stored_states_are_measured_with_other_lengths(folded: History) -> None:
    own = measure_state(folded)
    small = measure_state(folded, closing_radius=4.0)
    assert (own.closing_radius, small.closing_radius) == (10.0, 4.0)
    assert small.gi_closing < own.gi_closing
    assert small.gi_hull == own.gi_hull
    assert small.n_gyri == own.n_gyri
    assert measure_state(folded, -1, closing_radius=np.float64(10.0)) == own
    with pytest.warns(UserWarning, match="larger than the mean radius"):
        assert measure_state(folded, closing_radius=500.0).gi_closing == pytest.approx(own.gi_hull, rel=1e-3)
    with pytest.warns(UserWarning, match="more than the thickness of the cortex"):
        assert measure_state(folded, gyrus_prominence=50.0).n_gyri == 0
    with pytest.raises(ConfigError, match=r"closing_radius = 0.0 is not allowed"):
        measure_state(folded, closing_radius=0.0)
