"""What files for other programs share: names of cells and of files, vectors in space, fields by place."""

from __future__ import annotations

from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from gyrify.config.run_sections import OutputField
from gyrify.mesh import Mesh
from gyrify.solve.types import FloatArray
from gyrify.store.fields import fields
from gyrify.store.history import History
from gyrify.store.state_fields import POINT_FIELDS


class CellType(NamedTuple):
    """What other programs call a simplex: VTK's number, the names of meshio and of XDMF."""

    vtk: int
    meshio: str
    xdmf: str


# By dimension and number of nodes.
_CELL_TYPES: Final = {
    (2, 3): CellType(5, "triangle", "Triangle"),
    (2, 6): CellType(22, "triangle6", "Triangle_6"),
    (3, 4): CellType(10, "tetra", "Tetrahedron"),
    (3, 10): CellType(24, "tetra10", "Tetrahedron_10"),
}


def cell_type(mesh: Mesh) -> CellType:
    """What other programs call the cells of a mesh."""
    return _CELL_TYPES[mesh.n_dim, mesh.cells.shape[1]]


def point_and_cell_data(
    history: History, number: int, names: tuple[OutputField, ...]
) -> tuple[dict[str, FloatArray], dict[str, list[FloatArray]]]:
    """Point and cell data of a state: vectors with three entries, tensors with nine (row by row)."""
    point_data: dict[str, FloatArray] = {}
    cell_data: dict[str, list[FloatArray]] = {}
    for name, values in fields(history, number, names).items():
        if name in POINT_FIELDS:
            point_data[name] = padded(values) if values.ndim == 2 else values
        else:
            cell_data[name] = [values.reshape(-1, 9) if values.ndim == 3 else values]
    return point_data, cell_data


def padded(vectors: FloatArray) -> FloatArray:
    """(n, 3) vectors; those of the plane with a zero third component."""
    return np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))


def numbered(path: Path, states: list[int]) -> list[Path]:
    """The path itself for one state; ``stem_0000.ext``, numbered by increment, for several."""
    if len(states) == 1:
        return [path]
    return [path.with_name(f"{path.stem}_{number:04d}{path.suffix}") for number in states]
