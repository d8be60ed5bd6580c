"""Measures of surfaces: against exact values, under motions, turns and changes of size."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from gyrify.mesh.nested_surface import icosphere
from gyrify.metrics import Measures
from gyrify.metrics.measure_surface import DeformedSurface
from gyrify.metrics.surface import (
    enclosed_volume,
    face_areas,
    laplacian,
    mean_curvature,
    sampled,
    vertex_areas,
    vertex_normals,
)
from gyrify.metrics.surface_closing import SurfaceClosing
from gyrify.metrics.surface_folds import SurfaceFolds, prominent_peaks
from gyrify.metrics.surface_pairs import (
    _FACING,
    _facing_groups,
    closest_points,
    crosses_itself,
    distances_to,
    smallest_gap,
)
from gyrify.metrics.surface_sections import section, section_index, sections

R = 30.0


def ball(frequency: int = 20) -> tuple[np.ndarray, np.ndarray]:
    surface = icosphere(frequency)
    return R * surface.places, surface.triangles[-1]


def bumpy(amplitude: float = 3.0, frequency: int = 40) -> tuple[np.ndarray, np.ndarray]:
    """A ball with six knobs, one on each axis."""
    surface = icosphere(frequency)
    n = surface.places
    return (R + 2.0 * amplitude * (np.abs(n) ** 100).sum(axis=1))[:, None] * n, surface.triangles[-1]


def dented(depth: float, width: float, frequency: int = 32) -> tuple[np.ndarray, np.ndarray]:
    """A ball with a narrow pit at its north pole."""
    surface = icosphere(frequency)
    n = surface.places
    angle = np.arccos(np.clip(n[:, 2], -1.0, 1.0))
    return (R - depth * np.exp(-((R * angle / width) ** 2)))[:, None] * n, surface.triangles[-1]


def measured(points: np.ndarray, faces: np.ndarray, radius: float = 8.0) -> DeformedSurface:
    return DeformedSurface(points, faces, 0.9 * points, faces, radius, 0.3)


def test_ball_has_its_area_volume_and_curvature() -> None:
    x, faces = ball(40)
    corners = x[faces]
    assert face_areas(corners).sum() == pytest.approx(4.0 * np.pi * R**2, rel=1e-3)
    assert enclosed_volume(corners) == pytest.approx(4.0 / 3.0 * np.pi * R**3, rel=1e-3)
    curvature = mean_curvature(x, faces, corners)
    weights = vertex_areas(len(x), faces, corners)
    assert weights @ curvature / weights.sum() == pytest.approx(1.0 / R, rel=1e-3)
    assert vertex_normals(len(x), faces, corners) == pytest.approx(x / R, abs=0.01)
    inside_out = mean_curvature(x, faces[:, ::-1], corners[:, ::-1])
    assert weights @ inside_out / weights.sum() == pytest.approx(-1.0 / R, rel=1e-3)


@pytest.mark.parametrize("degree", [2, 4])
def test_laplacian_knows_the_degree_of_a_harmonic(degree: int) -> None:
    """<grad Y, grad Y> = l (l + 1) / R^2 <Y, Y>."""
    x, faces = ball(40)
    z = x[:, 2] / R
    harmonic = {2: 1.5 * z**2 - 0.5, 4: (35.0 * z**4 - 30.0 * z**2 + 3.0) / 8.0}[degree]
    slope = harmonic @ (laplacian(len(x), faces, x[faces]) @ harmonic)
    square = vertex_areas(len(x), faces, x[faces]) @ harmonic**2
    assert slope / square == pytest.approx(degree * (degree + 1) / R**2, rel=6e-3)


def test_a_convex_body_is_its_own_hull_and_closing() -> None:
    found = Measures.of(measured(*ball()))
    assert found.gi_area_hull == pytest.approx(1.0, abs=1e-9)
    assert found.gi_area_closing == pytest.approx(1.0, abs=5e-3)
    assert found.gi_sections == pytest.approx(1.0, abs=2e-3)
    assert (found.n_gyri, found.sulcal_depth_max, found.wavelength) == (0, pytest.approx(0.0, abs=0.05), 0.0)
    assert found.thickness_crown == pytest.approx(0.1 * R, rel=0.01)
    assert not found.self_intersecting
    assert found.min_gap == np.inf
    assert found.mean_curvature == pytest.approx(1.0 / R, rel=0.01)


def test_closing_fills_a_narrow_pit_and_enters_a_wide_one() -> None:
    narrow, wide = (SurfaceClosing(x[f], 8.0) for x, f in (dented(6.0, 3.0), dented(6.0, 60.0)))
    x, faces = dented(6.0, 3.0)
    assert narrow.area == pytest.approx(4.0 * np.pi * R**2, rel=6e-3)
    # on the axis, the ball comes down until it touches the rim
    below = x[x[:, 2] > 0.0]
    touching = np.sqrt(np.maximum(64.0 - below[:, 0] ** 2 - below[:, 1] ** 2, 0.0))
    lowest = np.max(below[:, 2] + touching, where=np.hypot(below[:, 0], below[:, 1]) < 8.0, initial=0.0) - 8.0
    assert 3.0 < lowest - (R - 6.0) < 6.0
    assert narrow.depth(x).max() == pytest.approx(lowest - (R - 6.0), abs=0.04 * 8.0)
    assert face_areas(x[faces]).sum() > 1.004 * narrow.area
    x, faces = dented(6.0, 60.0)
    assert wide.depth(x).max() < 0.3
    assert wide.area == pytest.approx(face_areas(x[faces]).sum(), rel=6e-3)


@pytest.mark.parametrize(("radius", "periods"), [(10.0, (10.33, 4.0)), (1.5, (10.33, 6.0))])
def test_closing_of_a_flat_patch_is_the_patch(radius: float, periods: tuple[float, float]) -> None:
    """Whatever the grid is to the period; triangles are long, and the solid below is no part of the air."""
    corners = np.array(
        [[[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 0, 0], [1, 1, 0], [0, 1, 0]]], dtype=np.float64
    ) * [*periods, 1.0]
    for height in (0.0, 7.3):
        there = corners + np.array([0.3, -0.2, height])
        closing = SurfaceClosing(there, radius, periods)
        assert closing.area == pytest.approx(periods[0] * periods[1], rel=1e-4)
        assert closing.depth(there.reshape(-1, 3)).max() < 1e-3 * radius


def test_closing_of_a_patch_is_that_of_one_period() -> None:
    """A wave of a tenth of a period: the ball bridges it, and the outline is flat."""
    n = 30
    i, j = (k.ravel() for k in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    reference = np.stack([i * 20.0 / n, j * 20.0 / n, np.zeros(n * n)], axis=1)
    x = reference + np.stack([0 * i, 0 * i, 0.8 * np.cos(2.0 * np.pi * 3 * i / n)], axis=1)
    faces = []
    for a in range(n):
        for b in range(n):
            p, q = a * n + b, (a + 1) % n * n + b
            r, s = (a + 1) % n * n + (b + 1) % n, a * n + (b + 1) % n
            faces += [(p, q, r), (p, r, s)]
    surface = DeformedSurface(x, np.array(faces), x, np.array(faces), 3.0, 0.3, (20.0, 20.0), reference)
    found = Measures.of(surface)
    t = np.linspace(0.0, 1.0, 20001)
    slope = 0.8 * 2.0 * np.pi * 3 / 20.0 * np.sin(2.0 * np.pi * 3 * t)
    arc = np.mean(np.sqrt(1.0 + slope**2))
    assert found.gi_area_hull == pytest.approx(arc, rel=0.02)
    assert 1.0 < found.gi_area_hull / found.gi_area_closing < 1.15
    # over a valley the ball comes down until it touches the slopes
    away = np.linspace(-3.0, 3.0, 2001)
    lowest = np.max(0.8 * np.cos(2.0 * np.pi * (away + 10.0 / 3.0) * 3 / 20.0) + np.sqrt(9.0 - away**2)) - 3.0
    assert 0.3 < lowest + 0.8 < 1.6
    assert found.sulcal_depth_max == pytest.approx(lowest + 0.8, abs=0.15)
    assert (found.gi_sections, found.volume) == (None, None)
    assert not found.self_intersecting
    # along the surface a wave is as long as its arc
    assert found.wavelength == pytest.approx(20.0 / 3.0 * arc, rel=0.08)


def test_knobs_are_gyri() -> None:
    surface = measured(*bumpy(), radius=12.0)
    # six knobs, and the plain between them, which the ball lies on too
    assert surface.folds.crowns.size == 7
    crowns = surface.points[surface.folds.crowns]
    nearest = np.abs(crowns).max(axis=1) / np.linalg.norm(crowns, axis=1)
    assert np.count_nonzero(nearest > 0.98) >= 6


def test_prominence_is_the_climb_from_the_saddle() -> None:
    """Heights 0 3 1 2 0 along a strip of triangles: the second peak rises by 1 from its saddle."""
    heights = np.array([0.0, 3.0, 1.0, 2.0, 0.0, 0.0, 3.0, 1.0, 2.0, 0.0])
    faces = np.array([t for k in range(4) for t in ((k, k + 1, k + 6), (k, k + 6, k + 5))])
    assert prominent_peaks(heights, faces, 0.5).size == 2
    assert prominent_peaks(heights, faces, 1.1).size == 1
    assert heights[prominent_peaks(heights, faces, 2.9)] == pytest.approx([3.0])
    assert prominent_peaks(heights, faces, 3.1).size == 0
    assert SurfaceFolds.of(np.zeros(10), faces, 0.1).crowns.size == 0


def test_measures_do_not_change_with_place_and_turn_and_scale_with_size(rng: np.random.Generator) -> None:
    x, faces = bumpy(4.0)
    turn, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    one = Measures.of(measured(x, faces, 12.0))
    other = Measures.of(measured(x @ turn.T + np.array([5.0, -3.0, 11.0]), faces, 12.0))
    for name in ("gi_area_hull", "surface_area", "volume", "mean_curvature"):
        assert getattr(other, name) == pytest.approx(getattr(one, name), rel=1e-9)
    assert one.n_gyri == 7 == other.n_gyri
    assert other.sulcal_depth_max == pytest.approx(one.sulcal_depth_max, abs=0.04 * 12.0)
    for name in ("gi_area_closing", "thickness_crown", "wavelength"):
        assert getattr(other, name) == pytest.approx(getattr(one, name), rel=0.02)
    large = Measures.of(DeformedSurface(2.0 * x, faces, 1.8 * x, faces, 24.0, 0.6))
    assert large.gi_area_closing == pytest.approx(one.gi_area_closing, rel=1e-6)
    assert large.gi_sections == pytest.approx(one.gi_sections, rel=1e-9)
    assert large.sulcal_depth_max == pytest.approx(2.0 * one.sulcal_depth_max, rel=1e-6)
    assert large.mean_curvature == pytest.approx(0.5 * one.mean_curvature, rel=1e-9)
    assert large.n_gyri == one.n_gyri


def test_a_crossing_is_seen_and_a_touch_from_afar_is_not() -> None:
    x, faces = ball(8)
    far = np.concatenate([x, x + np.array([2.2 * R, 0.0, 0.0])])
    both = np.concatenate([faces, faces + len(x)])
    assert not crosses_itself(far, both)
    near = np.concatenate([x, x + np.array([1.9 * R, 0.1, 0.2])])
    assert crosses_itself(near, both)
    folded = x.copy()
    folded[np.argmax(x[:, 2])] = [0.0, 0.0, -1.2 * R]
    assert crosses_itself(folded, faces)


def test_gap_is_the_way_across() -> None:
    x, faces = ball(16)
    apart = np.concatenate([x, x + np.array([2.0 * R + 1.5, 0.0, 0.0])])
    both = np.concatenate([faces, faces + len(x)])
    exact = 1.5  # the corners of an icosphere lie on the x axis or nearly so
    assert smallest_gap(apart, both) == pytest.approx(exact, abs=0.3)
    assert smallest_gap(x, faces) == np.inf


def test_closest_points_of_triangles(rng: np.random.Generator) -> None:
    corners = rng.standard_normal((200, 3, 3))
    points = 2.0 * rng.standard_normal((200, 3))
    found = np.linalg.norm(closest_points(points, corners) - points, axis=1)
    fine = [
        np.linalg.norm(sampled(c[None], 0.02) - p, axis=1).min() for p, c in zip(points, corners, strict=True)
    ]
    assert found == pytest.approx(fine, abs=0.02)
    assert (found <= np.array(fine) + 1e-12).all()


def test_distance_between_two_balls() -> None:
    x, faces = ball(24)
    assert distances_to(1.2 * x, x[faces]) == pytest.approx(0.2 * R, rel=0.01)


def test_sections_of_a_ball_are_discs() -> None:
    x, faces = ball(40)
    for place in (-20.0, 0.0, 12.0):
        disc = section(x[faces], 0, place)
        assert disc.area == pytest.approx(np.pi * (R**2 - place**2), rel=4e-3)
    assert len(sections(x[faces], 2, 5)) == 5
    hollow = np.concatenate([x[faces], 0.5 * x[faces][:, ::-1]])
    assert section(hollow, 1, 0.0).area == pytest.approx(np.pi * R**2 * 0.75, rel=4e-3)


def test_index_of_a_section_is_that_of_the_plane() -> None:
    from gyrify.metrics import gyrification_index

    angle = np.linspace(0.0, 2.0 * np.pi, 1500, endpoint=False)
    radius = 30.0 + 3.0 * np.cos(14 * angle)
    contour = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    ours, known = section_index(shapely.Polygon(contour), 8.0), gyrification_index(contour, "closing", 8.0)
    assert ours == pytest.approx(known, rel=2e-3)


def test_measures_are_told_by_their_names() -> None:
    found = Measures.of(measured(*bumpy()))
    nested = found.as_dict()
    assert set(nested["gi"]) == {"area", "sections", "closing_radius_mm"}
    assert set(nested["gi"]["area"]) == {"hull", "closing"}
    assert found.flat()["gi_area_closing"] == found.index == nested["gi"]["area"]["closing"]
    assert found.n_dim == 3
    assert "GI by area" in repr(found)
    assert "contour_length_mm" not in nested


def test_triangles_about_a_point_are_no_other_side_of_a_sulcus() -> None:
    """At the bottom of a sharp pit edges face the walls that they end at, which are no gap."""
    x, faces = ball(8)
    x[0] *= 0.2
    rim = np.setdiff1d(faces[np.any(faces == 0, axis=1)], 0)
    # between opposite walls at half the depth, which edges to the bottom would measure
    half_way = 0.5 * np.linalg.norm(x[rim] - x[rim[0]], axis=1).max()
    assert smallest_gap(x, faces) > half_way


def test_no_pair_that_faces_each_other_is_left_out(rng: np.random.Generator) -> None:
    directions, facets = (v / np.linalg.norm(v, axis=1)[:, None] for v in rng.standard_normal((2, 300, 3)))
    looked_at = np.zeros((300, 300), dtype=bool)
    for own, other in _facing_groups(directions, facets):
        looked_at[np.ix_(own, other)] = True
    assert looked_at[directions @ facets.T < _FACING].all()
    assert looked_at.mean() < 0.8
