"""Every function refuses points that are no contour in order, and tells of lengths that do not fit."""

from __future__ import annotations

import warnings
from collections.abc import Callable

import numpy as np
import pytest

from gyrify import cortical_thickness, gyrification_index, measure
from gyrify.errors import MeshError
from gyrify.metrics import closing_outline, find_folds, low_mode_shape, min_gap, sulcal_depth
from gyrify.metrics.order import ordered_contour
from gyrify.run.summary import measure_state, metrics_rows
from gyrify.store import History

N = 216
ANGLE = np.arange(N) * (2 * np.pi / N)
CIRCLE = np.column_stack([np.cos(ANGLE), np.sin(ANGLE)])
FOLDED = (48.0 + 4.0 * np.cos(18 * ANGLE))[:, None] * CIRCLE
INNER = (45.5 + 3.0 * np.cos(18 * ANGLE))[:, None] * CIRCLE
RNG = np.random.default_rng(7)
SHUFFLED = RNG.permutation(N)


def partly_shuffled(share: float) -> np.ndarray:
    order, moved = np.arange(N), RNG.choice(N, int(share * N), replace=False)
    order[np.sort(moved)] = moved
    return FOLDED[order]


UNORDERED = {
    "shuffled": FOLDED[SHUFFLED],
    "a tenth shuffled": partly_shuffled(0.1),
    "sorted by x": FOLDED[np.argsort(FOLDED[:, 0])],
    "quarters exchanged": np.roll(FOLDED.reshape(4, -1, 2)[[0, 2, 1, 3]].reshape(-1, 2), 3, axis=0),
    "far points exchanged": FOLDED[[*range(10), 60, *range(11, 60), 10, *range(61, N)]],
}
WRONG = UNORDERED | {
    "every other point, then the rest": np.concatenate([FOLDED[::2], FOLDED[1::2]]),
    "twice round": np.concatenate([FOLDED, FOLDED]),
    "a point twice": np.insert(FOLDED, 5, FOLDED[5], axis=0),
    "a point twice, apart": np.insert(FOLDED, 90, FOLDED[5], axis=0),
    "not finite": np.where(ANGLE[:, None] == 0.0, np.nan, FOLDED),
    "too few": FOLDED[:2],
    "on a line": np.outer(np.arange(9.0), [1.0, 0.3]),
    "one point many times": np.ones((9, 2)),
    "words": np.array(["a", "b"]),
}
FUNCTIONS: dict[str, Callable[[np.ndarray], object]] = {
    "gyrification_index": gyrification_index,
    "gyrification_index, hull": lambda points: gyrification_index(points, "hull"),
    "measure": lambda points: measure(points, INNER),
    "measure, interface": lambda points: measure(FOLDED, points),
    "cortical_thickness": lambda points: cortical_thickness(points, INNER),
    "cortical_thickness, interface": lambda points: cortical_thickness(FOLDED, points),
    "find_folds": find_folds,
    "low_mode_shape": low_mode_shape,
    "sulcal_depth": lambda points: sulcal_depth(FOLDED[:3], points),
    "min_gap": min_gap,
    "closing_outline": closing_outline,
}


@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize("case", WRONG)
def test_what_is_no_contour_is_refused(name: str, case: str) -> None:
    with pytest.raises(MeshError, match=r"contour|interface"):
        FUNCTIONS[name](WRONG[case])


@pytest.mark.parametrize("case", UNORDERED)
def test_the_message_says_what_to_do(case: str) -> None:
    with pytest.raises(MeshError, match=r"not in order.*mm apart.*Give every point once, in the order"):
        gyrification_index(UNORDERED[case])
    with pytest.raises(MeshError, match="The interface is not in order"):
        measure(FOLDED, UNORDERED[case])


def test_a_repeated_point_is_named() -> None:
    with pytest.raises(MeshError, match=r"points 5 and 90 are both at"):
        min_gap(WRONG["a point twice, apart"])
    assert min_gap(FOLDED) > 0.0


@pytest.mark.parametrize(
    "points", [FOLDED, FOLDED[::-1], np.concatenate([FOLDED, FOLDED[:1]]), FOLDED.tolist()]
)
def test_either_direction_and_a_closing_point_are_fine(points: object) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert gyrification_index(points) == pytest.approx(gyrification_index(FOLDED), rel=1e-9)
        assert measure(points, INNER).n_gyri == 18


@pytest.mark.parametrize("at", [[[np.nan, 0.0]], [["a", "b"]], [1.0, 2.0, 3.0]])
def test_points_to_measure_at_are_points(at: object) -> None:
    with pytest.raises(MeshError, match="not finite points of the plane"):
        cortical_thickness(FOLDED, INNER, at=at)
    with pytest.raises(MeshError, match="not finite points of the plane"):
        sulcal_depth(at, FOLDED)


def test_a_straight_strip_is_a_contour_and_an_unordered_one_is_not() -> None:
    line = np.column_stack([np.arange(60) * 0.5, np.zeros(60)])
    assert measure(line, line - [0.0, 1.5], period=30.0).n_gyri == 0
    wave = line + np.column_stack([np.zeros(60), np.sin(2 * np.pi * line[:, 0] / 10.0)])
    assert measure(wave, wave - [0.0, 1.5], period=30.0).n_gyri == 3
    with pytest.raises(MeshError, match="not in order"):
        measure(wave[RNG.permutation(60)], wave - [0.0, 1.5], period=30.0)


def test_crossing_walls_are_measured_and_told() -> None:
    crossed = FOLDED.copy()
    crossed[[100, 104]] = crossed[[104, 100]]
    with pytest.warns(UserWarning, match="crosses itself"):
        gyrification_index(crossed)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert measure(crossed, INNER).self_intersecting
    assert min_gap(crossed) == 0.0


@pytest.mark.parametrize(
    ("scale", "says"), [(1e-3, "larger than the whole body"), (1e3, "smaller than every edge")]
)
def test_a_radius_in_another_unit_than_the_contour_is_told(scale: float, says: str) -> None:
    for function in (gyrification_index, lambda points: measure(points, scale * INNER)):
        with pytest.warns(UserWarning, match=says):
            function(scale * FOLDED)


def test_runs_whose_walls_overlap_are_still_measured(overlapping: History) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rows = metrics_rows(overlapping)
    assert rows[-1]["self_intersecting"]
    for index in range(len(overlapping)):
        ordered_contour(overlapping.contour(index))
    assert measure_state(overlapping).gi_closing > 1.1
