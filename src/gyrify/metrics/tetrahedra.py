"""Faces and volumes of tetrahedra, whatever they are part of."""

from __future__ import annotations

from typing import Final

import numpy as np

from gyrify.metrics.surface import FloatArray, IntArray

# Corners of the face opposite each corner, counter-clockwise seen from outside of a positive cell.
FACES: Final = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
# Ends of its edges.
EDGES: Final = np.array([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]])


def signed_volumes(corners: FloatArray) -> FloatArray:
    """(n_cells,) signed volume of tetrahedra with (n_cells, 4, 3) corners [mm^3]."""
    return np.asarray(np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6.0)


def faces_by_cells(cells: IntArray) -> tuple[IntArray, IntArray, IntArray]:
    """Faces that cells share.

    Parameters
    ----------
    cells : (n_cells, 4) int array
        Positive.

    Returns
    -------
    faces : (4 n_cells, 3) int array
        Of each cell, outwards counter-clockwise.
    order : (4 n_cells,) int array
        Numbers of those, equal ones next to each other.
    first : (n + 1,) int array
        Where in ``order`` each different face begins, and the end.
    """
    faces = cells[:, FACES].reshape(-1, 3)
    _, number = np.unique(np.sort(faces, axis=1), axis=0, return_inverse=True)
    order = np.argsort(number.ravel(), kind="stable")
    first = np.searchsorted(number.ravel()[order], np.arange(int(number.max(initial=-1)) + 2))
    return faces, order, first


def faces_of_one_cell(cells: IntArray) -> IntArray:
    """(n, 3) faces that belong to one cell only, outwards counter-clockwise, in the order of the cells."""
    faces, order, first = faces_by_cells(cells)
    return np.asarray(faces[np.sort(order[first[:-1][np.diff(first) == 1]])])


def faces_between(cells: IntArray, inside: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> IntArray:
    """(n, 3) faces between cells inside and others, counter-clockwise seen from the others."""
    faces, order, first = faces_by_cells(cells)
    pairs = first[:-1][np.diff(first) == 2]
    a, b = order[pairs], order[pairs + 1]
    parts = inside[a // 4] != inside[b // 4]
    own = np.where(inside[a // 4], a, b)[parts]
    return np.asarray(faces[np.sort(own)])
