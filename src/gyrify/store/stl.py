"""STL: the deformed slice as a closed solid, or the body in space, which can be printed."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gyrify.errors import ConfigError
from gyrify.mesh import Mesh
from gyrify.mesh.boundary import boundary_faces
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
        printed = solid(history.mesh, history.points(number), thickness)
        corners = printed.points[printed.triangles]
        records = np.zeros(len(corners), dtype=_RECORD)
        records["corners"] = corners
        records["normal"] = _normals(corners)
        count = np.array(len(corners), dtype="<u4").tobytes()
        fresh(file).write_bytes(_HEADER + count + records.tobytes())
    return files


@dataclass(frozen=True, eq=False)
class Solid:
    """A closed surface.

    Attributes
    ----------
    points : (n, 3) float array
        Positions [mm].
    triangles : (n_triangles, 3) int array
        Their corners, counter-clockwise as seen from outside.
    source : (n,) int array
        The point of the mesh that each is.
    """

    points: FloatArray
    triangles: NDArray[np.int64]
    source: NDArray[np.int64]


def solid(mesh: Mesh, points: FloatArray, thickness: float) -> Solid:
    """Closed surface of a body in space, or of a slice that is given a thickness.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    points : (n_points, n_dim) float array
        Positions of its points [mm].
    thickness : float
        Thickness t of a slice [mm]: the solid lies between z = 0 and z = t. A strip is one period long, its
        sides closed.

    Raises
    ------
    ConfigError
        If the body is a patch: its sides are no boundary.
    """
    return _body(mesh, points) if mesh.n_dim == 3 else _slab(mesh, points, thickness)


def _body(mesh: Mesh, points: FloatArray) -> Solid:
    if mesh.period is not None:
        raise ConfigError("A patch has no closed surface to print.", "Export it as vtu.")
    faces, _ = boundary_faces(mesh)
    source, places = np.unique(faces, return_inverse=True)
    return Solid(points[source], places.reshape(faces.shape), source)


def _slab(mesh: Mesh, points: FloatArray, thickness: float) -> Solid:
    flat, triangles = _unrolled(mesh, points)
    start, end = _boundary(triangles).T
    n = len(flat)
    upper, source = triangles + n, np.arange(2 * n) % mesh.n_points
    both = [np.column_stack([flat, np.full(n, z)]) for z in (0.0, thickness)]
    # The tissue lies on the left of a boundary edge, so that the sides look to its right, outwards.
    sides = [np.stack([start, end, end + n], axis=1), np.stack([start, end + n, start + n], axis=1)]
    return Solid(np.concatenate(both), np.concatenate([upper, triangles[:, ::-1], *sides]), source)


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
