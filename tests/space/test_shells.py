"""Tetrahedra in shells: they fill the body, fit together, and keep its surfaces."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from gyrify.errors import ConfigError, MeshError
from gyrify.mesh import GREY, Mesh
from gyrify.mesh.nested_surface import icosphere, nearest_frequency, periodic_sheet
from gyrify.mesh.quality import tetrahedron_quality
from gyrify.mesh.shapes import Ellipsoid, Patch
from gyrify.mesh.shelled import ShellLayers, shell_mesh

SOLID, HOLLOW = Ellipsoid((36.0, 30.0, 24.0), 0.0, 1.5), Ellipsoid((36.0, 30.0, 24.0), 0.4, 1.5)
PATCH = Patch(20.0, 15.0, 18.0, 1.5)
SHAPES = {"solid": SOLID, "hollow": HOLLOW, "patch": PATCH}
WAYS = {
    "plain": {},
    "jitter": {"node_jitter": 0.1},
    "refine": {"refine": 1},
    "refine_cortex": {"refine_cortex": 1},
    "uniform": {"grading": "uniform"},
}


def built(shape: Any, **way: Any) -> Mesh:
    return shell_mesh(shape, ShellLayers(**{"edge_length": 3.0, "n_layers": 7, "n_cortex_layers": 2, **way}))


def volumes(mesh: Mesh) -> np.ndarray:
    corners = mesh.cell_points
    return np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6.0


def faces_of(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    faces = np.sort(mesh.cells[:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]].reshape(-1, 3), axis=1)
    return np.unique(faces, axis=0, return_counts=True)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", SHAPES)
def test_cells_fit_together_and_end_at_the_surfaces(name: str, way: str) -> None:
    mesh = built(SHAPES[name], **WAYS[way])
    assert volumes(mesh).min() > 0.0
    assert tetrahedron_quality(mesh.cell_points).min() > 0.2
    faces, counts = faces_of(mesh)
    assert set(counts) == {1, 2}
    boundary = {tuple(face) for face in faces[counts == 1]}
    outer = {tuple(sorted(face)) for face in mesh.faces.tolist()}
    assert outer <= boundary
    inner = boundary - outer
    assert (len(inner) == 0) == (name == "solid")
    assert {point for face in inner for point in face} == set(mesh.clamped.tolist())


@pytest.mark.parametrize("way", ["plain", "jitter"])
def test_surface_and_interface_lie_on_their_ellipsoids(way: str) -> None:
    mesh = built(SOLID, **WAYS[way])
    for points, axes in ((mesh.contour, (36.0, 30.0, 24.0)), (mesh.interface, (34.5, 28.5, 22.5))):
        assert np.square(mesh.points[points] / axes).sum(axis=1) == pytest.approx(1.0, abs=1e-12)
    moved = built(SOLID).points - mesh.points
    assert (np.abs(moved).max() > 0.0) == (way == "jitter")


def test_interface_parts_the_tissues() -> None:
    """Faces between grey and white are those of the interface, all of them."""
    mesh = built(SOLID)
    faces = np.sort(mesh.cells[:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]], axis=2)
    by_tissue = [
        {tuple(face) for face in faces[mesh.region == tissue].reshape(-1, 3).tolist()} for tissue in (0, 1)
    ]
    assert by_tissue[0] & by_tissue[1] == {tuple(sorted(f)) for f in mesh.interface_faces.tolist()}


def test_volume_tends_to_that_of_the_ellipsoid_with_the_square_of_the_edge() -> None:
    exact = 4.0 / 3.0 * np.pi * 36.0 * 30.0 * 24.0
    errors = [1.0 - volumes(built(SOLID, refine=k)).sum() / exact for k in (0, 1)]
    assert 0.0 < errors[1] < errors[0] < 0.01
    assert errors[0] / errors[1] == pytest.approx(4.0, abs=0.2)
    assert volumes(built(PATCH)).sum() == pytest.approx(20.0 * 15.0 * 18.0, rel=1e-12)


def test_faces_look_outwards_and_normals_too() -> None:
    for shape in SHAPES.values():
        mesh = built(shape)
        corners = mesh.unwrapped(mesh.faces)
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        out = corners.mean(axis=1) if mesh.period is None else np.array([[0.0, 0.0, 1.0]])
        assert (np.einsum("ni,ni->n", normal, np.broadcast_to(out, normal.shape)) > 0.0).all()
        assert np.linalg.norm(mesh.across, axis=1) == pytest.approx(1.0)
    mesh = built(SOLID)
    x = mesh.cell_points.mean(axis=1)[mesh.region == GREY]
    gradient = x / np.square([35.25, 29.25, 23.25])
    gradient /= np.linalg.norm(gradient, axis=1, keepdims=True)
    assert np.einsum("ni,ni->n", gradient, mesh.across[mesh.region == GREY]).min() > 0.999


def test_a_patch_is_a_prism_or_a_transition() -> None:
    mesh = built(SOLID)
    assert set(np.bincount(mesh.patch)) <= {1, 3, 7}
    grey = np.bincount(mesh.patch[mesh.region == GREY])
    assert set(grey[grey > 0]) == {3}


def test_frequencies() -> None:
    for edge in (0.5, 0.2, 0.1, 0.03):
        surface = icosphere(nearest_frequency(edge))
        corners = surface.places[surface.triangles[-1]]
        mean = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean()
        assert 0.7 < mean / edge < 1.4
    with pytest.raises(ValueError, match="frequency 7"):
        icosphere(7)


def test_levels_are_nested() -> None:
    for surface in (icosphere(12), periodic_sheet(4, 2, 2)):
        for level in range(surface.n_levels - 1):
            fine = {tuple(sorted(t)) for t in surface.triangles[level + 1].tolist()}
            middles = {tuple(sorted(t)) for t in surface.middles[level].tolist()}
            assert middles <= fine
            assert surface.n_points(level) < surface.n_points(level + 1)


def test_the_same_bytes_each_time_and_others_with_another_seed() -> None:
    first, second, other = (built(SOLID, node_jitter=0.05, seed=s).points for s in (3, 3, 4))
    assert first.tobytes() == second.tobytes()
    assert first.tobytes() != other.tobytes()


@pytest.mark.parametrize(
    "shape", [lambda T: Ellipsoid((20.0, 20.0, 20.0), 0.5, T), lambda T: Patch(9, 9, 10.0, T)]
)
def test_a_cortex_without_white_matter_is_refused(shape: Any) -> None:
    with pytest.raises(MeshError, match="leaves no white matter"):
        shape(10.0)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"geometry.shape": "ellipse", "geometry.hole_fraction": 0.0}, "from 0.1 to 0.9. Try 0.1"),
        ({"geometry.shape": "sphere", "geometry.hole_fraction": 0.05}, "or 0, a solid body"),
        ({"geometry.shape": "sphere", "mesh.split": "one"}, "mesh.split = \"one\" is not allowed in space"),
        ({"geometry.shape": "sphere", "growth.out_of_plane": "none"}, "no meaning there"),
        ({"geometry.shape": "sphere", "mesh.inversion_resistance": 0.1}, "it is built for triangles"),
        ({"geometry.shape": "patch", "boundary.clamp": "none"}, "its lower side stands for tissue"),
        ({"mesh.edge_length": 2.0}, "in the plane"),
        ({"growth.transition": 0.2}, "a step has no width"),
        ({"geometry.shape": "sphere", "mesh.edge_length": 0.2}, "Try mesh.edge_length = "),
        ({"geometry.semi_axes": [1.0, 2.0]}, "a list of 3 numbers above 0"),
    ],
)  # fmt: skip
def test_what_makes_no_sense_is_refused_by_name(given: dict[str, Any], said: str) -> None:
    from gyrify.config import Config

    with pytest.raises(ConfigError, match=said):
        Config().with_overrides(given)


def test_advice_on_too_many_cells_works() -> None:
    from gyrify.config import Config

    with pytest.raises(ConfigError) as refused:
        Config().with_overrides({"geometry.shape": "sphere", "mesh.edge_length": 0.2})
    edge = float(str(refused.value).split("mesh.edge_length = ")[1].split(",")[0])
    assert Config().with_overrides({"geometry.shape": "sphere", "mesh.edge_length": edge})
