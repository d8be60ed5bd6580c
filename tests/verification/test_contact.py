"""No sulcus goes through itself: checked from stored contours, without a line of the contact code."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import shapely
from oracle import SliceOracle

from gyrify.store import History


def crossings(before: np.ndarray, after: np.ndarray) -> int:
    """Passages of vertices through edges while every vertex of a closed line moves straight to its end.

    A vertex p is on the line through an edge a-b when cross(p - a, b - a) = 0, a quadratic in time; it passes
    the edge if it then lies between the ends.
    """
    n = len(before)
    p, e = (index.ravel() for index in np.indices((n, n)))
    other = (p != e) & (p != (e + 1) % n)
    p, a, b = p[other], e[other], (e[other] + 1) % n
    arm, d_arm = before[p] - before[a], (after - before)[p] - (after - before)[a]
    edge, d_edge = before[b] - before[a], (after - before)[b] - (after - before)[a]
    c0, c1, c2 = cross(arm, edge), cross(arm, d_edge) + cross(d_arm, edge), cross(d_arm, d_edge)
    root = np.sqrt(np.where(c1**2 >= 4 * c0 * c2, c1**2 - 4 * c0 * c2, np.nan))
    # both roots without cancellation: q / c2 and c0 / q
    q = -(c1 + np.where(c1 < 0, -1.0, 1.0) * root) / 2
    total = 0
    with np.errstate(divide="ignore", invalid="ignore"):
        for time in (q / c2, c0 / q):
            inside = (time >= 0) & (time <= 1)
            now_arm, now_edge = arm + time[:, None] * d_arm, edge + time[:, None] * d_edge
            along = (now_arm * now_edge).sum(axis=1) / (now_edge**2).sum(axis=1)
            total += int(np.count_nonzero(inside & (along >= 0) & (along <= 1)))
    return total


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Cross product in the plane."""
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


SPIKE = np.array([[-4, -1], [4, -1], [4, 3], [1, 3], [0, 0.5], [-1, 3], [-4, 3]], dtype=float)


@pytest.mark.parametrize(
    ("vertex", "to", "expected"),
    [
        (4, (0.0, -0.5), 0),  # stays above the edge at -1
        (4, (0.0, -1.5), 1),  # through it
        (4, (9.0, -5.0), 1),  # through it obliquely, and past the side
        (1, (9.0, -5.0), 0),  # away from all others; its own edges only turn
    ],
)
def test_the_check_itself_by_hand(vertex: int, to: tuple, expected: int) -> None:
    after = SPIKE.copy()
    after[vertex] = to
    assert min(crossings(SPIKE, after), 1) == expected


def test_the_check_sees_a_passage_there_and_back() -> None:
    """A square passes through another one and out again: both ends are simple, the path is not."""
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)
    both = np.concatenate([square, square + np.array([3.0, 0.0])])
    after = both + np.repeat([[6.0, 0.0], [0.0, 0.0]], 4, axis=0)
    assert crossings(both, both) == 0
    assert crossings(both, after) > 0


def test_the_run_closes_its_sulci(folded: History) -> None:
    """At the end the banks push on each other: a barrier far above the tolerance, in many places."""
    oracle = SliceOracle(folded.config, folded.mesh)
    force = np.linalg.norm(oracle.contact(folded.displacement(-1), folded.displacement(-2)), axis=1)
    assert np.count_nonzero(force > 1e3 * folded.residuals.max()) > 20
    assert not oracle.contact(folded.displacement(3), folded.displacement(2)).any()


def test_every_increment_is_simple(folded: History) -> None:
    assert len(folded) > 20
    assert all(shapely.LinearRing(folded.contour(k)).is_simple for k in range(len(folded)))


def test_every_path_between_increments_is_free_of_crossings(folded: History) -> None:
    contours = [folded.contour(k) for k in range(len(folded))]
    assert [crossings(a, b) for a, b in pairwise(contours)] == [0] * (len(contours) - 1)


def test_without_contact_the_same_run_goes_through_itself(overlapping: History, folded: History) -> None:
    contours = [overlapping.contour(k) for k in range(len(overlapping))]
    assert not shapely.LinearRing(contours[-1]).is_simple
    assert sum(crossings(a, b) for a, b in pairwise(contours)) > 0
    # until the first touch, contact changes nothing
    assert np.array_equal(overlapping.contour(3), folded.contour(3))


@pytest.mark.slow
def test_the_reference_slice_never_crosses() -> None:
    from gyrify import simulate
    from gyrify.config import Config

    history = simulate(Config.preset("reference-slice"))
    contours = [history.contour(k) for k in range(len(history))]
    assert all(shapely.LinearRing(contour).is_simple for contour in contours)
    assert sum(crossings(a, b) for a, b in pairwise(contours)) == 0
