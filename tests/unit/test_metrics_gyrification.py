"""The gyrification index and the narrowest gap against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gyrify.errors import ConfigError, MeshError
from gyrify.metrics import closing_outline, gyrification_index, min_gap, self_intersecting
from gyrify.metrics.contour import edge_lengths, filled, offset_outline
from gyrify.metrics.gap import DETOUR
from gyrify.metrics.gyrification import closing_length, exposed_length

DEFINITIONS = ["hull", "closing", "exposed"]


def circle(radius: float = 40.0, n: int = 216) -> np.ndarray:
    angle = np.arange(n) * (2 * np.pi / n)
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def notched_square(width: float, depth: float, side: float = 100.0) -> np.ndarray:
    """A square with a rectangular notch in the middle of its upper side."""
    h, w = side / 2, width / 2
    return np.array([[-h, -h], [h, -h], [h, h], [w, h], [w, h - depth], [-w, h - depth], [-w, h], [-h, h]])


def two_discs(radius: float = 20.0, offset: float = 15.0, n: int = 2000) -> np.ndarray:
    """Outline of two overlapping discs with centres at (±offset, 0)."""
    meet = math.pi - math.acos(offset / radius)
    angle = np.linspace(-meet, meet, n)
    right = np.column_stack([offset + radius * np.cos(angle), radius * np.sin(angle)])
    return np.concatenate([right[:-1], -right[:-1]])


def rippled(k: int, amplitude: float, radius: float = 45.0, n: int = 216) -> np.ndarray:
    angle = np.arange(n) * (2 * np.pi / n)
    r = radius + amplitude * np.cos(k * angle)
    return np.column_stack([r * np.cos(angle), r * np.sin(angle)])


@pytest.mark.parametrize("definition", DEFINITIONS)
@pytest.mark.parametrize("shape", [circle(), circle() * [1.2, 1.0], circle() * [1.0, 3.0]])
def test_a_convex_contour_has_index_one(definition: str, shape: np.ndarray) -> None:
    assert gyrification_index(shape, definition) == pytest.approx(1.0, abs=1e-4)


@pytest.mark.parametrize("width", [2.0, 6.0, 15.0])
@pytest.mark.parametrize("radius", [8.0, 10.0])
def test_a_notch_is_bridged_by_one_arc(width: float, radius: float) -> None:
    depth, side = 12.0, 100.0
    contour = notched_square(width, depth, side)
    length = 4 * side + 2 * depth
    arc = 2 * radius * math.asin(width / (2 * radius))
    exposed = 4 * side - width
    assert gyrification_index(contour, "hull") == pytest.approx(length / (4 * side), rel=1e-12)
    assert gyrification_index(contour, "closing", radius) == pytest.approx(length / (exposed + arc), rel=1e-4)
    assert gyrification_index(contour, "exposed", radius) == pytest.approx(length / exposed, rel=2e-3)


def test_a_notch_wider_than_the_disc_is_entered() -> None:
    width, depth, radius = 30.0, 20.0, 5.0
    fillets = 2 * (2 * radius - math.pi * radius / 2)
    length = 400.0 + 2 * depth
    closing = gyrification_index(notched_square(width, depth), "closing", radius)
    assert closing == pytest.approx(length / (length - fillets), rel=1e-4)


def test_two_discs_are_exposed_up_to_where_the_rolling_disc_bridges_them() -> None:
    exposed = 4 * 20.0 * math.radians(120)
    length = 4 * 20.0 * (math.pi - math.acos(15 / 20))
    contour = two_discs()
    assert gyrification_index(contour, "exposed", 10.0) == pytest.approx(length / exposed, rel=2e-3)
    bridged = exposed + 2 * 10.0 * math.radians(60)
    assert gyrification_index(contour, "closing", 10.0) == pytest.approx(length / bridged, rel=2e-4)


def test_the_ends_of_the_exposed_part_are_found_within_an_edge() -> None:
    """Edges of 0.5 to 3 mm, cut by four ends: without a search inside of them, the mean error is 1.2 mm."""
    exact = 4 * 20.0 * math.radians(120)
    errors = [exposed_length(filled(two_discs(n=n)), 10.0) - exact for n in (30, 37, 44, 51, 58, 65, 90, 200)]
    assert np.abs(errors).mean() < 0.9


def test_a_hollow_wider_than_the_disc_is_all_exposed() -> None:
    contour = rippled(3, 10.0)  # curved inwards with a radius of about 50 mm
    assert gyrification_index(contour, "exposed") == pytest.approx(1.0, abs=1e-3)
    assert gyrification_index(contour, "closing") == pytest.approx(1.0, abs=1e-3)
    assert gyrification_index(contour, "hull") > 1.003


def test_the_definitions_are_ordered_and_a_large_disc_gives_the_hull() -> None:
    contour = rippled(16, 4.0)
    hull, closing, exposed = (gyrification_index(contour, d) for d in DEFINITIONS)
    assert exposed > closing > 1.05
    assert exposed > hull > closing
    assert gyrification_index(contour, "closing", 1000.0) == pytest.approx(hull, rel=5e-3)


@pytest.mark.parametrize("radius", [3.0, 10.0])
def test_the_length_of_the_closing_is_that_of_its_constructed_outline(radius: float) -> None:
    contour = rippled(18, 5.0)
    outline = closing_outline(contour, radius)
    length = closing_length(offset_outline(filled(contour), radius), radius)
    assert length == pytest.approx(float(edge_lengths(outline).sum()), rel=3e-4)


def test_an_overlap_is_seen_and_hidden_in_the_outline() -> None:
    """The walls of a notch cross: the contour keeps its length, the outline loses what lies inside."""
    contour = notched_square(4.0, 20.0)
    contour[[4, 5]] = contour[[5, 4]]
    assert self_intersecting(contour)
    assert not self_intersecting(notched_square(4.0, 20.0))
    assert min_gap(contour) == 0.0
    length = float(edge_lengths(contour).sum())
    assert gyrification_index(contour, "hull") == pytest.approx(length / 400.0, rel=1e-12)
    arc = 2 * 10.0 * math.asin(0.2)
    assert gyrification_index(contour, "closing") == pytest.approx(length / (396.0 + arc), rel=1e-4)
    assert gyrification_index(contour, "exposed") == pytest.approx(length / 396.0, rel=5e-3)


@pytest.mark.parametrize("width", [0.05, 1.0, 8.0])
def test_the_gap_of_a_notch_is_its_width(width: float) -> None:
    assert min_gap(notched_square(width, 20.0)) == pytest.approx(width, rel=1e-12)


def test_the_gap_of_a_convex_contour_is_about_its_width() -> None:
    assert min_gap(circle(40.0)) == pytest.approx(80.0, rel=0.02)
    assert min_gap(circle(40.0) * [1.2, 1.0]) == pytest.approx(80.0, rel=0.05)


@pytest.mark.parametrize(("k", "amplitude"), [(7, 9.0), (18, 6.0), (18, 0.5), (40, 5.0)])
def test_the_gap_is_that_of_a_plain_search(k: int, amplitude: float) -> None:
    contour = rippled(k, amplitude)
    lengths = edge_lengths(contour)
    arc = np.concatenate([[0.0], np.cumsum(lengths)])
    best = math.inf
    for v, point in enumerate(contour):
        for e, start in enumerate(contour):
            end = contour[(e + 1) % len(contour)]
            if v in (e, (e + 1) % len(contour)):
                continue
            t = min(max(float((point - start) @ (end - start)) / lengths[e] ** 2, 0.0), 1.0)
            distance = math.dist(point, start + t * (end - start))
            way = abs(arc[e] + t * lengths[e] - arc[v])
            if min(way, arc[-1] - way) >= DETOUR * distance:
                best = min(best, distance)
    assert min_gap(contour) == pytest.approx(best, rel=1e-12)


@pytest.mark.parametrize(
    "contour", [np.zeros((2, 2)), np.zeros((5, 3)), np.array([[0, 0], [1, 0], [np.nan, 1.0]]), np.zeros(4)]
)
def test_a_malformed_contour_is_refused(contour: np.ndarray) -> None:
    with pytest.raises(MeshError, match="contour"):
        gyrification_index(contour)


def test_bad_parameters_are_refused() -> None:
    with pytest.raises(ConfigError, match="closing_radius = -1"):
        gyrification_index(circle(), closing_radius=-1.0)
    with pytest.raises(ConfigError, match="hull, closing, exposed"):
        gyrification_index(circle(), "alpha")  # type: ignore[arg-type]
