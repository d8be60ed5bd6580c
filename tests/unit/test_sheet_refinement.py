"""Refined and quadratic meshes: conforming, exact lines and areas, nested nodes, refusals."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from bodies import elliptic_ring, periodic_strip

from gyrify.errors import MeshError
from gyrify.mesh import GREY, WHITE, Mesh
from gyrify.mesh.layered_grid import Layers
from gyrify.mesh.quality import triangle_quality

A, B, H, T = 39.42, 32.85, 0.5, 1.5
LENGTH, DEPTH = 24.0, 12.0
KINDS = [
    {"refine": refine, "refine_cortex": cortex, "element": element}
    for (refine, cortex), element in itertools.product(
        [(0, 0), (1, 0), (0, 1), (0, 2), (1, 2), (0, 3)], ["linear", "quadratic"]
    )
]


def name(options: dict) -> str:
    return "-".join(str(value) for value in options.values())


def ring(n_around: int = 48, n_layers: int = 6, n_cortex: int = 2, **options) -> Mesh:
    return elliptic_ring((A, B), H, T, Layers(n_around, n_layers, n_cortex, **options))


def strip(n_around: int = 32, n_layers: int = 6, n_cortex: int = 2, **options) -> Mesh:
    return periodic_strip(LENGTH, DEPTH, T, Layers(n_around, n_layers, n_cortex, **options))


def directed_edges(mesh: Mesh) -> np.ndarray:
    corners = mesh.cells[:, :3]
    return np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)


def jacobians(mesh: Mesh, places: np.ndarray) -> np.ndarray:
    """(n_cells, n_places) det dX/dxi at places (r, s) of the reference triangle, by hand."""
    r, s = places.T
    t, zero, one = 1 - r - s, 0 * r, 1 + 0 * r
    if mesh.cells.shape[1] == 3:
        slopes = np.array([[-one, -one], [one, zero], [zero, one]])
    else:
        slopes = np.array(
            [
                [1 - 4 * t, 1 - 4 * t],
                [4 * r - 1, zero],
                [zero, 4 * s - 1],
                [4 * (t - r), -4 * r],
                [4 * s, 4 * r],
                [-4 * s, 4 * (t - s)],
            ]
        )
    return np.linalg.det(np.einsum("cai,ajq->cqij", mesh.cell_points, slopes))


def areas(mesh: Mesh) -> np.ndarray:
    """Areas of the cells with curved edges; the middles of the edges integrate the Jacobian exactly."""
    middles = np.array([[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]])
    return jacobians(mesh, middles).sum(axis=1) / 6.0


def ellipse_value(mesh: Mesh, row: np.ndarray, a: float, b: float) -> np.ndarray:
    return np.square(mesh.points[row] / [a, b]).sum(axis=1)


@pytest.mark.parametrize("build", [ring, strip])
@pytest.mark.parametrize("split", ["alternating", "one", "random"])
@pytest.mark.parametrize("options", KINDS, ids=name)
def test_meshes_conform(build, split: str, options: dict) -> None:
    """Each edge has two cells that run along it in opposite directions, but for contour and clamp."""
    mesh = build(split=split, node_jitter=0.02, seed=3, **options)
    directed = directed_edges(mesh)
    assert len(np.unique(directed, axis=0)) == len(directed)
    _, position, count = np.unique(np.sort(directed, axis=1), axis=0, return_inverse=True, return_counts=True)
    assert set(count) == {1, 2}
    outside = directed[count[position] == 1]
    stride = 1 if mesh.cells.shape[1] == 3 else 2
    for row in (mesh.contour, mesh.clamped):
        corners = row[::stride]
        around = {frozenset(pair) for pair in zip(corners, np.roll(corners, -1), strict=True)}
        assert around <= {frozenset(edge) for edge in outside.tolist()}
    assert len(outside) == (mesh.contour.size + mesh.clamped.size) // stride
    used = np.bincount(mesh.cells.ravel(), minlength=mesh.n_points)
    assert used.min() >= 1
    if stride == 2:  # the node in the middle of an edge belongs to that edge alone
        middles = mesh.cells[:, 3:].ravel()
        pairs = np.unique(np.stack([position, middles], axis=1), axis=0)
        assert len(pairs) == len(np.unique(position)) == len(np.unique(middles))


@pytest.mark.parametrize("build", [ring, strip])
@pytest.mark.parametrize("options", KINDS, ids=name)
def test_interface_separates_the_tissues_at_every_level(build, options: dict) -> None:
    """Its edges, and no others, lie between a grey and a white cell."""
    mesh = build(**options)
    edges = np.sort(directed_edges(mesh), axis=1)
    cell = np.repeat(np.arange(mesh.n_cells), 3)
    order = np.lexsort(edges.T)
    edges, cell = edges[order], cell[order]
    twice = np.all(edges[1:] == edges[:-1], axis=1)
    differ = twice & (mesh.region[cell[1:]] != mesh.region[cell[:-1]])
    corners = mesh.interface[:: 1 if mesh.cells.shape[1] == 3 else 2]
    expected = {frozenset(pair) for pair in zip(corners, np.roll(corners, -1), strict=True)}
    assert {frozenset(edge) for edge in edges[1:][differ].tolist()} == expected


@pytest.mark.parametrize("jitter", [0.0, 0.1])
@pytest.mark.parametrize("options", KINDS, ids=name)
def test_all_nodes_of_the_three_lines_lie_on_their_ellipses(options: dict, jitter: float) -> None:
    """Nodes in the middle of an edge too, at half the angle between its ends."""
    mesh = ring(node_jitter=jitter, seed=1, **options)
    for row, a, b in (
        (mesh.contour, A, B),
        (mesh.interface, A - T, B - T),
        (mesh.clamped, H * A, H * B),
    ):
        assert ellipse_value(mesh, row, a, b) == pytest.approx(1.0, abs=1e-14)
        if options["element"] == "quadratic":
            x, y = (mesh.points[row] / [a, b]).T
            angle = np.unwrap(np.arctan2(y, x))
            middle = 0.5 * (angle[:-1:2] + np.append(angle[2::2], angle[0] + 2 * np.pi))
            assert angle[1::2] == pytest.approx(middle, abs=1e-12)


@pytest.mark.parametrize("options", KINDS, ids=name)
def test_areas_of_the_tissues(options: dict) -> None:
    """Polygons of n edges: pi a b sin(t)/t, t = 2 pi/n; of n parabolic arcs: pi a b (8 sin(t/2) - sin t)/3t.

    The interface is a polygon of n edges seen from the cortex, and of the same n seen from the white matter.
    """
    mesh = ring(**options)
    curved = options["element"] == "quadratic"

    def within(row: np.ndarray, a: float, b: float) -> float:
        t = 2 * np.pi / (row.size // 2 if curved else row.size)
        share = (8 * np.sin(t / 2) - np.sin(t)) / (3 * t) if curved else np.sin(t) / t
        return np.pi * a * b * share

    outer, hole = within(mesh.contour, A, B), within(mesh.clamped, H * A, H * B)
    middle = within(mesh.interface, A - T, B - T)
    found = areas(mesh)
    assert found[mesh.region == GREY].sum() == pytest.approx(outer - middle, rel=1e-11)
    assert found[mesh.region == WHITE].sum() == pytest.approx(middle - hole, rel=1e-11)


@pytest.mark.parametrize("options", KINDS, ids=name)
def test_strip_areas(options: dict) -> None:
    mesh = strip(node_jitter=0.05, **options)
    found = areas(mesh)
    assert found[mesh.region == GREY].sum() == pytest.approx(LENGTH * T, rel=1e-12)
    assert found[mesh.region == WHITE].sum() == pytest.approx(LENGTH * (DEPTH - T), rel=1e-12)
    assert mesh.points[mesh.contour, 1] == pytest.approx(DEPTH, abs=1e-12)
    assert mesh.points[mesh.interface, 1] == pytest.approx(DEPTH - T, abs=1e-12)
    assert np.all(np.diff(mesh.points[mesh.contour, 0]) > 0.0)


@pytest.mark.parametrize("build", [ring, strip])
@pytest.mark.parametrize("options", KINDS, ids=name)
def test_cells_are_positive_at_all_their_nodes(build, options: dict) -> None:
    """Curved cells could be inverted at a corner and not on the whole."""
    mesh = build(node_jitter=0.05, **options)
    nodes = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]])
    at_nodes = jacobians(mesh, nodes)
    assert at_nodes.min() > 0.3 * at_nodes.mean(axis=1)[at_nodes.argmin() // 6]
    assert triangle_quality(mesh.cell_points[:, :3]).min() > 0.05


@pytest.mark.parametrize(("n_cortex", "level"), [(2, 1), (2, 2), (3, 3)])
def test_refining_the_cortex_leaves_the_deep_white_matter_alone(n_cortex: int, level: int) -> None:
    """Cortical cells fall to a quarter each time; one white layer per level takes half as many again."""
    base = ring(48, 8, n_cortex)
    fine = ring(48, 8, n_cortex, refine_cortex=level)
    grey = [np.count_nonzero(mesh.region == GREY) for mesh in (base, fine)]
    assert grey[1] == 4**level * grey[0]
    white = [np.count_nonzero(mesh.region == WHITE) for mesh in (base, fine)]
    # a band between n and 2n columns has 3n triangles; those above it have doubled columns
    extra = sum(3 * 48 * 2**k - 2 * 48 for k in range(level))
    assert white[1] == white[0] + extra
    n_white = 8 - n_cortex
    deep = 48 * (n_white - level + 1)
    assert np.array_equal(fine.points[:deep], base.points[:deep])
    assert fine.contour.size == 48 * 2**level
    assert fine.clamped.size == 48


@pytest.mark.parametrize("build", [ring, strip])
@pytest.mark.parametrize("key", ["refine", "refine_cortex"])
def test_nodes_are_nested(build, key: str) -> None:
    """Every node of a mesh is one of the next finer mesh: layers and columns are halved."""
    levels = [build(48, 7, 2, **{key: level}).points for level in range(4)]
    for coarse, fine in itertools.pairwise(levels):
        places = {tuple(point) for point in np.round(fine, 9) + 0.0}
        assert {tuple(point) for point in np.round(coarse, 9) + 0.0} <= places


@pytest.mark.parametrize("build", [ring, strip])
def test_nodes_of_quadratic_cells_are_those_of_the_refined_mesh(build) -> None:
    """Except where columns double, the nodes between halved layers and columns are the same set."""
    quadratic, refined = build(element="quadratic"), build(refine=1)
    places = [{tuple(point) for point in np.round(mesh.points, 9) + 0.0} for mesh in (quadratic, refined)]
    assert places[0] == places[1]
    assert np.allclose(quadratic.points[quadratic.contour], refined.points[refined.contour])


def test_patches_are_quadrilaterals() -> None:
    """Two triangles of one tissue each, three where columns double; they meet along their diagonals."""
    mesh = ring(refine_cortex=2)
    size = np.bincount(mesh.patch)
    assert set(size) == {2, 3}
    assert np.count_nonzero(size == 3) == 48 + 96
    for tissue in (GREY, WHITE):
        assert not set(mesh.patch[mesh.region == tissue]) & set(mesh.patch[mesh.region != tissue])
    corners = [np.unique(mesh.cells[mesh.patch == patch]) for patch in range(0, size.size, 7)]
    assert {len(nodes) for nodes in corners} == {4, 5}


@pytest.mark.parametrize("build", [ring, strip])
@pytest.mark.parametrize(("n_layers", "refine", "level"), [(3, 0, 2), (3, 0, 4), (4, 0, 3), (3, 1, 3)])
def test_too_few_white_layers_for_the_transitions_are_refused(
    build, n_layers: int, refine: int, level: int
) -> None:
    with pytest.raises(MeshError, match="white layers") as refusal:
        build(48, n_layers, 2, refine=refine, refine_cortex=level)
    assert "mesh.n_layers" in refusal.value.advice


@pytest.mark.parametrize("build", [ring, strip])
def test_just_enough_white_layers_are_accepted(build) -> None:
    """One white layer refined once, two after refining everywhere."""
    assert build(48, 3, 2, refine_cortex=1).clamped.size == 48
    assert build(48, 3, 2, refine=1, refine_cortex=2).clamped.size == 96


def test_a_refined_mesh_is_frozen() -> None:
    mesh = ring(refine_cortex=1, element="quadratic")
    for array in (mesh.points, mesh.cells, mesh.patch, mesh.region):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
