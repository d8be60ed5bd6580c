"""A whole brain folds: stored, resumed to the same bytes, verified, measured, exported, drawn."""

from __future__ import annotations

import json
from pathlib import Path

import h5py
import meshio
import numpy as np
import pytest
from solids import BALL, BRAIN, PATCH, config

from gyrify.errors import ConfigError, SolveError
from gyrify.report.outputs import write_outputs
from gyrify.run.simulation import resume, simulate
from gyrify.store import History
from gyrify.store.export import export
from gyrify.store.fields import fields
from gyrify.verify.recheck import verify


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("space") / "brain"
    history = simulate(config(BRAIN), folder)
    write_outputs(history, folder)
    history.journal.close()
    return folder


@pytest.fixture
def brain(folder: Path) -> History:
    return History.load(folder)


def test_it_folds_without_a_crossing(folder: Path) -> None:
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["status"] == "completed"
    assert summary["gi"]["area"]["hull"] > 1.1
    # sulci are wide beside the ball of 5.7 mm
    assert 1.01 < summary["gi"]["area"]["closing"] < summary["gi"]["area"]["hull"]
    assert summary["gi"]["sections"] > 1.01
    assert summary["sulcal_depth_mm"]["max"] > 1.0
    assert summary["n_gyri"] >= 1
    assert summary["min_gap_mm"] > 0.0
    assert summary["self_intersecting"] is False
    assert summary["min_J"] > 0.0
    assert summary["surface_area_mm2"] > 1.3 * 4.0 * np.pi * 20.5**2
    assert summary["wavelength_mm"] > 5.0
    assert summary["solver"]["contact_library"] == "ipctk"
    assert summary["units"]["solver_residual"] == "Pa mm²"


def test_verify_finds_nothing(folder: Path) -> None:
    found = verify(folder)
    assert [check.sentence for check in found.checks if not check.passed] == []
    told = {check.name: check.sentence for check in found.checks}
    assert "Pa mm³" in told["energy balance"]
    assert "[Pa mm²]" in told["residual"]
    assert {check.name for check in found.checks} >= {"energy balance", "simple contour", "gap", "volume"}
    assert "path" not in told  # folds slide along each other


def test_every_state_is_free_of_crossings(brain: History) -> None:
    from gyrify.run.body_measures import surface_of

    for index in range(len(brain)):
        surface = surface_of(brain.mesh, brain.points(index), brain.config.metrics)
        assert not surface.crosses_itself


def test_an_interrupted_run_ends_with_the_same_bytes(folder: Path, tmp_path: Path) -> None:
    class Enough(Exception):
        pass

    def stop(progress) -> None:
        if progress.state.index == 9:
            raise Enough

    with pytest.raises(Enough):
        simulate(config(BRAIN), tmp_path / "cut", observers=[stop])
    assert len(History.load(tmp_path / "cut")) == 10
    again = resume(tmp_path / "cut")
    assert again.result_hash == History.load(folder).result_hash


def test_fields_are_those_of_the_deformation(brain: History) -> None:
    found = fields(brain)
    mesh, problem = brain.mesh, brain.slice
    assert found["J"] == pytest.approx(problem.volume_ratio(brain.state_vector(-1)))
    assert found["J_elastic"] * found["J_growth"] == pytest.approx(found["J"])
    stress = found["cauchy_stress"]
    assert stress == pytest.approx(np.swapaxes(stress, 1, 2))
    assert found["mean_stress"] == pytest.approx(np.trace(stress, axis1=1, axis2=2) / 3.0)
    values = np.linalg.eigvalsh(stress)
    mises = np.sqrt(0.5 * sum((values[:, i] - values[:, j]) ** 2 for i, j in ((0, 1), (1, 2), (2, 0))))
    assert found["von_mises"] == pytest.approx(mises)
    on_surface = np.zeros(mesh.n_points, dtype=bool)
    on_surface[mesh.contour] = True
    for name in ("thickness", "curvature"):
        assert np.isfinite(found[name][on_surface]).all()
        assert np.isnan(found[name][~on_surface]).all()
    assert found["circumferential_stress"][mesh.region == 1].mean() < 0.0
    assert found["contact_force"].sum(axis=0) == pytest.approx(
        0.0, abs=1e-6 * np.abs(found["contact_force"]).max()
    )


def test_stress_is_the_energys() -> None:
    """Nodal forces by the Cauchy stress, sum of J s F^-T grad N V, are those of the elastic energy."""
    problem = simulate(config(BALL, **{"solver.increments": 2, "mesh.edge_length": 14.0})).slice
    rng = np.random.default_rng(0)
    u = 0.3 * rng.standard_normal(problem.state_shape)
    from gyrify.store.fields import FieldMaker

    state = FieldMaker(problem).state(u, 0.5, u)
    F, simplices = state._F, problem.simplices
    weight = simplices.volumes * state._J
    pulled = np.einsum("cij,cjk->cik", state["cauchy_stress"], np.swapaxes(np.linalg.inv(F), 1, 2))
    forces = np.zeros_like(u)
    np.add.at(forces, simplices.cells, np.einsum("c,cij,caj->cai", weight, pulled, simplices.gradients))
    term = problem.tissue_energy(0.5, u).terms[0]
    assert forces == pytest.approx(term.evaluate(u, 1).gradient, rel=1e-9, abs=1e-9 * np.abs(forces).max())


def test_other_programs_open_what_is_exported(brain: History, tmp_path: Path) -> None:
    (grid,) = export(brain, "vtu", tmp_path / "brain.vtu")
    read = meshio.read(grid)
    assert read.cells[0].type == "tetra"
    assert read.points + read.point_data["displacement"] == pytest.approx(brain.points())
    (solid,) = export(brain, "stl", tmp_path / "brain.stl")
    surface = meshio.read(solid)
    corners = surface.points[surface.cells[0].data]
    volume = np.einsum("ni,ni->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
    inside = np.linalg.det(brain.points()[brain.mesh.cells][:, 1:] - brain.points()[brain.mesh.cells][:, :1])
    assert volume == pytest.approx(inside.sum() / 6.0, rel=1e-5)
    with pytest.raises(ConfigError, match="has a surface, no contour"):
        export(brain, "contour", tmp_path / "x.csv")


def test_ply_is_the_closed_surface_with_the_fields_of_its_points(brain: History, tmp_path: Path) -> None:
    (file,) = export(brain, "ply", tmp_path / "brain.ply", names=["thickness", "contact_force", "J"])
    head = file.read_bytes().split(b"end_header")[0].decode()
    assert "format binary_little_endian" in head
    assert "thickness [mm], contact_force [Pa mm^2]" in head
    read, mesh = meshio.read(file), brain.mesh
    triangles = read.cells[0].data
    assert len(triangles) == len(mesh.faces)
    edges = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    # closed and oriented: every edge is run through once in each direction
    assert len(np.unique(edges, axis=0)) == len(edges)
    assert {tuple(edge) for edge in edges} == {tuple(edge[::-1]) for edge in edges}
    corners = read.points[triangles]
    volume = np.einsum("ni,ni->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
    inside = np.linalg.det(brain.points()[mesh.cells][:, 1:] - brain.points()[mesh.cells][:, :1])
    assert volume == pytest.approx(inside.sum() / 6.0, rel=1e-5)
    stored = fields(brain, -1, ["thickness", "contact_force"])
    assert read.points == pytest.approx(brain.points()[mesh.contour], rel=1e-6)
    assert read.point_data["thickness"] == pytest.approx(stored["thickness"][mesh.contour], rel=1e-6)
    force = np.stack([read.point_data[f"contact_force_{axis}"] for axis in "xyz"], axis=1)
    exact = stored["contact_force"][mesh.contour]
    assert force == pytest.approx(exact, rel=1e-6, abs=1e-6 * np.abs(exact).max())
    assert set(read.point_data) == {"thickness", *(f"contact_force_{axis}" for axis in "xyz")}


def test_vtk_reads_the_series(folder: Path, brain: History) -> None:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader

    reader = vtkHDFReader()
    reader.SetFileName(str(folder / "history.vtkhdf"))
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == len(brain)
    reader.SetStep(len(brain) - 1)
    reader.Update()
    grid = reader.GetOutput()
    assert grid.GetCellType(0) == 10
    moved = vtk_to_numpy(grid.GetPointData().GetArray("displacement"))
    assert moved == pytest.approx(brain.state_vector(-1), abs=1e-4)
    stress = vtk_to_numpy(grid.GetCellData().GetArray("cauchy_stress"))
    with h5py.File(folder / "history.vtkhdf") as file:
        assert file["VTKHDF/PointData/contact_force"].attrs["unit"] == "Pa mm²"
    exact = fields(brain, -1, ["cauchy_stress"])["cauchy_stress"]
    assert stress[:, 4] == pytest.approx(exact[:, 1, 2], abs=2e-4 * np.abs(exact).max())


def test_picture_shows_three_views_and_a_section(brain: History, folder: Path) -> None:
    from PIL import Image

    from gyrify.report.outputs import folded_picture
    from gyrify.run.summary import summarise

    figure = folded_picture(brain, summarise(brain))
    words = [text.get_text() for text in figure.texts]
    assert {"from the side", "from above", "from the front"} <= set(words)
    assert any(word.startswith("section at x = ") for word in words)
    assert any(word.endswith(" mm") for word in words)
    panels = [axes for axes in figure.axes if axes.collections]
    assert len(panels) == 4
    width, height = figure.get_size_inches()
    scales = [axes.get_position().width * width / np.ptp(axes.get_xlim()) for axes in panels]
    assert scales == pytest.approx([scales[0]] * 4)
    heights = [axes.get_position().height * height / np.ptp(axes.get_ylim()) for axes in panels]
    assert heights == pytest.approx(scales)
    with Image.open(folder / "folded.png") as picture:
        assert min(picture.size) > 800


def test_a_patch_and_a_hollow_ball_run_and_verify(tmp_path: Path) -> None:
    for name, base in (("patch", PATCH), ("ball", {**BALL, "geometry.hole_fraction": 0.5})):
        history = simulate(config(base, **{"solver.increments": 4}), tmp_path / name)
        write_outputs(history, tmp_path / name)
        history.journal.close()
        found = verify(tmp_path / name)
        assert [check.sentence for check in found.checks if not check.passed] == [], name


def test_notebook_shows_a_body_in_space(brain: History) -> None:
    assert "GI by area" in brain._repr_html_()
    grid = brain.to_pyvista()
    assert grid.n_cells == brain.mesh.n_cells
    assert set(grid.celltypes) == {10}
    table = brain.to_dataframe()
    assert table["gi_area_hull"].iloc[-1] > table["gi_area_hull"].iloc[0]


def test_a_failed_increment_tells_its_force_in_the_unit_of_space() -> None:
    one_step = {"solver.max_newton": 1, "solver.increments": 1, "solver.min_increment": 1.0}
    with pytest.raises(SolveError, match=r"residual \S+ Pa mm², wanted"):
        simulate(config(BALL, **{"mesh.edge_length": 14.0, **one_step}))
