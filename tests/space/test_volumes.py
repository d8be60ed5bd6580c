"""Bodies of tetrahedra from files: formats, tissues, refinement, refusals, runs that need nothing outside."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
from test_elements_in_space import _error
from written_volumes import ball, config, plain

from gyrify.config import Config
from gyrify.config.inputs.volume_readers import read_tetrahedra
from gyrify.errors import ConfigError, MeshError
from gyrify.mesh import GREY, WHITE
from gyrify.metrics.tetrahedra import boundary_faces, signed_volumes
from gyrify.model import kept_mesh
from gyrify.model.body import cortical_share
from gyrify.model.meshing import build_mesh
from gyrify.model.slice import Slice
from gyrify.report.outputs import write_outputs
from gyrify.run.onset.smooth import grown
from gyrify.run.simulation import simulate
from gyrify.run.validity import config_warnings
from gyrify.run.validity.expected import expected_onset
from gyrify.store.export import export
from gyrify.verify.recheck import verify

POINTS, CELLS = ball(3)
MIDDLE = np.linalg.norm(POINTS[CELLS].mean(axis=1), axis=1)


def _meshio(path: Path, **cell_data: Any) -> Path:
    data = {name.replace("_", ":"): [values] for name, values in cell_data.items()}
    # its writer of BDF has no room for more digits
    mesh = meshio.Mesh(np.round(POINTS, 6), [("tetra", CELLS)], cell_data=data)
    meshio.write(path, mesh, file_format="gmsh22" if path.suffix == ".msh" else None)
    return path


FORMATS = {
    "a.mesh": lambda path: plain(path, POINTS, CELLS),
    "b.mesh": _meshio,
    "a.vtu": _meshio,
    "a.vtk": _meshio,
    "a.msh": _meshio,
    "a.inp": _meshio,
    "a.bdf": _meshio,
    "a.su2": _meshio,
    "a.avs": _meshio,
}


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_gives_the_same_body(name: str, tmp_path: Path) -> None:
    given = config(FORMATS[name](tmp_path / name))
    mesh = build_mesh(given)
    assert mesh.cells.shape == CELLS.shape
    assert mesh.points == pytest.approx(POINTS, abs=1e-5)
    assert signed_volumes(mesh.cell_points).min() > 0.0
    radius = np.linalg.norm(mesh.points[mesh.contour], axis=1)
    assert radius == pytest.approx(20.0, rel=1e-5)
    volume = np.abs(np.linalg.det(POINTS[CELLS[:, 1:]] - POINTS[CELLS[:, :1]])).sum() / 6.0
    assert given.geometry.mean_radius == pytest.approx(np.cbrt(0.75 * volume / np.pi), rel=1e-5)
    assert mesh.clamped.size == 0


def test_tissue_is_told_by_depth(tmp_path: Path) -> None:
    given = config(plain(tmp_path / "a.mesh", POINTS, CELLS))
    mesh = build_mesh(given)
    deep = 20.0 - np.linalg.norm(mesh.cell_points, axis=2).mean(axis=1)
    assert deep[mesh.region == GREY].max() < 6.5
    assert deep[mesh.region == WHITE].min() > 5.0
    inside = np.linalg.norm(mesh.points, axis=1)
    assert mesh.depth[mesh.contour] == pytest.approx(2.0)
    shallow = inside > 14.5
    # a flat triangle lies inside the sphere
    assert 2.0 - mesh.depth[shallow] == pytest.approx((20.0 - inside[shallow]) / 6.0, abs=0.3)
    normal = mesh.cell_points.mean(axis=1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    assert np.einsum("ni,ni->n", normal, mesh.across)[mesh.region == GREY].min() > 0.9
    (told,) = [text for text in config_warnings(given) if "no labels" in text]
    assert "rough" in told
    # the sigmoid profile is by the mean depth of the corners, also of cells on both sides of the interface
    places = Slice(given.replace(**{"growth.profile": "sigmoid"}))._places()
    share = cortical_share(given, places)
    corners = 20.0 - np.linalg.norm(mesh.cell_points, axis=2)
    wanted = 1.0 / (1.0 + np.exp(10.0 * (corners.mean(axis=1) / 6.0 - 1.0)))
    assert np.abs(share - wanted).mean() < 0.02


@pytest.mark.parametrize("way", ["a.mesh", "a.vtu", "a.msh", "b.mesh"])
def test_tissue_is_told_by_labels(way: str, tmp_path: Path) -> None:
    """And what is labelled as a hole is left out; its surface is held."""
    labels = np.where(MIDDLE > 12.0, 7, np.where(MIDDLE > 7.0, 3, 5))
    name = {"a.vtu": "label", "a.msh": "gmsh_physical", "b.mesh": "medit_ref"}
    path = tmp_path / way
    if way == "a.mesh":
        plain(path, POINTS, CELLS, labels)
    else:
        _meshio(path, **{name[way]: labels})
    given = config(path, **{"geometry.labels": {"grey": [7], "white": [3], "hole": [5]}})
    mesh = build_mesh(given)
    middle = np.linalg.norm(mesh.cell_points.mean(axis=1), axis=1)
    assert mesh.n_cells == (labels != 5).sum()
    assert np.array_equal(mesh.region == GREY, middle > 12.0)
    boundary = boundary_faces(mesh.cells)
    assert set(boundary.ravel()) == set(mesh.contour) | set(mesh.clamped)
    assert np.linalg.norm(mesh.points[mesh.clamped], axis=1).max() < 10.0
    assert mesh.clamped.size > 0
    # faces of the interface lie between the tissues and point outwards
    corners = mesh.points[mesh.interface_faces]
    outwards = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.einsum("ni,ni->n", outwards, corners.mean(axis=1)).min() > -1e-9
    again = Config.from_toml(given.to_toml())
    assert again.config_hash == given.config_hash
    assert again.geometry.labels == given.geometry.labels


def test_depth_of_labelled_tissue_lies_between_its_surfaces(tmp_path: Path) -> None:
    """A cortex of any thickness grows up to its own interface."""
    inner = np.abs(POINTS[CELLS].mean(axis=1)).max(axis=1)
    path = plain(tmp_path / "a.mesh", POINTS, CELLS, np.where(inner > 8.0, 1, 2))
    given = {"geometry.labels": {"grey": [1], "white": [2]}, "geometry.cortical_thickness": 3.0}
    mesh = build_mesh(config(path, **given))
    assert mesh.depth[mesh.contour] == pytest.approx(2.0)
    assert mesh.depth[mesh.interface] == pytest.approx(1.0)
    grey, white = (np.unique(mesh.cells[mesh.region == tissue]) for tissue in (GREY, WHITE))
    assert mesh.depth[grey].min() >= 1.0 - 1e-12
    assert mesh.depth[white].max() <= 1.0 + 1e-12
    assert any("thick on average" in text for text in config_warnings(config(path, **given)))


def test_refinement_keeps_the_body(tmp_path: Path) -> None:
    path = plain(tmp_path / "a.mesh", POINTS, CELLS, np.where(MIDDLE > 12.0, 7, 3))
    given = {"geometry.labels": {"grey": [7], "white": [3]}}
    coarse = build_mesh(config(path, **given))
    fine = build_mesh(config(path, **given, **{"mesh.refine": 1}))
    assert fine.n_cells == 8 * coarse.n_cells
    assert fine.faces.shape[0] == 4 * coarse.faces.shape[0]
    volumes = signed_volumes(fine.cell_points)
    assert volumes.min() > 0.0
    assert volumes.sum() == pytest.approx(signed_volumes(coarse.cell_points).sum(), rel=1e-12)
    grey = [signed_volumes(m.cell_points)[m.region == GREY].sum() for m in (coarse, fine)]
    assert grey[1] == pytest.approx(grey[0], rel=1e-12)
    # every face within belongs to two cells
    assert boundary_faces(fine.cells).shape[0] == fine.faces.shape[0]


def test_a_ball_of_tetrahedra_grows_as_exact_theory_says(tmp_path: Path) -> None:
    """With an interface that is no sphere: what is left falls with the mesh."""
    errors = []
    for n in (4, 8):
        points, cells = ball(n, 36.0)
        radius = np.linalg.norm(points[cells].mean(axis=1), axis=1)
        labels = np.where(radius > 27.0, 1, 0)
        overrides = {
            "geometry.labels": {"grey": [1], "white": [0]},
            "geometry.cortical_thickness": 9.0,
            "mesh.element": "mean_dilatation",
            "dissipation.kind": "none",
            "contact.enabled": False,
        }
        problem = Slice(config(plain(tmp_path / f"{n}.mesh", points, cells, labels), **overrides))
        state = grown(problem, problem.system(np.empty((0, 2), dtype=np.int64)), 0.3)
        errors.append(_error(problem, state.u, 150.0))
    assert errors[1] < 0.02
    assert errors[0] > 3.0 * errors[1]


def test_onset_is_expected_of_a_ball_alone(tmp_path: Path) -> None:
    of = {}
    for name, axes in (("ball", (1.0, 1.0, 1.0)), ("brain", (1.2, 1.0, 0.9))):
        points, cells = ball(3, axes=axes)
        of[name] = expected_onset(config(plain(tmp_path / f"{name}.mesh", points, cells)))
    labels = np.where(MIDDLE > 12.0, 7, np.where(MIDDLE > 7.0, 3, 5))
    path = plain(tmp_path / "hole.mesh", POINTS, CELLS, labels)
    hole = {"geometry.labels": {"grey": [7], "white": [3], "hole": [5]}}
    of["hole"] = expected_onset(config(path, **hole))
    assert of["ball"].theory == "sphere"
    for name in ("brain", "hole"):
        assert of[name].growth_time is None
        assert "has another shape" in of[name].not_covered


def test_a_run_needs_nothing_outside_its_folder(tmp_path: Path) -> None:
    path = plain(tmp_path / "a.mesh", *ball(3, axes=(1.2, 1.0, 0.9)))
    history = simulate(config(path, **{"solver.increments": 3, "growth.duration": 100.0}), tmp_path / "run")
    write_outputs(history, tmp_path / "run")
    path.unlink()
    kept_mesh._made.clear()
    found = verify(tmp_path / "run")
    assert [check.sentence for check in found.checks if not check.passed] == []
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert summary["parameters"]["geometry.file"] == "inputs/surface.mesh"
    assert any("no labels" in text for text in summary["warnings"])
    # its own export is a volume again
    (grid, *_) = export(history, "vtu", tmp_path / "again.vtu")
    again = build_mesh(config(grid, **{"geometry.labels": {"grey": [1], "white": [0]}}))
    assert again.n_cells == history.mesh.n_cells
    assert np.array_equal(again.region, history.mesh.region)


FAULTS: list[tuple[str, dict[str, Any], type[Exception], str]] = [
    (
        "labels",
        {"geometry.labels": {"grey": [1], "white": [4]}},
        ConfigError,
        "label 3, which .* nowhere",
    ),
    ("labels", {"geometry.labels": {"grey": [1, 3]}}, ConfigError, "no tetrahedron of .* white matter"),
    ("labels", {"geometry.labels": {"white": [1, 3]}}, ConfigError, "no tetrahedron of .* grey matter"),
    ("labels", {"geometry.labels": {"grey": [1], "white": [1, 3]}}, ConfigError, "names the label 1 twice"),
    ("labels", {"geometry.labels": {"grey": [1], "hole": [1], "white": [3]}}, ConfigError, "label 1 twice"),
    ("bare", {"geometry.labels": {"grey": [1], "white": [3]}}, ConfigError, "have no labels"),
    ("plain", {"geometry.hole_file": "plain"}, ConfigError, "hole_file is not allowed"),
    ("plain", {"geometry.interface_file": "plain"}, ConfigError, "interface_file is not allowed"),
    ("plain", {"mesh.refine_cortex": 1}, ConfigError, "refine_cortex = 1 is not allowed"),
    ("plain", {"mesh.refine": 4}, ConfigError, "about .* cells are not allowed"),
    ("plain", {"mesh.element": "quadratic"}, ConfigError, "quadratic"),
    ("plain", {"geometry.unit": "m"}, ConfigError, "geometry.unit"),
]


@pytest.mark.parametrize(("name", "overrides", "kind", "words"), FAULTS)
def test_what_does_not_fit_is_refused(
    name: str, overrides: dict[str, Any], kind: type[Exception], words: str, tmp_path: Path
) -> None:
    paths = {
        "plain": plain(tmp_path / "a.mesh", POINTS, CELLS),
        "labels": plain(tmp_path / "b.mesh", POINTS, CELLS, np.where(MIDDLE > 12.0, 1, 3)),
        "bare": _meshio(tmp_path / "c.vtu"),
    }
    given = {key: str(paths["plain"]) if value == "plain" else value for key, value in overrides.items()}
    with pytest.raises(kind, match=words):
        build_mesh(config(paths[name], **given))


BROKEN: dict[str, tuple[Any, str]] = {
    "flat": (
        lambda p, c: (np.where(np.arange(len(p))[:, None] == c[0, 0], p[c[0, 1]], p), c),
        "without volume",
    ),
    "repeated": (lambda p, c: (p, np.concatenate([c, c[:1]])), "more than two tetrahedra"),
    "infinite": (lambda p, c: (np.where(np.arange(len(p))[:, None] == 5, np.inf, p), c), "not finite"),
    "pinched": (
        lambda p, c: (
            np.concatenate([p, 2.0 * p[[0]] - p]),
            np.concatenate([c, np.where(c == 0, 0, c + len(p))]),
        ),
        "touches itself at 1 points",
    ),
    "crossing": (
        lambda p, c: (np.where(p[:, :1] > 14.0, p * np.array([-1.3, 1.0, 1.0]), p), c),
        "crosses itself",
    ),
}


def test_a_body_without_white_matter_is_refused(tmp_path: Path) -> None:
    path = plain(tmp_path / "a.mesh", POINTS[CELLS[0]] * 3.0, np.arange(4)[None])
    with pytest.raises(MeshError, match=r"No tetrahedron of the volume is white matter: .* edges are"):
        build_mesh(config(path, **{"geometry.cortical_thickness": 0.2}))


@pytest.mark.parametrize("fault", BROKEN)
def test_broken_bodies_are_refused_with_a_place(fault: str, tmp_path: Path) -> None:
    change, words = BROKEN[fault]
    path = plain(tmp_path / "a.mesh", *change(POINTS, CELLS))
    with pytest.raises(MeshError, match=words):
        build_mesh(config(path, **{"dissipation.number": 0.2}))


@pytest.mark.parametrize("name", ["a.mesh", "b.mesh", "a.vtu", "a.msh"])
@pytest.mark.parametrize("share", [0.0, 0.3, 0.6, 0.99])
def test_a_file_that_is_cut_short_is_refused(name: str, share: float, tmp_path: Path) -> None:
    data = FORMATS[name](tmp_path / name).read_bytes()
    with pytest.raises(ConfigError, match=r"damaged|holds no tetrahedra"):
        read_tetrahedra(data[: int(share * len(data))], name)


def test_other_cells_and_formats_are_refused(tmp_path: Path) -> None:
    meshio.Mesh(POINTS, [("hexahedron", CELLS[:4].reshape(2, 8))]).write(tmp_path / "a.vtu")
    with pytest.raises(ConfigError, match="cells of the type hexahedron"):
        read_tetrahedra((tmp_path / "a.vtu").read_bytes(), "a.vtu")
    with pytest.raises(ConfigError, match="unknown format"):
        read_tetrahedra(b"", "a.step")
    data = plain(tmp_path / "a.mesh", POINTS, CELLS).read_bytes()
    with pytest.raises(ConfigError, match="3 numbers follow its end"):
        read_tetrahedra(data + b"0\n1 2 3\n", "a.mesh")


@pytest.mark.parametrize(
    "rest", ["1e300 1 2 3 4", "1 99999999999999999999 2 3 4", "nan 1 2 3 4", "-inf 1 2 3 4"]
)
def test_numbers_out_of_all_bounds_are_refused(rest: str, recwarn: pytest.WarningsRecorder) -> None:
    text = f"4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1\n{rest}\n"
    with pytest.raises(ConfigError, match="damaged"):
        read_tetrahedra(text.encode(), "a.mesh")
    assert not recwarn.list


def test_a_reader_does_not_speak_to_the_terminal(capfd: pytest.CaptureFixture[str]) -> None:
    """The one document of --json stands alone."""
    for data in (b"", b"MeshVersionFormatted 2\nDimension 2\nVertices\n1\n0 0 0\nEnd\n", b"nothing"):
        with pytest.raises(ConfigError):
            read_tetrahedra(data, "a.mesh")
    assert capfd.readouterr() == ("", "")


def test_points_that_coincide_are_joined_and_turned_cells_accepted(tmp_path: Path) -> None:
    apart = POINTS[CELLS].reshape(-1, 3)
    cells = np.arange(len(apart)).reshape(-1, 4)
    cells[::3] = cells[::3][:, [1, 0, 2, 3]]
    mesh = build_mesh(config(plain(tmp_path / "a.mesh", apart, cells)))
    assert mesh.n_points == len(POINTS)
    assert signed_volumes(mesh.cell_points).min() > 0.0
    assert any("joined" in text for text in config_warnings(config(tmp_path / "a.mesh")))
