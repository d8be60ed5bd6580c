"""A run in the formats of other programs: VTU, XDMF, CSV, STL."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final, Literal, get_args
from xml.etree import ElementTree

import h5py
import numpy as np

from gyrify.config.run_sections import OutputField
from gyrify.errors import ConfigError, HistoryError
from gyrify.extras import require
from gyrify.solve.types import FloatArray
from gyrify.store.faults import storage_faults
from gyrify.store.fields import POINT_FIELDS, fields
from gyrify.store.files import fresh
from gyrify.store.history import History
from gyrify.store.vtkhdf import written_states

Format = Literal["vtu", "xdmf", "csv", "stl"]

CSV_COLUMNS: Final = ("increment", "growth_time", "point", "contour", "X_mm", "Y_mm", "ux_mm", "uy_mm")
_XDMF_KINDS: Final = {1: "Scalar", 3: "Vector", 9: "Tensor"}


def export(
    history: History,
    format: Format,
    path: str | Path,
    index: int | None = -1,
    *,
    names: Sequence[OutputField] | None = None,
) -> list[Path]:
    """Write states of a run for another program.

    Parameters
    ----------
    history : History
        The run.
    format : {"vtu", "xdmf", "csv", "stl"}
        ``vtu`` and ``xdmf``: reference mesh with the fields, ``displacement`` among them; several states make
        a time series (XDMF: one file and its HDF5 data; VTU: a file each and a ``.pvd`` that lists them).
        ``csv``: a row per point with its displacement and its place on the contour. ``stl``: the deformed
        slice as a flat sheet of triangles, a file per state.
    path : path
        File to write.
    index : int or None
        State, negative indices count from the end; None for every state that ``output.every`` asks for.
    names : sequence of str, optional
        Fields; those of ``output.fields`` by default. CSV and STL have no use for them.

    Returns
    -------
    list of Path
        The files written, the one to open first.

    Raises
    ------
    ConfigError
        If the format is unknown, or the library that writes it is not installed.
    HistoryError
        If there is no such state, or a file cannot be written.
    """
    if format not in get_args(Format):
        raise ConfigError(
            f"format = {format!r} is not an export format.", f"Choose one of {', '.join(get_args(Format))}."
        )
    chosen = tuple(history.config.output.fields if names is None else names)
    states = stored_states(history, index)
    target = Path(path)
    with storage_faults(target.parent, str(target)):
        target.parent.mkdir(parents=True, exist_ok=True)
        if format == "csv":
            return _write_csv(history, target, states)
        if format == "stl":
            return _write_stl(history, target, states)
        return (_write_xdmf if format == "xdmf" else _write_vtu)(history, target, states, chosen)


def stored_states(history: History, index: int | None) -> list[int]:
    """Numbers of the states to write: one, or every one that ``output.every`` asks for."""
    if index is None:
        return written_states(len(history), history.config.output.every)
    number = index + len(history) if index < 0 else index
    if not 0 <= number < len(history):
        raise HistoryError(
            f"There is no state {index}.", f"This history holds states 0 to {len(history) - 1}."
        )
    return [number]


def _write_csv(history: History, path: Path, states: list[int]) -> list[Path]:
    """Rows of all points of all states; the column ``contour`` counts along the contour, empty elsewhere."""
    mesh, times = history.mesh, history.growth_times
    place = [""] * mesh.n_points
    for order, point in enumerate(mesh.contour.tolist()):
        place[point] = str(order)
    with fresh(path).open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(CSV_COLUMNS)
        for number in states:
            time, values = float(times[number]), np.hstack([mesh.points, history.displacement(number)])
            writer.writerows(
                (number, time, point, place[point], *row) for point, row in enumerate(values.tolist())
            )
    return [path]


def _write_stl(history: History, path: Path, states: list[int]) -> list[Path]:
    meshio = _meshio("stl")
    files = _numbered(path, states)
    for file, number in zip(files, states, strict=True):
        sheet = meshio.Mesh(_padded(history.points(number)), [("triangle", history.mesh.triangles)])
        meshio.write(fresh(file), sheet, file_format="stl", binary=True)
    return files


def _write_vtu(history: History, path: Path, states: list[int], names: tuple[OutputField, ...]) -> list[Path]:
    meshio = _meshio("vtu")
    files = _numbered(path, states)
    for file, number in zip(files, states, strict=True):
        point_data, cell_data = _data(history, number, names)
        grid = meshio.Mesh(_padded(history.mesh.points), _cells(history), point_data, cell_data)
        meshio.write(fresh(file), grid, file_format="vtu")
    if len(files) == 1:
        return files
    times = history.growth_times[states]
    entries = "".join(
        f'    <DataSet timestep="{float(time)!r}" file="{file.name}"/>\n'
        for time, file in zip(times, files, strict=True)
    )
    series = path.with_suffix(".pvd")
    collection = f"  <Collection>\n{entries}  </Collection>\n"
    fresh(series).write_text(
        f'<VTKFile type="Collection" version="0.1">\n{collection}</VTKFile>\n', encoding="utf-8"
    )
    return [series, *files]


def _write_xdmf(
    history: History, path: Path, states: list[int], names: tuple[OutputField, ...]
) -> list[Path]:
    """Temporal collection of grids that share the mesh; all numbers are in the HDF5 file beside it."""
    heavy = path.with_suffix(".h5")
    grids = ElementTree.Element("Grid", Name="run", GridType="Collection", CollectionType="Temporal")
    with h5py.File(fresh(heavy), "w", locking=False) as file:
        file["points"], file["cells"] = _padded(history.mesh.points), history.mesh.cells
        for number in states:
            grid = ElementTree.SubElement(grids, "Grid", Name=f"increment {number}", GridType="Uniform")
            ElementTree.SubElement(grid, "Time", Value=repr(float(history.growth_times[number])))
            n_cells = str(history.mesh.n_cells)
            kind_of_cell = "Triangle" if history.mesh.cells.shape[1] == 3 else "Triangle_6"
            topology = ElementTree.SubElement(
                grid, "Topology", TopologyType=kind_of_cell, NumberOfElements=n_cells
            )
            _refer(topology, file["cells"])
            _refer(ElementTree.SubElement(grid, "Geometry", GeometryType="XYZ"), file["points"])
            point_data, cell_data = _data(history, number, names)
            for centre, data in (("Node", point_data), ("Cell", {k: v[0] for k, v in cell_data.items()})):
                for name, values in data.items():
                    place, kind = f"{number}/{name}", _XDMF_KINDS[values.shape[1] if values.ndim == 2 else 1]
                    file.create_dataset(place, data=values, compression=1, shuffle=True)
                    attribute = ElementTree.SubElement(
                        grid, "Attribute", Name=name, Center=centre, AttributeType=kind
                    )
                    _refer(attribute, file[place])
    root = ElementTree.Element("Xdmf", Version="3.0")
    ElementTree.SubElement(root, "Domain").append(grids)
    ElementTree.indent(root)
    ElementTree.ElementTree(root).write(fresh(path), encoding="utf-8", xml_declaration=True)
    return [path, heavy]


def _refer(parent: ElementTree.Element, dataset: h5py.Dataset) -> None:
    """Point at a dataset in the HDF5 file."""
    number_type = "Int" if dataset.dtype.kind == "i" else "Float"
    item = ElementTree.SubElement(
        parent,
        "DataItem",
        Dimensions=" ".join(map(str, dataset.shape)),
        NumberType=number_type,
        Precision=str(dataset.dtype.itemsize),
        Format="HDF",
    )
    item.text = f"{Path(dataset.file.filename).name}:{dataset.name}"


def _data(
    history: History, number: int, names: tuple[OutputField, ...]
) -> tuple[dict[str, FloatArray], dict[str, list[FloatArray]]]:
    """Point and cell data of a state: vectors with three entries, tensors with nine (row by row)."""
    point_data: dict[str, FloatArray] = {}
    cell_data: dict[str, list[FloatArray]] = {}
    for name, values in fields(history, number, names).items():
        if name in POINT_FIELDS:
            point_data[name] = _padded(values) if values.ndim == 2 else values
        else:
            cell_data[name] = [values.reshape(-1, 9) if values.ndim == 3 else values]
    return point_data, cell_data


def _cells(history: History) -> list[tuple[str, Any]]:
    return [("triangle" if history.mesh.cells.shape[1] == 3 else "triangle6", history.mesh.cells)]


def _padded(vectors: FloatArray) -> FloatArray:
    """(n, 3) vectors with a zero third component."""
    return np.pad(vectors, ((0, 0), (0, 1)))


def _numbered(path: Path, states: list[int]) -> list[Path]:
    """The path itself for one state; ``stem_0000.ext``, numbered by increment, for several."""
    if len(states) == 1:
        return [path]
    return [path.with_name(f"{path.stem}_{number:04d}{path.suffix}") for number in states]


def _meshio(format: str) -> Any:
    return require("meshio", "export", f"An export as {format}")
