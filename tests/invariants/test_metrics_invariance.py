"""Metrics depend on the folded curve alone: not on where it lies, how it is sampled or in which unit."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gyrify.metrics import Measures, measure


def folded(n: int, outwards: float = 0.0) -> np.ndarray:
    """A folded ellipse with overhanging walls; negative ``outwards`` gives the interface below it."""
    t = np.arange(4 * n) * (2 * np.pi / (4 * n))
    wave = 17 * t + 0.4 * np.sin(2 * t + 0.3)
    r = 45.0 + outwards + 3.0 * np.cos(wave) + 0.6 * np.sin(3 * t)
    angle = t - 0.03 * np.sin(wave + 0.4) * np.cos(wave)
    curve = np.column_stack([1.1 * r * np.cos(angle), r * np.sin(angle) / 1.1])
    ring = np.concatenate([curve, curve[:1]])
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(ring, axis=0).T))])
    at = np.arange(n) * (arc[-1] / n)
    return np.column_stack([np.interp(at, arc, ring[:, 0]), np.interp(at, arc, ring[:, 1])])


CONTOUR, INTERFACE = folded(432), folded(432, -2.0)
REFERENCE = measure(CONTOUR, INTERFACE)


def assert_same(ours: Measures, rel: float, scale: float = 1.0, rel_exposed: float | None = None) -> None:
    flat, expected = ours.flat(), REFERENCE.flat()
    assert flat["n_gyri"] == expected["n_gyri"] == 17
    assert flat["self_intersecting"] == expected["self_intersecting"]
    for name, value in expected.items():
        unit = scale if "_mm" in name else 1.0
        if isinstance(value, float):
            within = rel_exposed if rel_exposed and name == "gi_exposed" else rel
            assert flat[name] == pytest.approx(unit * value, rel=within), name


@settings(max_examples=25, deadline=None, derandomize=True)
@given(
    angle=st.floats(-np.pi, np.pi),
    x=st.floats(-1e3, 1e3),
    y=st.floats(-1e3, 1e3),
    shift=st.integers(0, 431),
    backwards=st.booleans(),
)
def test_position_start_and_direction_do_not_matter(
    angle: float, x: float, y: float, shift: int, backwards: bool
) -> None:
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    step = -1 if backwards else 1
    contour = np.roll(CONTOUR @ turn.T + [x, y], shift, axis=0)[::step]
    interface = np.roll(INTERFACE @ turn.T + [x, y], shift, axis=0)[::step]
    assert_same(measure(contour, interface), rel=5e-3)


@pytest.mark.parametrize("scale", [1e-3, 0.4, 25.0])
def test_a_change_of_unit_scales_lengths_and_nothing_else(scale: float) -> None:
    scaled = measure(
        scale * CONTOUR, scale * INTERFACE, closing_radius=10.0 * scale, gyrus_prominence=0.3 * scale
    )
    assert_same(scaled, rel=1e-9, scale=scale)


@pytest.mark.parametrize("n", [300, 700, 1500])
def test_the_number_of_nodes_does_not_matter(n: int) -> None:
    """Finer nodes reach deeper into the sulci; how much of the tight crowns is exposed needs the finest."""
    assert_same(measure(folded(n), folded(n, -2.0)), rel=0.05, rel_exposed=0.1)


@pytest.mark.parametrize("samples", [1000, 4000])
def test_the_number_of_samples_does_not_matter(samples: int) -> None:
    assert_same(measure(CONTOUR, INTERFACE, samples=samples), rel=5e-3)


def test_the_definitions_differ_on_one_curve() -> None:
    """A guard for the tests above: the curve is folded enough to tell the definitions apart."""
    assert REFERENCE.gi_exposed > REFERENCE.gi_hull > REFERENCE.gi_closing > 1.05
    assert REFERENCE.sulcal_depth_max > 2.0
