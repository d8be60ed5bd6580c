"""Bodies inside surfaces from files: their meshes, and runs that need nothing outside their folder."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from solids import BALL
from test_elements_in_space import _error
from written_surfaces import config, ellipsoid, off, stl

from gyrify.config import Config
from gyrify.errors import ConfigError, MeshError
from gyrify.mesh import GREY, WHITE, Mesh
from gyrify.mesh.cell_clusters import edge_clusters
from gyrify.mesh.filling import _require_full
from gyrify.mesh.offset_surface import offset_surface
from gyrify.mesh.quality import tetrahedron_quality
from gyrify.metrics.surface_pairs import contains, crosses_itself, crossings
from gyrify.model import kept_mesh
from gyrify.model.meshing import build_mesh
from gyrify.model.slice import Slice
from gyrify.run.onset.smooth import grown
from gyrify.run.validity import config_warnings
from gyrify.run.validity.expected import expected_onset

AXES = (36.0, 30.0, 24.0)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("surfaces")
    off(folder / "brain.off", *ellipsoid(4, AXES))
    off(folder / "hole.off", *ellipsoid(3, (12.0, 10.0, 8.0)))
    off(folder / "inner.off", *ellipsoid(4, (31.0, 25.0, 20.0)))
    return folder


def volumes(mesh: Mesh) -> np.ndarray:
    corners = mesh.cell_points
    return np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6.0


def boundary_of(mesh: Mesh) -> tuple[set[tuple[int, ...]], set[int]]:
    faces = np.sort(mesh.cells[:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]].reshape(-1, 3), axis=1)
    found, counts = np.unique(faces, axis=0, return_counts=True)
    return {tuple(face) for face in found[counts == 1].tolist()}, set(counts)


WAYS = {
    "solid": {},
    "hollow": {"geometry.hole_file": "hole.off"},
    "interface": {"geometry.interface_file": "inner.off"},
    "refined": {"mesh.refine": 1},
    "jitter": {"mesh.node_jitter": 0.1},
    "five layers": {"mesh.n_cortex_layers": 5},
}


@pytest.mark.parametrize("way", WAYS)
def test_cells_fill_the_body_and_keep_its_surfaces(way: str, files: Path) -> None:
    given = {k: str(files / v) if str(v).endswith(".off") else v for k, v in WAYS[way].items()}
    given = config(files / "brain.off", **given)
    mesh = build_mesh(given)
    assert volumes(mesh).min() > 0.0
    assert tetrahedron_quality(mesh.cell_points).min() > 0.15
    boundary, counts = boundary_of(mesh)
    assert counts == {1, 2}
    outer = {tuple(sorted(face)) for face in mesh.faces.tolist()}
    assert outer <= boundary
    assert {point for face in boundary - outer for point in face} == set(mesh.clamped.tolist())
    assert (mesh.clamped.size > 0) == (way == "hollow")
    hole = 0.0 if given.geometry.hole_surface is None else given.geometry.hole_surface.volume
    assert volumes(mesh).sum() == pytest.approx(given.geometry.surface.volume - hole, rel=1e-9)
    n = given.geometry.surface.points.shape[0]
    assert np.array_equal(mesh.points[mesh.contour[:n]], given.geometry.surface.points)
    # the interface parts the tissues
    inner = {tuple(sorted(face)) for face in mesh.interface_faces.tolist()}
    for tissue in (GREY, WHITE):
        own = np.sort(
            mesh.cells[mesh.region == tissue][:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]], axis=2
        )
        assert inner <= {tuple(face) for face in own.reshape(-1, 3).tolist()}
    layers = given.mesh.n_cortex_layers * 2**given.mesh.refine
    assert np.unique(mesh.depth[mesh.depth >= 1.0]).size == layers + 1
    assert (mesh.region == GREY).sum() == 3 * layers * mesh.faces.shape[0]
    if way != "interface":
        across = mesh.points[mesh.contour] - mesh.points[mesh.interface]
        assert np.linalg.norm(across, axis=1) == pytest.approx(3.0, rel=1e-12)
    assert np.linalg.norm(mesh.across, axis=1) == pytest.approx(1.0)
    normal = mesh.cell_points.mean(axis=1) / np.square(AXES)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    assert np.einsum("ni,ni->n", normal, mesh.across)[mesh.region == GREY].min() > 0.98


def test_cells_grow_inwards(tmp_path: Path) -> None:
    path = off(tmp_path / "fine.off", *ellipsoid(6, AXES))
    graded, even = (build_mesh(config(path, **{"mesh.grading": word})) for word in ("geometric", "uniform"))
    white, small = (volumes(mesh)[mesh.region == WHITE] for mesh in (graded, even))
    assert small.size > 1.2 * white.size
    assert np.percentile(white, 95) > 1.5 * np.percentile(small, 95)


def test_the_mesh_has_the_same_bytes_each_time(files: Path) -> None:
    given = config(files / "hole.off", **{"geometry.cortical_thickness": 1.5})
    kept_mesh._made.clear()
    first = kept_mesh.mesh_bytes(given)
    kept_mesh._made.clear()
    assert kept_mesh.mesh_bytes(given) == first


def test_interface_is_exact_under_a_sphere() -> None:
    points, triangles = ellipsoid(10, (20.0, 20.0, 20.0))
    cortex = offset_surface(points, triangles, 3.0, 3)
    assert np.linalg.norm(cortex.inner, axis=1) == pytest.approx(17.0, rel=5e-4)
    assert cortex.share.min() == 1.0


def test_a_sharp_rim_gets_a_thinner_cortex_and_says_so(tmp_path: Path) -> None:
    """The rim of a flat disc has not room for the cortex: curvature there is far below its thickness."""
    given = config(off(tmp_path / "disc.off", *ellipsoid(8, (30.0, 30.0, 9.0))))
    mesh = build_mesh(given)
    thickness = np.linalg.norm(mesh.points[mesh.contour] - mesh.points[mesh.interface], axis=1)
    assert thickness.max() == pytest.approx(3.0)
    assert 0.6 < thickness.min() < 2.7
    rim = np.linalg.norm(mesh.points[mesh.contour][:, :2], axis=1)
    assert rim[np.argmin(thickness)] > 28.0
    assert tetrahedron_quality(mesh.cell_points).min() > 0.05
    surface = np.concatenate([mesh.points[mesh.contour], mesh.points[mesh.interface]])
    both = np.concatenate([mesh.interface_faces, mesh.interface_faces + mesh.contour.size])
    assert not crosses_itself(surface, both)
    (told,) = [text for text in config_warnings(given) if "thinner than 0.9 T" in text]
    assert "down to" in told


def test_too_thick_a_cortex_is_refused_with_a_place(tmp_path: Path) -> None:
    path = off(tmp_path / "plate.off", *ellipsoid(8, (30.0, 30.0, 3.0)))
    with pytest.raises(MeshError, match=r"2.5 mm does not fit under the surface at \("):
        build_mesh(config(path, **{"geometry.cortical_thickness": 2.5}))
    with pytest.raises(ConfigError, match="6 mm thick at most"):
        config(path, **{"geometry.cortical_thickness": 4.0})


def test_what_crosses_is_refused_with_a_place(files: Path, tmp_path: Path) -> None:
    points, triangles = ellipsoid(5, AXES)
    pulled = np.where(points[:, :1] > 33.0, points * [-1.4, 1.0, 1.0], points)
    with pytest.raises(MeshError, match=r"crosses itself: \d+ edges .* first at \(-"):
        build_mesh(config(off(tmp_path / "pulled.off", pulled, triangles)))
    for axes in ((34.0, 10.0, 8.0), (80.0, 70.0, 60.0)):
        hole = off(tmp_path / "hole.off", *ellipsoid(3, axes))
        with pytest.raises(MeshError, match="hole is not inside the white matter"):
            build_mesh(config(files / "brain.off", **{"geometry.hole_file": str(hole)}))
    outside = off(tmp_path / "inner.off", *ellipsoid(4, (37.0, 31.0, 25.0)))
    with pytest.raises(MeshError, match="interface does not lie under the surface"):
        build_mesh(config(files / "brain.off", **{"geometry.interface_file": str(outside)}))
    other = off(tmp_path / "other.off", *ellipsoid(5, (31.0, 25.0, 20.0)))
    with pytest.raises(ConfigError, match="not the same triangles"):
        build_mesh(config(files / "brain.off", **{"geometry.interface_file": str(other)}))


def test_crossings_are_found_whatever_the_sizes() -> None:
    """A long needle through a fine ball: what is near in the middle is far from its ends."""
    points, triangles = ellipsoid(8, (5.0, 5.0, 5.0))
    needle = np.array([[-200.0, 0.1, 0.2], [200.0, 0.15, 0.1], [0.0, 0.3, 0.1], [0.0, 0.2, 0.4]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]) + len(points)
    edges, hit = crossings(np.concatenate([points, needle]), np.concatenate([triangles, faces]))
    ends = {tuple(edge) for edge in edges.tolist()}
    assert (len(points), len(points) + 1) in ends
    assert hit.size >= 2
    apart = np.concatenate([points, needle + np.array([0.0, 50.0, 0.0])])
    assert crossings(apart, np.concatenate([triangles, faces]))[1].size == 0


def test_inside_is_where_the_solid_angle_is_full() -> None:
    points, triangles = ellipsoid(5, AXES)
    corners = points[triangles]
    for place, inside in (
        ([35.0, 0, 0], True),
        ([36.5, 0, 0], False),
        ([0, 29, 0], True),
        ([0, 0, 25], False),
    ):
        assert contains(corners, np.array(place, float)) == inside


def test_clusters_are_joined_and_of_about_five(files: Path) -> None:
    mesh = build_mesh(config(files / "brain.off"))
    white = mesh.cells[mesh.region == WHITE]
    cluster = edge_clusters(mesh.points, white)
    sizes = np.bincount(cluster)
    assert sizes.min() >= 1
    assert 4.0 < sizes.mean() < 6.5
    for k in range(0, sizes.size, 7):
        own = white[cluster == k]
        shared = [np.intersect1d(own[0], cell).size for cell in own]
        assert min(shared) >= 1
    assert np.array_equal(np.unique(mesh.patch), np.arange(mesh.patch.max() + 1))


@pytest.mark.parametrize(
    ("law", "frequencies", "most"),
    [
        ("isotropic", (3, 6), 0.04),
        ("area", (3, 6), 0.02),
        pytest.param("isotropic", (8, 16), 0.004, marks=pytest.mark.slow),
        pytest.param("area", (8, 16), 0.002, marks=pytest.mark.slow),
    ],
)
def test_a_ball_from_a_file_grows_as_exact_theory_says(
    law: str, frequencies: tuple[int, int], most: float, tmp_path: Path
) -> None:
    """Most of the error is that the flat triangles lie inside the ball; it falls with the square of edges."""
    errors = []
    for frequency in frequencies:
        path = stl(tmp_path / f"{frequency}.stl", *ellipsoid(frequency))
        given = {"mesh.element": "mean_dilatation", "growth.law": law, "mesh.node_jitter": 0.0}
        problem = Slice(config(path, **given, **{"dissipation.kind": "none", "contact.enabled": False}))
        state = grown(problem, problem.system(np.empty((0, 2), dtype=np.int64)), 0.3)
        errors.append(_error(problem, state.u, 150.0))
    assert errors[1] < most
    assert errors[0] > 3.0 * errors[1]


def test_onset_is_expected_of_a_sphere_alone(files: Path, tmp_path: Path) -> None:
    ball = expected_onset(config(stl(tmp_path / "ball.stl", *ellipsoid(10))))
    sphere = {key: value for key, value in BALL.items() if not key.startswith("mesh.")}
    of_shape = expected_onset(Config().replace(**sphere))
    assert ball.theory == of_shape.theory == "sphere"
    assert ball.growth_time == pytest.approx(of_shape.growth_time, rel=0.02)
    brain = expected_onset(config(files / "brain.off"))
    assert brain.growth_time is None
    assert "surface of geometry.file has another shape" in brain.not_covered


def test_every_part_of_a_hole_must_lie_inside(files: Path, tmp_path: Path) -> None:
    points, triangles = ellipsoid(3, (12.0, 10.0, 8.0))
    both = np.concatenate([points, points + np.array([60.0, 0.0, 0.0])])
    hole = off(tmp_path / "two.off", both, np.concatenate([triangles, triangles + len(points)]))
    with pytest.raises(MeshError, match=r"hole is not inside the white matter.* at \((4|5|6|7)"):
        build_mesh(config(files / "brain.off", **{"geometry.hole_file": str(hole)}))


def test_a_part_that_is_left_empty_is_no_mesh() -> None:
    """Netgen may give up without an error."""
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    corners = points[[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]]
    _require_full(points, np.array([[0, 1, 2, 3]]), corners)
    with pytest.raises(MeshError, match=r"filled 0 of the 0\.1667 mm³"):
        _require_full(points, np.empty((0, 4), dtype=np.int64), corners)


def test_an_interface_on_the_surface_is_refused_with_a_place(files: Path, tmp_path: Path) -> None:
    outer, triangles = ellipsoid(4, AXES)
    inner, _ = ellipsoid(4, (31.0, 25.0, 20.0))
    inner[7] = outer[7]
    path = off(tmp_path / "inner.off", inner, triangles)
    given = config(files / "brain.off", **{"geometry.interface_file": str(path)})
    with pytest.raises(ConfigError, match="coincide at 1 points, first at"):
        build_mesh(given)
