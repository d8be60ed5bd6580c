"""A run in the formats of other programs: VTU, XDMF, CSV, STL, PLY, and its contour as a table."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final, Literal, get_args

import numpy as np

from gyrify.base.arguments import Pathlike, as_path, real_number
from gyrify.base.extras import require
from gyrify.config.run_sections import OutputField
from gyrify.errors import ConfigError, HistoryError
from gyrify.store.contour_table import write_contour
from gyrify.store.disk_faults import storage_faults
from gyrify.store.external import cell_type, numbered, padded, point_and_cell_data
from gyrify.store.fields import known_fields
from gyrify.store.files import fresh
from gyrify.store.history import History
from gyrify.store.ply import write_ply
from gyrify.store.state_numbers import Index, state_numbers
from gyrify.store.stl import THICKNESS, write_stl
from gyrify.store.vtkhdf import written_states
from gyrify.store.xdmf import write_xdmf

Format = Literal["vtu", "xdmf", "csv", "stl", "ply", "contour"]

NAMES: Final[dict[Format, str]] = {
    "vtu": "export.vtu",
    "xdmf": "export.xdmf",
    "csv": "export.csv",
    "stl": "export.stl",
    "ply": "export.ply",
    "contour": "contour.csv",
}


def export(
    history: History,
    format: Format,
    path: Pathlike,
    index: Index | None = -1,
    *,
    names: str | Sequence[OutputField] | None = None,
    thickness: float = THICKNESS,
) -> list[Path]:
    """Write states of a run for another program.

    Parameters
    ----------
    history : History
        The run.
    format : {"vtu", "xdmf", "csv", "stl", "ply", "contour"}
        ``vtu`` and ``xdmf``: reference mesh with the fields, ``displacement`` among them; several states make
        a time series (XDMF: one file and its HDF5 data; VTU: a file each and a ``.pvd`` that lists them).
        ``csv``: a row per point with its displacement and its place on the contour. ``stl``: the deformed
        slice as a closed solid, or the closed surface of a body in space, a file per state. ``ply``: the same
        with the fields of its points. ``contour``: a CSV file with a row per point of the contour of a slice,
        its place, shape, thickness, depth, stresses and contact force, with the units in the header.
    path : path
        File to write.
    index : int, slice, sequence of int or None
        State, negative indices count from the end, or several; None for every state that ``output.every``
        asks for.
    names : sequence of str, optional
        Fields; those of ``output.fields`` by default. Only VTU, XDMF and PLY have use for them.
    thickness : float
        Thickness along z of the solid that STL and PLY make of a slice [mm], > 0.

    Returns
    -------
    list of Path
        The files written, the one to open first.

    Raises
    ------
    ConfigError
        If the format, a field or the thickness is wrong, or the library that writes it is not installed.
    HistoryError
        If there is no such state, or a file cannot be written.
    """
    if not isinstance(format, str) or format not in get_args(Format):
        raise ConfigError(
            f"format = {str(format)[:60]!r} is not an export format.",
            f"Choose one of {', '.join(get_args(Format))}.",
        )
    chosen = tuple(known_fields(history.config.output.fields if names is None else names))
    states, tall = stored_states(history, index), _thickness(thickness)
    target = as_path("path", path)
    with storage_faults(target.parent, str(target)):
        target.parent.mkdir(parents=True, exist_ok=True)
        if format == "csv":
            return _write_csv(history, target, states)
        if format == "contour":
            if history.mesh.n_dim == 3:
                raise ConfigError(
                    "A body in space has a surface, no contour to write as a table.",
                    "Use ply, the surface with its thickness, curvature and contact force, or csv.",
                )
            return write_contour(history, target, states)
        if format == "ply":
            return write_ply(history, target, states, chosen, tall)
        if format == "stl":
            return write_stl(history, target, states, tall)
        return (write_xdmf if format == "xdmf" else _write_vtu)(history, target, states, chosen)


def _thickness(given: object) -> float:
    thickness = real_number("thickness", given)
    if not 0.0 < thickness < math.inf:
        raise ConfigError(
            f"thickness = {thickness:g} mm is out of range: it must be above 0.", "Give it in mm, such as 2."
        )
    return thickness


def stored_states(history: History, index: Index | None) -> list[int]:
    """Numbers of the states to write: those asked for, or every one that ``output.every`` asks for."""
    if index is None:
        return written_states(len(history), history.config.output.every)
    numbers = state_numbers(index, len(history))
    states = [numbers] if isinstance(numbers, int) else numbers
    if not states:
        raise HistoryError("No state is chosen to export.", "Choose one, such as -1, the last one.")
    return states


def csv_columns(n_dim: int) -> tuple[str, ...]:
    """Columns of the table of points in a number of dimensions."""
    reference = [f"{axis}_mm" for axis in "XYZ"[:n_dim]]
    return ("increment", "growth_time", "point", "contour", *reference, *(f"u{x.lower()}" for x in reference))


def _write_csv(history: History, path: Path, states: list[int]) -> list[Path]:
    """Rows of all points of all states; the column ``contour`` counts along the contour, empty elsewhere."""
    mesh, times = history.mesh, history.growth_times
    place = [""] * mesh.n_points
    for order, point in enumerate(mesh.contour.tolist()):
        place[point] = str(order)
    with fresh(path).open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(csv_columns(mesh.n_dim))
        for number in states:
            time, values = float(times[number]), np.hstack([mesh.points, history.displacement(number)])
            writer.writerows(
                (number, time, point, place[point], *row) for point, row in enumerate(values.tolist())
            )
    return [path]


def _write_vtu(history: History, path: Path, states: list[int], names: tuple[OutputField, ...]) -> list[Path]:
    meshio = _meshio("vtu")
    files = numbered(path, states)
    for file, number in zip(files, states, strict=True):
        point_data, cell_data = point_and_cell_data(history, number, names)
        cells = [(cell_type(history.mesh).meshio, history.mesh.cells)]
        grid = meshio.Mesh(padded(history.mesh.points), cells, point_data, cell_data)
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


def _meshio(format: str) -> Any:
    return require("meshio", "export", f"An export as {format}")
