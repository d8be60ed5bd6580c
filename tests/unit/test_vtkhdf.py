"""The derived history, read back with HDF5 and with VTK's own reader."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import pytest

from gyrify.errors import HistoryError
from gyrify.store import History
from gyrify.store import vtkhdf as module
from gyrify.store.fields import fields
from gyrify.store.state_fields import POINT_FIELDS
from gyrify.store.vtkhdf import Layout, write_vtkhdf, written_states

# Relative error of rounding to single precision, then to 16 significant bits.
ROUNDED = 2.0**-16 + 2.0**-24


@pytest.fixture(scope="module")
def written(folded: History, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("vtkhdf") / "history.vtkhdf"
    write_vtkhdf(folded, path)
    return path


def as_vtk(name: str, values: np.ndarray) -> np.ndarray:
    """Our array in VTK's arrangement: vectors of three, symmetric tensors as 11, 22, 33, 12, 23, 13."""
    if name == "cauchy_stress":
        return values[:, [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]
    return np.pad(values, ((0, 0), (0, 1))) if values.ndim == 2 else values


def test_vtk_reads_the_time_series_as_it_is_stored(folded: History, written: Path):
    reader_of = pytest.importorskip("vtkmodules.vtkIOHDF", reason="vtk is not installed").vtkHDFReader
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

    reader = reader_of()
    assert reader.CanReadFile(str(written))
    reader.SetFileName(str(written))
    reader.UpdateInformation()
    times = reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    assert np.array_equal(times, folded.growth_times)
    assert reader.GetNumberOfSteps() == len(folded)
    for number in (0, len(folded) // 2, len(folded) - 1, 1):
        reader.UpdateTimeStep(times[number])
        grid = reader.GetOutputDataObject(0)
        assert grid.GetClassName() == "vtkUnstructuredGrid"
        assert np.array_equal(vtk_to_numpy(grid.GetPoints().GetData())[:, :2], folded.mesh.points)
        assert np.array_equal(vtk_to_numpy(grid.GetCells().GetConnectivityArray()), folded.mesh.cells.ravel())
        assert {grid.GetCellType(cell) for cell in (0, grid.GetNumberOfCells() - 1)} == {5}
        for name, values in fields(folded, number).items():
            data = grid.GetPointData() if name in POINT_FIELDS else grid.GetCellData()
            found, expected = vtk_to_numpy(data.GetArray(name)), as_vtk(name, values)
            assert found.shape == expected.shape, name
            np.testing.assert_allclose(found, expected, rtol=ROUNDED, atol=1e-30, err_msg=name)
        assert np.array_equal(vtk_to_numpy(grid.GetFieldData().GetArray("contour")), folded.mesh.contour)
        assert vtk_to_numpy(grid.GetFieldData().GetArray("increment")).tolist() == [number]


def test_displacement_is_the_nearest_single_precision_number(folded: History, written: Path):
    n = folded.mesh.n_points
    with h5py.File(written) as file:
        stored = file["VTKHDF/PointData/displacement"][-n:]
    assert np.array_equal(stored[:, :2], folded.displacement().astype(np.float32))
    assert not stored[:, 2].any()


def test_geometry_and_region_are_stored_once(folded: History, written: Path):
    with h5py.File(written) as file:
        root = file["VTKHDF"]
        assert root.attrs["Type"] == b"UnstructuredGrid"
        assert root["Steps"].attrs["NSteps"] == len(folded)
        assert root["Points"].shape == (folded.mesh.n_points, 3)
        assert np.array_equal(root["CellData/region"][:], folded.mesh.region)
        assert not root["Steps/CellDataOffsets/region"][:].any()
        starts = root["Steps/CellDataOffsets/J"][:]
        assert np.array_equal(starts, np.arange(len(folded)) * folded.mesh.n_cells)
        assert root["CellData/cauchy_stress"].attrs["unit"] == "Pa"


def test_only_what_the_configuration_asks_for_is_written(folded: History, tmp_path: Path):
    write_vtkhdf(folded, tmp_path / "few.vtkhdf", fields=["displacement", "J"], every=8)
    with h5py.File(tmp_path / "few.vtkhdf") as file:
        root = file["VTKHDF"]
        assert list(root["PointData"]) == ["displacement"]
        assert list(root["CellData"]) == ["J"]
        steps = [*range(0, len(folded), 8)]
        steps += [] if steps[-1] == len(folded) - 1 else [len(folded) - 1]
        assert root["FieldData/increment"][:].tolist() == steps
        assert np.array_equal(root["Steps/Values"], folded.growth_times[steps])
        found = root["CellData/J"][-folded.mesh.n_cells :]
    np.testing.assert_allclose(found, fields(folded)["J"], rtol=ROUNDED)


def test_output_settings_of_the_run_are_the_defaults(folded: History, tmp_path: Path):
    config = folded.config.replace(**{"output.every": 10, "output.fields": ["von_mises"]})
    history = History(folded.journal)
    history.config = config
    write_vtkhdf(history, tmp_path / "own.vtkhdf")
    with h5py.File(tmp_path / "own.vtkhdf") as file:
        assert list(file["VTKHDF/CellData"]) == ["von_mises"]
        assert "PointData" not in file["VTKHDF"]
        assert file["VTKHDF/FieldData/increment"][:].tolist() == written_states(len(folded), 10)


@pytest.mark.parametrize(
    ("n_states", "every", "expected"),
    [(1, 1, [0]), (5, 1, [0, 1, 2, 3, 4]), (5, 2, [0, 2, 4]), (5, 3, [0, 3, 4]), (5, 100, [0, 4])],
)
def test_first_and_last_state_are_always_written(n_states, every, expected):
    assert written_states(n_states, every) == expected


@pytest.mark.parametrize("rounded", [True, False])
def test_numbers_are_stored_in_full_or_to_sixteen_bits(rounded, rng):
    values = 1e3 * rng.standard_normal(7344)
    found = Layout(rounded=rounded).stored(values)
    if rounded:
        np.testing.assert_allclose(found, values, rtol=ROUNDED)
        assert not (found.view("<u4") & 0xFF).any()
    else:
        assert np.array_equal(found, values.astype(np.float32))


def test_rounding_leaves_what_is_not_a_number_and_carries_to_the_next_power_of_two():
    found = Layout().stored(np.array([np.inf, -np.inf, 0.0, np.nextafter(2.0, 0.0), -1.0]))
    assert found.tolist() == [np.inf, -np.inf, 0.0, 2.0, -1.0]


def test_a_failure_leaves_the_file_that_was_there(folded: History, tmp_path: Path, monkeypatch):
    path = tmp_path / "history.vtkhdf"
    path.write_bytes(b"the one before")
    monkeypatch.setattr(module, "_write_fields", _full_disk)
    with pytest.raises(HistoryError, match="No space left"):
        write_vtkhdf(folded, path)
    assert path.read_bytes() == b"the one before"
    assert [file.name for file in tmp_path.iterdir()] == ["history.vtkhdf"]


def _full_disk(*_: object) -> None:
    raise OSError(28, "No space left on device")


def test_size_per_value_leaves_room_for_a_standard_run(folded: History, written: Path):
    # 3888 points, 7344 cells and 101 states: 24 MB at most beside a journal of 6.4 MB
    mesh = folded.mesh
    values = len(folded) * (2 * mesh.n_points + 9 * mesh.n_cells)
    assert written.stat().st_size / values < 24e6 / (101 * (2 * 3888 + 9 * 7344))
