"""STL: the deformed slice as a closed solid, or the body in space, which can be printed."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gyrify.errors import ConfigError
from gyrify.mesh import Mesh
from gyrify.solve.types import FloatArray
from gyrify.store.external import numbered
from gyrify.store.files import fresh
from gyrify.store.history import History

# Thickness of the solid along z [mm].
THICKNESS: Final = 2.0
_HEADER: Final = b"gyrify: deformed slice, lengths in mm".ljust(80)
_RECORD: Final = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def write_stl(history: History, path: Path, states: list[int], thickness: float) -> list[Path]:
    """Write a file per state, binary and in single precision, as the format has it."""
    files = numbered(path, states)
    for file, number in zip(files, states, strict=True):
        mesh, points = history.mesh, history.points(number)
        corners = solid(mesh, points, thickness) if mesh.n_dim == 2 else boundary(mesh, points)
        records = np.zeros(len(corners), dtype=_RECORD)
        records["corners"] = corners
        records["normal"] = _normals(corners)
        count = np.array(len(corners), dtype="<u4").tobytes()
        fresh(file).write_bytes(_HEADER + count + records.tobytes())
    return files


def boundary(mesh: Mesh, points: FloatArray) -> FloatArray:
    """(n_triangles, 3, 3) corners of the boundary of a body in space, as seen from outside [mm].

    Raises
    ------
    ConfigError
        If the body is periodic: its sides are no boundary.
    """
    if mesh.period is not None:
        raise ConfigError("A patch has no closed surface to print.", "Export it as vtu.")
    # faces that one cell has alone, each opposite a corner
    opposite = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
    faces = mesh.cells[:, opposite].reshape(-1, 3)
    _, first, counts = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return np.asarray(points[faces[np.sort(first[counts == 1])]])


def solid(mesh: Mesh, points: FloatArray, thickness: float) -> FloatArray:
    """Closed surface of a slice that is given a thickness.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    points : (n_points, 2) float array
        Positions of its points [mm].
    thickness : float
        Thickness t [mm]: the solid lies between z = 0 and z = t.

    Returns
    -------
    (n_triangles, 3, 3) float array
        Corners [mm], counter-clockwise as seen from outside. A strip is one period long, its sides closed.
    """
    flat, triangles = _unrolled(mesh, points)
    edges = _boundary(triangles)
    low, high = (np.column_stack([flat, np.full(len(flat), z)]) for z in (0.0, thickness))
    start, end = edges.T
    return np.concatenate(
        [
            high[triangles],
            low[triangles[:, ::-1]],
            # The tissue lies on the left of a boundary edge, so that these look to its right, outwards.
            np.stack([low[start], low[end], high[end]], axis=1),
            np.stack([low[start], high[end], high[start]], axis=1),
        ]
    )


def _unrolled(mesh: Mesh, points: FloatArray) -> tuple[FloatArray, NDArray[np.int64]]:
    """Positions and triangles; those of a strip that run over its end get the points of the next period."""
    triangles = mesh.triangles
    if mesh.period is None:
        return points, triangles
    x = mesh.points[triangles, 0]
    is_beyond = x - x.max(axis=1, keepdims=True) < -0.5 * mesh.period
    return (
        np.concatenate([points, points + np.array([mesh.period, 0.0])]),
        np.where(is_beyond, triangles + mesh.n_points, triangles),
    )


def _boundary(triangles: NDArray[np.int64]) -> NDArray[np.int64]:
    """(n, 2) edges that one triangle has alone, in the direction in which it goes round."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    _, first, counts = np.unique(np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True)
    return np.asarray(edges[np.sort(first[counts == 1])])


def _normals(corners: FloatArray) -> FloatArray:
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sizes = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.asarray(normals / np.where(sizes > 0.0, sizes, 1.0))
