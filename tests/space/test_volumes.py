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
from gyrify.mesh import GREY, WHITE
from gyrify.metrics.tetrahedra import faces_of_one_cell, signed_volumes
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
    boundary = faces_of_one_cell(mesh.cells)
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
    assert faces_of_one_cell(fine.cells).shape[0] == fine.faces.shape[0]


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
