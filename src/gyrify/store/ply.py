"""PLY: what STL has, with the fields of its points."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from gyrify.config.run_sections import OutputField
from gyrify.solve.types import FloatArray
from gyrify.store.external import numbered
from gyrify.store.fields import field_unit, fields
from gyrify.store.files import fresh
from gyrify.store.history import History
from gyrify.store.state_fields import POINT_FIELDS
from gyrify.store.stl import solid


def write_ply(
    history: History, path: Path, states: list[int], names: tuple[OutputField, ...], thickness: float
) -> list[Path]:
    """Write a file per state, binary: points with their fields in single precision, and triangles.

    A vector is three properties, ``displacement_x`` and so on. What is not defined, such as the thickness of
    the cortex on the wall of the hole, is NaN.
    """
    files = numbered(path, states)
    chosen = [name for name in names if name in POINT_FIELDS]
    for file, number in zip(files, states, strict=True):
        printed = solid(history.mesh, history.points(number), thickness)
        columns = dict(zip("xyz", printed.points.T, strict=True))
        for field, values in fields(history, number, chosen).items():
            columns |= _properties(field, values[printed.source])
        vertices = np.zeros(len(printed.points), dtype=[(name, "<f4") for name in columns])
        for name, column in columns.items():
            vertices[name] = column
        faces = np.zeros(len(printed.triangles), dtype=[("count", "u1"), ("corners", "<i4", 3)])
        faces["count"], faces["corners"] = 3, printed.triangles
        units = [f"{name} [{field_unit(name, history.mesh.n_dim)}]" for name in chosen]
        header = _header(list(columns), units, len(vertices), len(faces))
        fresh(file).write_bytes(header.encode("utf-8") + vertices.tobytes() + faces.tobytes())
    return files


def _properties(name: str, values: FloatArray) -> dict[str, FloatArray]:
    if values.ndim == 1:
        return {name: values}
    return {f"{name}_{axis}": column for axis, column in zip("xyz", values.T, strict=False)}


def _header(properties: list[str], units: list[str], n_points: int, n_faces: int) -> str:
    lines = [
        "ply",
        "format binary_little_endian 1.0",
        f"comment gyrify: lengths in mm; {', '.join(units) or 'no fields'}".replace("²", "^2"),
        f"element vertex {n_points}",
        *(f"property float {name}" for name in properties),
        f"element face {n_faces}",
        "property list uchar int vertex_indices",
        "end_header",
    ]
    return "\n".join(lines) + "\n"
