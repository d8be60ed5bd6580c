"""Thickness and the record of all metrics."""

from __future__ import annotations

import numpy as np
import pytest

from gyrify.errors import ConfigError, MeshError
from gyrify.metrics import cortical_thickness, find_folds, gyrification_index, measure, min_gap, sulcal_depth

ANGLE = np.arange(216) * (2 * np.pi / 216)
CIRCLE = np.column_stack([np.cos(ANGLE), np.sin(ANGLE)])
FOLDED = (48.0 + 4.0 * np.cos(18 * ANGLE))[:, None] * CIRCLE
INNER = (45.5 + 3.0 * np.cos(18 * ANGLE))[:, None] * CIRCLE


@pytest.mark.parametrize("thickness", [0.75, 1.5, 8.0])
def test_nested_circles_are_apart_by_the_thickness(thickness: float) -> None:
    measured = cortical_thickness(40.0 * CIRCLE, (40.0 - thickness) * CIRCLE)
    assert measured == pytest.approx(np.full(216, thickness), abs=1e-12)
    smooth = measure(40.0 * CIRCLE, (40.0 - thickness) * CIRCLE)
    assert smooth.thickness_crown == smooth.thickness_fundus == pytest.approx(thickness, abs=5e-3)


def test_thickness_is_measured_to_edges_and_not_only_to_points() -> None:
    square = np.array([[-50.0, 0.0], [50.0, 0.0], [50.0, 50.0], [-50.0, 50.0]])
    assert cortical_thickness(square, square, at=[[0.0, -3.0], [2.0, -1.0]]) == pytest.approx([3.0, 1.0])


def test_every_metric_is_that_of_its_own_function() -> None:
    together = measure(FOLDED, INNER)
    folds = find_folds(FOLDED)
    assert (together.gi_hull, together.gi_closing, together.gi_exposed) == pytest.approx(
        [gyrification_index(FOLDED, d) for d in ("hull", "closing", "exposed")], rel=1e-14
    )
    depth = sulcal_depth(folds.fundus_points, FOLDED)
    assert (together.sulcal_depth_max, together.sulcal_depth_mean) == (depth.max(), depth.mean())
    assert together.n_gyri == folds.n_gyri == 18
    crown = cortical_thickness(FOLDED, INNER, at=folds.crown_points).mean()
    fundus = cortical_thickness(FOLDED, INNER, at=folds.fundus_points).mean()
    assert (together.thickness_crown, together.thickness_fundus) == (crown, fundus)
    assert crown == pytest.approx(3.5, abs=0.1)
    assert fundus == pytest.approx(1.5, abs=0.1)
    assert together.min_gap == min_gap(FOLDED)


def test_a_smooth_state_has_no_depth_and_no_gyri() -> None:
    smooth = measure(40.0 * CIRCLE, 38.5 * CIRCLE)
    assert (smooth.n_gyri, smooth.sulcal_depth_max, smooth.sulcal_depth_mean) == (0, 0.0, 0.0)
    assert smooth.contour_length == pytest.approx(2 * np.pi * 40, rel=1e-4)
    assert not smooth.self_intersecting


def test_the_thickness_of_a_smooth_state_is_a_mean_along_all_of_it() -> None:
    """The inner circle is 1 mm off the centre: from 1 mm on one side to 3 mm on the other."""
    smooth = measure(40.0 * CIRCLE, 38.0 * CIRCLE + [1.0, 0.0])
    assert smooth.n_gyri == 0
    assert smooth.thickness_crown == smooth.thickness_fundus == pytest.approx(2.0, abs=0.05)


def test_names_are_those_of_the_run_folder() -> None:
    record = measure(FOLDED, INNER, closing_radius=8.0)
    assert list(record.as_dict()) == [
        "gi",
        "n_gyri",
        "sulcal_depth_mm",
        "thickness_mm",
        "gyrus_width_mm",
        "gyrus_flatness",
        "fold_sharpness",
        "contour_length_mm",
        "min_gap_mm",
        "self_intersecting",
    ]
    assert list(record.flat()) == [
        "gi_hull",
        "gi_closing",
        "gi_closing_radius_mm",
        "gi_exposed",
        "n_gyri",
        "sulcal_depth_mm_max",
        "sulcal_depth_mm_mean",
        "thickness_mm_crown",
        "thickness_mm_fundus",
        "gyrus_width_mm",
        "gyrus_flatness",
        "fold_sharpness",
        "contour_length_mm",
        "min_gap_mm",
        "self_intersecting",
    ]
    assert record.flat()["gi_closing_radius_mm"] == 8.0
    assert all(type(value) in (float, int, bool) for value in record.flat().values())


def test_an_overlapping_contour_is_measured_and_flagged() -> None:
    crossed = FOLDED.copy()
    crossed[[100, 104]] = crossed[[104, 100]]
    record = measure(crossed, INNER)
    assert record.self_intersecting
    assert record.min_gap == 0.0
    assert record.gi_closing > 1.0
    assert np.isfinite(record.gi_exposed)


def test_the_same_state_gives_the_same_bits() -> None:
    assert measure(FOLDED, INNER) == measure(FOLDED.copy(), INNER.tolist())


def test_bad_input_is_refused() -> None:
    with pytest.raises(ConfigError, match="closing_radius = nan"):
        measure(FOLDED, INNER, closing_radius=float("nan"))
    with pytest.raises(MeshError):
        measure(FOLDED, INNER[:2])
