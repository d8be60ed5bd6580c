"""Exported files, read back."""

from __future__ import annotations

import csv
import sys
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from gyrify.config import Config
from gyrify.errors import ConfigError, HistoryError
from gyrify.mesh import Mesh
from gyrify.run.simulation import simulate
from gyrify.store import History
from gyrify.store.export import csv_columns, export
from gyrify.store.external import cell_type, padded
from gyrify.store.fields import fields

needs_meshio = pytest.mark.skipif(
    not __import__("importlib.util").util.find_spec("meshio"), reason="meshio is not installed"
)


def assert_same_fields(found_point: dict, found_cell: dict, history: History, number: int) -> None:
    for name, values in fields(history, number).items():
        if name in found_point:
            expected = np.pad(values, ((0, 0), (0, 1))) if values.ndim == 2 else values
            np.testing.assert_array_equal(found_point[name], expected, err_msg=name)
        else:
            np.testing.assert_array_equal(found_cell[name][0], values.reshape(len(values), -1).squeeze())


@needs_meshio
@pytest.mark.parametrize(("n_dim", "n_nodes"), [(2, 3), (2, 6), (3, 4), (3, 10)])
def test_other_programs_know_the_cells_by_their_names(n_dim: int, n_nodes: int):
    import meshio
    from meshio._vtk_common import vtk_to_meshio_type
    from meshio.xdmf.common import xdmf_to_meshio_type

    points = np.zeros((n_nodes, n_dim))
    found = cell_type(mesh_of(points, np.arange(n_nodes)[None]))
    assert vtk_to_meshio_type[found.vtk] == xdmf_to_meshio_type[found.xdmf] == found.meshio
    assert meshio._mesh.topological_dimension[found.meshio] == n_dim
    assert meshio._mesh.num_nodes_per_cell[found.meshio] == n_nodes
    assert padded(points).shape == (n_nodes, 3)


def mesh_of(points: np.ndarray, cells: np.ndarray) -> Mesh:
    none, n = np.empty(0, dtype=np.int64), len(cells)
    across = np.zeros((n, points.shape[1]))
    return Mesh(
        points, cells, np.ones(n, dtype=np.int8), none, none, none, across, np.zeros(n, dtype=np.int64)
    )


def test_tables_have_a_column_for_each_axis():
    assert csv_columns(3)[4:] == ("X_mm", "Y_mm", "Z_mm", "ux_mm", "uy_mm", "uz_mm")
    assert csv_columns(2)[4:] == ("X_mm", "Y_mm", "ux_mm", "uy_mm")


@needs_meshio
def test_vtu_of_the_last_state(folded: History, tmp_path: Path):
    import meshio

    (path,) = export(folded, "vtu", tmp_path / "new" / "last.vtu")
    mesh = meshio.read(path)
    assert np.array_equal(mesh.points[:, :2], folded.mesh.points)
    assert np.array_equal(mesh.cells_dict["triangle"], folded.mesh.cells)
    assert_same_fields(mesh.point_data, mesh.cell_data, folded, len(folded) - 1)


@needs_meshio
def test_vtu_of_all_states_is_a_collection(folded: History, tmp_path: Path):
    import meshio

    series, *files = export(folded, "vtu", tmp_path / "run.vtu", None, names=["displacement"])
    entries = list(ElementTree.parse(series).iter("DataSet"))
    assert [float(entry.get("timestep", "")) for entry in entries] == folded.growth_times.tolist()
    assert [entry.get("file") for entry in entries] == [file.name for file in files]
    assert files[3].name == "run_0003.vtu"
    found = meshio.read(files[3]).point_data["displacement"]
    assert np.array_equal(found[:, :2], folded.displacement(3))


@needs_meshio
def test_xdmf_of_all_states_is_read_by_meshio(folded: History, tmp_path: Path, monkeypatch):
    import meshio

    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    path, heavy = export(folded, "xdmf", tmp_path / "run.xdmf", None)
    assert heavy == tmp_path / "run.h5"
    assert not list(elsewhere.iterdir())
    with meshio.xdmf.TimeSeriesReader(path) as reader:
        points, cells = reader.read_points_cells()
        assert np.array_equal(points[:, :2], folded.mesh.points)
        assert np.array_equal(cells[0].data, folded.mesh.cells)
        assert reader.num_steps == len(folded)
        for number in (0, len(folded) - 1):
            time, point_data, cell_data = reader.read_data(number)
            assert time == folded.growth_times[number]
            assert_same_fields(point_data, cell_data, folded, number)


def test_xdmf_is_read_by_vtk(folded: History, tmp_path: Path):
    reader_of = pytest.importorskip("vtkmodules.vtkIOXdmf2", reason="vtk is not installed").vtkXdmfReader
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

    path, _ = export(folded, "xdmf", tmp_path / "run.xdmf", None, names=["displacement", "J"])
    reader = reader_of()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    times = reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    assert np.array_equal(times, folded.growth_times)
    reader.UpdateTimeStep(times[-1])
    grid = reader.GetOutputDataObject(0)
    u = vtk_to_numpy(grid.GetPointData().GetArray("displacement"))
    assert np.allclose(u[:, :2], folded.displacement(), rtol=1e-6)
    assert np.allclose(vtk_to_numpy(grid.GetCellData().GetArray("J")), fields(folded)["J"], rtol=1e-6)


def test_csv_needs_no_library_and_gives_every_digit(folded: History, tmp_path: Path, monkeypatch):
    monkeypatch.setitem(sys.modules, "meshio", None)
    (path,) = export(folded, "csv", tmp_path / "last.csv")
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert ",".join(rows[0]) == "increment,growth_time,point,contour,X_mm,Y_mm,ux_mm,uy_mm"
    assert {row["increment"] for row in rows} == {str(len(folded) - 1)}
    u = np.array([[float(row["ux_mm"]), float(row["uy_mm"])] for row in rows])
    assert np.array_equal(u, folded.displacement())
    on = sorted((int(row["contour"]), int(row["point"])) for row in rows if row["contour"])
    assert [point for _, point in on] == folded.mesh.contour.tolist()


def test_csv_of_all_states(folded: History, tmp_path: Path):
    (path,) = export(folded, "csv", tmp_path / "all.csv", None)
    table = np.genfromtxt(path, delimiter=",", skip_header=1)
    assert table.shape == (len(folded) * folded.mesh.n_points, 8)
    assert np.array_equal(np.unique(table[:, 1]), folded.growth_times)


def test_a_missing_library_is_named_with_the_command_that_installs_it(folded, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "meshio", None)
    for format in ("vtu",):
        with pytest.raises(ConfigError, match=r"pip install meshio .*\[export\]"):
            export(folded, format, tmp_path / "x")


def test_unknown_format_and_state_are_refused(folded: History, tmp_path: Path):
    with pytest.raises(ConfigError, match="vtu, xdmf, csv, stl"):
        export(folded, "obj", tmp_path / "x.obj")  # type: ignore[arg-type]
    with pytest.raises(HistoryError, match="There is no state 999"):
        export(folded, "csv", tmp_path / "x.csv", 999)


def test_a_path_that_cannot_be_written_is_named(folded: History, tmp_path: Path):
    (tmp_path / "file").write_text("")
    with pytest.raises(HistoryError, match="file"):
        export(folded, "csv", tmp_path / "file" / "x.csv")


def test_quadratic_cells_keep_their_six_nodes(tiny: Config, tmp_path: Path):
    history = simulate(
        tiny.with_overrides({"mesh.element": "quadratic", "solver.increments": 2, "growth.duration": 50.0})
    )
    path, _ = export(history, "xdmf", tmp_path / "run.xdmf")
    topology = next(ElementTree.parse(path).iter("Topology"))
    assert topology.get("TopologyType") == "Triangle_6"
    assert next(topology.iter("DataItem")).get("Dimensions") == f"{history.mesh.n_cells} 6"
