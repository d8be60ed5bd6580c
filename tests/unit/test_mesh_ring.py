"""The mapped ring: counts, exact lines, areas, orientation, jitter, refusals."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from bodies import elliptic_ring

from gyrify.errors import MeshError
from gyrify.mesh import GREY, WHITE
from gyrify.mesh.grading import layer_fractions
from gyrify.mesh.layered_grid import Layers
from gyrify.mesh.quality import triangle_quality

A, B, H, T = 39.42, 32.85, 0.5, 1.5


def ring(n_around=216, n_layers=17, n_cortex=6, **options):
    return elliptic_ring((A, B), H, T, Layers(n_around, n_layers, n_cortex, **options))


def areas(mesh) -> np.ndarray:
    a, b, c = np.moveaxis(mesh.cell_points, 1, 0)
    return ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2


def on_ellipse(points: np.ndarray, a: float, b: float) -> np.ndarray:
    return (points[:, 0] / a) ** 2 + (points[:, 1] / b) ** 2


def test_counts_are_the_papers() -> None:
    """216 x 17 quadrilaterals: 7344 triangles, 216 x 18 points, 216 x 6 x 2 grey triangles."""
    mesh = ring()
    assert (mesh.n_cells, mesh.n_points, mesh.n_dim) == (7344, 3888, 2)
    assert np.count_nonzero(mesh.region == GREY) == 2592
    assert mesh.contour.size == mesh.interface.size == mesh.clamped.size == 216


@pytest.mark.parametrize("jitter", [0.0, 0.1])
@pytest.mark.parametrize("grading", ["geometric", "uniform"])
def test_contour_interface_and_hole_are_exact_ellipses(jitter: float, grading: str) -> None:
    mesh = ring(node_jitter=jitter, grading=grading, seed=3)
    assert on_ellipse(mesh.points[mesh.contour], A, B) == pytest.approx(1.0, abs=1e-14)
    assert on_ellipse(mesh.points[mesh.interface], A - T, B - T) == pytest.approx(1.0, abs=1e-14)
    assert on_ellipse(mesh.points[mesh.clamped], H * A, H * B) == pytest.approx(1.0, abs=1e-14)


def test_areas_are_those_of_the_inscribed_polygons() -> None:
    """n points at equal eccentric angles span n/2 sin(2 pi/n) a b; grey + white = the whole."""
    n, mesh = 216, ring()
    polygon = n / 2 * np.sin(2 * np.pi / n)
    grey, white = (areas(mesh)[mesh.region == tissue].sum() for tissue in (GREY, WHITE))
    assert grey == pytest.approx(polygon * (A * B - (A - T) * (B - T)), rel=1e-12)
    assert white == pytest.approx(polygon * ((A - T) * (B - T) - H**2 * A * B), rel=1e-12)


@pytest.mark.parametrize("split", ["alternating", "one", "random"])
def test_triangles_are_counter_clockwise_and_share_every_inner_edge(split: str) -> None:
    mesh = ring(48, 6, 3, split=split, node_jitter=0.05, seed=5)
    assert areas(mesh).min() > 0.0
    directed = np.concatenate([mesh.cells[:, [0, 1]], mesh.cells[:, [1, 2]], mesh.cells[:, [2, 0]]])
    assert len(np.unique(directed, axis=0)) == len(directed)
    both = {tuple(edge) for edge in directed}
    outside = [edge for edge in both if edge[::-1] not in both]
    assert len(outside) == 2 * 48  # the contour and the hole
    following = dict(zip(mesh.contour, np.roll(mesh.contour, -1), strict=True))
    assert sum(following.get(a) == b for a, b in outside) == 48  # counter-clockwise, as the triangles are


def test_splits_differ_as_their_names_say() -> None:
    """`one`: each inner point has 6 triangles; `alternating`: 4 or 8; `random`: depends on the seed."""
    inner = slice(48, -48)
    meshes = (ring(48, 6, 3, split=split) for split in ("one", "alternating"))
    one, alternating = (np.bincount(mesh.cells.ravel())[inner] for mesh in meshes)
    assert set(one) == {6}
    assert set(alternating) == {4, 8}
    drawn = [ring(48, 6, 3, split="random", seed=seed).cells for seed in (1, 1, 2)]
    assert np.array_equal(drawn[0], drawn[1])
    assert not np.array_equal(drawn[0], drawn[2])


def test_jitter_is_bounded_seeded_and_off_at_zero() -> None:
    """The same seed moves every point to the same place, another seed elsewhere."""
    pairs = ((0, 0), (1e-3, 0), (1e-3, 0), (1e-3, 1))
    still, moved, again, other = (ring(node_jitter=jitter, seed=seed) for jitter, seed in pairs)
    assert np.array_equal(moved.points, again.points)
    assert not np.array_equal(moved.points, other.points)
    assert np.array_equal(still.points, ring(node_jitter=0.0, seed=9).points)
    assert np.linalg.norm(moved.points - still.points, axis=1).min() > 0.0


def test_jitter_is_the_stated_fraction_of_the_local_layer() -> None:
    """At most 1e-3 in both directions, sqrt(2) together, a quarter more where the ellipse is wide.

    Deep layers are thicker than their columns are wide: there the width limits the shift along the layer.
    """
    still, moved = ring(node_jitter=0.0), ring(node_jitter=1e-3)
    shift = np.linalg.norm(moved.points - still.points, axis=1).reshape(18, 216).max(axis=1)
    layers = np.linalg.norm(np.diff(still.points.reshape(18, 216, 2), axis=0), axis=2)
    thinner = np.minimum(np.vstack([layers[:1], layers]), np.vstack([layers, layers[-1:]])).max(axis=1)
    share = shift / thinner
    assert share.max() < 1.25 * np.sqrt(2) * 1e-3
    assert share[1:].min() > 0.4e-3
    # the hole: columns of 0.52 mm, and no shift off the line
    assert 0.4e-3 < shift[0] / 0.52 < 1.25e-3


def test_directions_across_are_normals_of_the_layers() -> None:
    """In the cortex the layers are the ellipses (A - s, B - s); N is (x / (A - s)^2, y / (B - s)^2)."""
    mesh = ring()
    centre = mesh.cell_points.mean(axis=1)
    assert np.linalg.norm(mesh.across, axis=1) == pytest.approx(1.0, rel=1e-14)
    assert (mesh.across * centre).sum(axis=1).min() > 0.0
    outermost = np.isin(mesh.cells, mesh.contour).sum(axis=1) == 2
    # two corners of three on the contour: a third of a layer of T / 6 below it
    semi_axes = np.array([A, B]) - T / 18
    normal = centre[outermost] / semi_axes**2
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    assert np.abs(mesh.across[outermost] - normal).max() < 1e-3


def test_geometric_layers_begin_with_the_cortical_thickness_and_grow_by_one_ratio() -> None:
    lines = layer_fractions(11, 0.015, "geometric")
    thickness = np.diff(lines)
    assert (lines[0], lines[-1]) == (0.0, 1.0)
    assert thickness[-1] == pytest.approx(0.015, rel=1e-9)
    ratios = thickness[:-1] / thickness[1:]
    assert ratios == pytest.approx(ratios[0], rel=1e-9)
    assert np.diff(layer_fractions(11, 0.015, "uniform")) == pytest.approx(1 / 11)


def test_quality_by_hand() -> None:
    """Equilateral 1; right isosceles 2 sqrt(3) / 4; flat 0; clockwise negative."""
    equilateral = [[0, 0], [1, 0], [0.5, np.sqrt(0.75)]]
    right, flat = [[0, 0], [1, 0], [0, 1]], [[0, 0], [1, 0], [2, 0]]
    found = triangle_quality(np.array([equilateral, right, flat, right[::-1]], dtype=float))
    assert found == pytest.approx([1.0, np.sqrt(3) / 2, 0.0, -np.sqrt(3) / 2])


@pytest.mark.parametrize("thickness", [0.3, 0.75, 1.5, 3.0, 8.0, 15.0])
def test_any_thickness_meshes_well(thickness: float) -> None:
    mesh = elliptic_ring((A, B), H, thickness, Layers(216, 17, 6))
    assert triangle_quality(mesh.cell_points).min() > 0.05
    assert on_ellipse(mesh.points[mesh.interface], A - thickness, B - thickness) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("thickness", "n_around", "word"), [(0.0, 216, "white"), (16.5, 216, "white"), (0.01, 24, "quality")]
)
def test_what_cannot_be_meshed_is_refused_with_a_reason(thickness: float, n_around: int, word: str) -> None:
    """The wall is 32.85 / 2 = 16.425 mm; layers of 0.01 / 6 mm on 24 points are slivers."""
    with pytest.raises(MeshError, match=word) as refusal:
        elliptic_ring((A, B), H, thickness, Layers(n_around, 17, 6))
    assert refusal.value.advice


def test_a_mesh_is_frozen() -> None:
    mesh = ring(24, 4, 2)
    with pytest.raises(ValueError, match="read-only"):
        mesh.points[0] = 0.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        mesh.points = mesh.points.copy()
