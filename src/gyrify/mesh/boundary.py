"""Straight tetrahedra and triangles of a body in space: its cells and its boundary as they are drawn."""

from __future__ import annotations

from typing import Final

import numpy as np

from gyrify.mesh.mesh import IntArray, Mesh
from gyrify.metrics.tetrahedra import FACES

# Sides of a quadratic tetrahedron are four triangles each, with the nodes between the corners in the order
# of VTK.
_BETWEEN: Final = np.array([[0, 4, 6, 7], [4, 1, 5, 8], [6, 5, 2, 9], [7, 8, 9, 3]])
_QUARTERED: Final = np.array(
    [
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        for a, b, c in FACES.tolist()
        for ab, bc, ca in [(int(_BETWEEN[a, b]), int(_BETWEEN[b, c]), int(_BETWEEN[c, a]))]
    ]
).reshape(-1, 3)
# The eight parts of a quadratic one: at its corners, and around the diagonal of what is left.
_PARTS: Final = np.array([*_BETWEEN, [6, 8, 4, 5], [6, 8, 5, 9], [6, 8, 9, 7], [6, 8, 7, 4]])


def straight_cells(mesh: Mesh) -> IntArray:
    """(n, 4) tetrahedra between the nodes: the cells, or eight per quadratic one, next to each other."""
    return mesh.cells if mesh.cells.shape[1] == 4 else mesh.cells[:, _PARTS].reshape(-1, 4)


def boundary_faces(mesh: Mesh) -> tuple[IntArray, IntArray]:
    """Sides that one cell has alone, with that cell.

    Parameters
    ----------
    mesh : Mesh
        Tetrahedra. The two sides of a period are no boundary.

    Returns
    -------
    faces : (n, 3) int array
        Their points, counter-clockwise seen from outside: first those of ``mesh.faces``, in its order.
    cells : (n,) int array
        The cell of each.
    """
    sides = FACES if mesh.cells.shape[1] == 4 else _QUARTERED
    faces = mesh.cells[:, sides].reshape(-1, 3)
    keys = _key(mesh, faces)
    _, first, counts = np.unique(keys, return_index=True, return_counts=True)
    alone = np.sort(first[counts == 1])
    order = np.argsort(keys[alone])
    outer = order[np.searchsorted(keys[alone], _key(mesh, mesh.faces), sorter=order)]
    chosen = np.concatenate([alone[outer], np.delete(alone, outer)])
    return faces[chosen], chosen // len(sides)


def _key(mesh: Mesh, corners: IntArray) -> IntArray:
    """One number for three points in any order."""
    a, b, c = np.sort(corners, axis=1).T
    return np.asarray((a * mesh.n_points + b) * mesh.n_points + c)
