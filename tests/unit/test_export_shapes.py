"""Exports as shapes: each state where it is now, once; solids to print; the contour as a table."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import shapely

from gyrify.cli import main
from gyrify.config import Config
from gyrify.errors import ConfigError, HistoryError
from gyrify.metrics.sulci import sulcal_depth
from gyrify.report.notebook import DONE
from gyrify.run.simulation import simulate
from gyrify.run.summary import measure_state
from gyrify.store import History
from gyrify.store.contour_table import COLUMNS, contour_rows
from gyrify.store.export import export
from gyrify.store.fields import fields
from gyrify.store.vtkhdf import write_vtkhdf

KINDS: dict[str, dict[str, object]] = {
    "ring": {},
    "quadratic": {"mesh.element": "quadratic", "mesh.n_around": 36, "mesh.inversion_resistance": 0.1},
    "strip": {"geometry.shape": "strip", "mesh.n_around": 36},
}
KINDS["quadratic strip"] = {**KINDS["quadratic"], "geometry.shape": "strip", "mesh.n_around": 24}


@pytest.fixture(scope="module", params=KINDS)
def run(request: pytest.FixtureRequest, tiny: Config) -> History:
    return simulate(tiny.with_overrides(KINDS[request.param]))


# --- where the points are ------------------------------------------------------------------------


def vtu(history: History, index: int, folder: Path) -> tuple[np.ndarray, np.ndarray | None]:
    meshio = pytest.importorskip("meshio")
    mesh = meshio.read(export(history, "vtu", folder / "a.vtu", index)[0])
    return mesh.points, mesh.point_data.get("displacement")


def xdmf(history: History, index: int, folder: Path) -> tuple[np.ndarray, np.ndarray | None]:
    meshio = pytest.importorskip("meshio")
    mesh = meshio.read(export(history, "xdmf", folder / "a.xdmf", index)[0])
    return mesh.points, mesh.point_data.get("displacement")


def xdmf_series(history: History, index: int, folder: Path) -> tuple[np.ndarray, np.ndarray | None]:
    meshio = pytest.importorskip("meshio")
    path, _ = export(history, "xdmf", folder / "a.xdmf", None)
    with meshio.xdmf.TimeSeriesReader(path) as reader:
        points, _ = reader.read_points_cells()
        return points, reader.read_data(index)[1].get("displacement")


def vtkhdf(history: History, index: int, folder: Path) -> tuple[np.ndarray, np.ndarray | None]:
    """As docs/paraview.md has it, by public names of VTK and PyVista."""
    pyvista = pytest.importorskip("pyvista")
    from vtkmodules.vtkIOHDF import vtkHDFReader

    write_vtkhdf(history, folder / "history.vtkhdf", fields=["displacement"], every=1)
    reader = vtkHDFReader()
    reader.SetFileName(str(folder / "history.vtkhdf"))
    reader.SetStep(index)
    reader.Update()
    grid = pyvista.wrap(reader.GetOutput())
    return np.asarray(grid.points), np.asarray(grid.point_data["displacement"])


def pvd(history: History, index: int, folder: Path) -> tuple[np.ndarray, np.ndarray | None]:
    pyvista = pytest.importorskip("pyvista")
    reader = pyvista.get_reader(str(export(history, "vtu", folder / "a.vtu", None)[0]))
    assert reader.time_values == history.growth_times.tolist()
    reader.set_active_time_value(reader.time_values[index])
    grid = reader.read()[0]
    return np.asarray(grid.points), np.asarray(grid.point_data["displacement"])


def pyvista_current(history: History, index: int, _: Path) -> tuple[np.ndarray, np.ndarray | None]:
    pytest.importorskip("pyvista")
    grid = history.to_pyvista(index)
    assert DONE in grid.point_data
    return np.asarray(grid.points), grid.point_data.get("displacement")


def pyvista_reference(history: History, index: int, _: Path) -> tuple[np.ndarray, np.ndarray | None]:
    pytest.importorskip("pyvista")
    grid = history.to_pyvista(index, deformed=False)
    np.testing.assert_allclose(
        np.asarray(grid.warp_by_vector("displacement").points)[:, :2], history.points(index)
    )
    return np.asarray(grid.points), np.asarray(grid.point_data["displacement"])


def csv_points(history: History, index: int, folder: Path) -> tuple[np.ndarray, np.ndarray | None]:
    table = np.genfromtxt(export(history, "csv", folder / "a.csv", index)[0], delimiter=",", names=True)
    return np.column_stack([table["X_mm"], table["Y_mm"]]), np.column_stack([table["ux_mm"], table["uy_mm"]])


PLACES = (vtu, xdmf, xdmf_series, vtkhdf, pvd, pyvista_current, pyvista_reference, csv_points)


@pytest.mark.parametrize("read", PLACES, ids=lambda read: read.__name__)
def test_points_and_displacement_make_the_current_state_once(
    run: History, read: Callable[..., tuple[np.ndarray, np.ndarray | None]], tmp_path: Path
) -> None:
    for index in (3, len(run) - 1):
        points, displacement = read(run, index, tmp_path)
        now = points if displacement is None else points + displacement
        np.testing.assert_allclose(np.asarray(now)[:, :2], run.points(index), atol=1e-5)


# --- solids --------------------------------------------------------------------------------------


def corners_of(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Corners and normals of a binary STL file, by its layout alone."""
    data = path.read_bytes()
    count = int(np.frombuffer(data, "<u4", 1, 80)[0])
    assert len(data) == 84 + 50 * count
    assert not data.startswith(b"solid")  # that would be a file of text
    kind = [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]
    records = np.frombuffer(data, kind, count, 84)
    return records["corners"].astype(np.float64), records["normal"].astype(np.float64)


def area_of(history: History, index: int) -> float:
    """Current area of the tissue [mm²], from its boundary alone."""
    x = history.points(index)

    def enclosed(line: np.ndarray) -> float:
        after = np.roll(line, -1, axis=0)
        return 0.5 * float(np.abs(np.sum(line[:, 0] * after[:, 1] - line[:, 1] * after[:, 0])))

    mesh = history.mesh
    contour, clamped = x[mesh.contour], x[mesh.clamped]
    if mesh.period is None:
        return enclosed(contour) - enclosed(clamped)
    start, floor = contour[:1] + np.array([mesh.period, 0.0]), np.min(clamped[:, 1])
    outline = np.concatenate([contour, start, [[start[0, 0], floor], [contour[0, 0], floor]]])
    return enclosed(outline)


@pytest.mark.parametrize("thickness", [2.0, 0.5])
def test_stl_is_a_closed_solid_that_looks_outwards(run: History, thickness: float, tmp_path: Path) -> None:
    (path,) = export(run, "stl", tmp_path / "a.stl", -1, thickness=thickness)
    corners, normals = corners_of(path)
    places, numbers = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    triangles = numbers.reshape(-1, 3)
    directed = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    once, counts = np.unique(directed, axis=0, return_counts=True)
    assert (counts == 1).all(), (
        "every edge is run through once in each direction: closed, and of one orientation"
    )
    assert {(a, b) for a, b in once.tolist()} == {(b, a) for a, b in once.tolist()}
    volume = float(np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6.0)
    assert volume == pytest.approx(thickness * area_of(run, -1), rel=1e-5)  # positive: it looks outwards
    made = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.allclose(normals, made / np.linalg.norm(made, axis=1, keepdims=True), atol=1e-3)
    assert np.unique(places[:, 2]).tolist() == [0.0, thickness]


def test_stl_is_sound_for_another_reader(run: History, tmp_path: Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    (path,) = export(run, "stl", tmp_path / "a.stl")
    found = pyvista.read(path)
    assert found.is_manifold
    assert found.n_open_edges == 0
    assert found.volume == pytest.approx(2.0 * area_of(run, -1), rel=1e-5)


def test_stl_needs_no_library_and_makes_a_file_per_state(
    run: History, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "meshio", None)
    files = export(run, "stl", tmp_path / "a.stl", None)
    assert [file.name for file in files] == [f"a_{number:04d}.stl" for number in range(len(run))]
    assert [file.name for file in export(run, "stl", tmp_path / "b.stl", [0, 2])] == [
        "b_0000.stl",
        "b_0002.stl",
    ]


@pytest.mark.parametrize("thickness", [0.0, -1.0, float("nan"), float("inf"), "2", None])
def test_a_thickness_that_is_none_is_refused(run: History, thickness: object, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="thickness"):
        export(run, "stl", tmp_path / "a.stl", thickness=thickness)  # type: ignore[arg-type]
    assert not list(tmp_path.iterdir())


def test_no_state_is_refused(run: History, tmp_path: Path) -> None:
    with pytest.raises(HistoryError, match="No state is chosen"):
        export(run, "csv", tmp_path / "a.csv", slice(99, None))


# --- the contour as a table ----------------------------------------------------------------------


def columns(path: Path) -> dict[str, np.ndarray]:
    """A CSV file by column."""
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert tuple(rows[0]) == COLUMNS
    return {name: np.array([float(row[name]) for row in rows]) for name in COLUMNS}


@pytest.mark.parametrize("index", [3, -1])
def test_the_contour_table_holds_what_is_stored(run: History, index: int, tmp_path: Path) -> None:
    (path,) = export(run, "contour", tmp_path / "contour.csv", index)
    table, mesh, x = columns(path), run.mesh, run.contour(index)
    assert table["point"].tolist() == mesh.contour.tolist()
    assert set(table["growth_time"]) == {run.growth_times[index]}
    np.testing.assert_array_equal(np.column_stack([table["x_mm"], table["y_mm"]]), x)
    np.testing.assert_array_equal(np.column_stack([table["X_mm"], table["Y_mm"]]), mesh.points[mesh.contour])
    steps = np.hypot(*np.diff(x, axis=0).T)
    np.testing.assert_allclose(np.diff(table["arc_length_mm"]), steps)
    last = measure_state(run, index).contour_length - table["arc_length_mm"][-1]
    end = x[0] + ([0.0, 0.0] if mesh.period is None else [mesh.period, 0.0])
    assert last == pytest.approx(float(np.hypot(*(end - x[-1]))))
    stored = fields(run, index, ["curvature", "thickness", "contact_force"])
    for name, column in (("curvature", "curvature_per_mm"), ("thickness", "thickness_mm")):
        np.testing.assert_array_equal(table[column], stored[name][mesh.contour])
    force = np.column_stack([table["contact_force_x_Pa_mm"], table["contact_force_y_Pa_mm"]])
    np.testing.assert_array_equal(force, stored["contact_force"][mesh.contour])


def test_normals_look_outwards(run: History) -> None:
    rows = contour_rows(run, len(run) - 1)
    x, normals = rows[:, 1:3], rows[:, 5:7]
    np.testing.assert_allclose(np.hypot(*normals.T), 1.0)
    if run.mesh.period is None:
        tissue = shapely.Polygon(x)
    else:
        steps = run.mesh.period * np.array([[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0]])
        line = np.concatenate([x + step for step in steps])
        tissue = shapely.Polygon([*line, [line[-1, 0], -99.0], [line[0, 0], -99.0]])
    inside = [shapely.contains_xy(tissue, *(x + side * 1e-3 * normals).T) for side in (-1.0, 1.0)]
    assert inside[0].all()
    assert not inside[1].any()


def test_normals_of_a_circle_are_radial_and_curvature_is_one_over_the_radius(tiny: Config) -> None:
    config = tiny.with_overrides({"geometry.shape": "circle", "growth.ratio": 1.0, "mesh.node_jitter": 0.0})
    run = simulate(config.with_overrides({"solver.increments": 2, "dissipation.kind": "none"}))
    rows = contour_rows(run, 0)
    radius = np.hypot(rows[:, 1], rows[:, 2])
    np.testing.assert_allclose(rows[:, 5:7], rows[:, 1:3] / radius[:, None], atol=1e-12)
    np.testing.assert_allclose(rows[:, 7], 1.0 / radius)
    np.testing.assert_allclose(rows[:, 8], config.geometry.cortical_thickness, rtol=2e-3)
    np.testing.assert_allclose(rows[:, 9], 0.0, atol=1e-9)


def test_depth_of_the_table_is_that_of_the_metrics(folded: History, tiny: Config) -> None:
    rows = contour_rows(folded, len(folded) - 1)
    x, radius = folded.contour(), folded.config.metrics.closing_radius
    np.testing.assert_array_equal(rows[:, 9], sulcal_depth(x, x, radius))
    assert rows[:, 9].max() == pytest.approx(measure_state(folded).sulcal_depth_max, rel=0.02)
    strip = simulate(tiny.with_overrides({**KINDS["strip"], "growth.ratio": 20.0}))
    assert measure_state(strip).n_gyri > 0
    depth = contour_rows(strip, len(strip) - 1)[:, 9]
    assert depth.max() == pytest.approx(measure_state(strip).sulcal_depth_max, rel=0.05)
    assert np.argmax(depth) == np.argmin(strip.contour()[:, 1])


def test_stresses_are_means_over_the_cells_that_meet_in_a_point(folded: History) -> None:
    rows, mesh = contour_rows(folded, len(folded) - 1), folded.mesh
    names = ("von_mises", "mean_stress", "circumferential_stress")
    values = fields(folded, -1, list(names))
    corners = mesh.points[mesh.cells]
    (a, b) = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    areas = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    for place in (0, 7, 100):
        meeting = (mesh.cells == mesh.contour[place]).any(axis=1)
        for column, name in enumerate(names, start=10):
            mean = np.average(values[name][meeting], weights=areas[meeting])
            assert rows[place, column] == pytest.approx(mean)


def test_the_table_of_all_states_from_the_command_line(
    tmp_path: Path, tiny: Config, capsys: pytest.CaptureFixture[str]
) -> None:
    run = simulate(tiny, tmp_path / "run")
    assert main(["export", str(tmp_path / "run"), "--format", "contour", "--every"]) == 0
    assert capsys.readouterr().out.strip() == str(tmp_path / "run" / "contour.csv")
    table = columns(tmp_path / "run" / "contour.csv")
    assert len(table["point"]) == len(run) * run.mesh.contour.size
    out = tmp_path / "print.stl"
    command = ["export", str(tmp_path / "run"), "--format", "stl", "--thickness", "3.5", "--out", str(out)]
    assert main(command) == 0
    assert corners_of(out)[0][..., 2].max() == 3.5
    assert main([*command[:-3], "0", "--out", str(out)]) == 2
    assert "thickness = 0 mm is out of range" in capsys.readouterr().err
