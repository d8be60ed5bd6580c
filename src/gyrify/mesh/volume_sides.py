"""Boundaries of given tetrahedra told apart: the outer surface, holes, and the cut of half a body."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from gyrify.base.places import place
from gyrify.errors import MeshError
from gyrify.mesh.mesh import FloatArray, IntArray
from gyrify.metrics.surface import enclosed_volume, face_vectors
from gyrify.metrics.tetrahedra import faces_of_one_cell

# Over the mean edge of the boundary: points this near to the plane of symmetry are moved into it ...
_IN_PLANE: Final = 1e-3
# ... and a face as flat as it that is this near, but not in it, is a cut that is not flat.
_NEAR: Final = 0.2
_AS_FLAT: Final = 0.9


@dataclass(frozen=True, eq=False)
class Sides:
    """Boundaries of a body.

    Attributes
    ----------
    points : (n_points, 3) float array
        Those of the body, those of the cut moved exactly into the plane [mm].
    outer : (n, 3) int array
        Triangles of the outer surface.
    hole : (n_hole,) int array
        Points on holes.
    on_plane : (n_plane,) int array
        Points in the plane of symmetry.
    notes : tuple of str
        What was moved, as sentences.
    """

    points: FloatArray
    outer: IntArray
    hole: IntArray
    on_plane: IntArray
    notes: tuple[str, ...]


def sides_of(points: FloatArray, cells: IntArray, plane: tuple[FloatArray, FloatArray] | None) -> Sides:
    """Tell the boundaries of tetrahedra apart.

    Parameters
    ----------
    points : (n_points, 3) float array
        [mm].
    cells : (n_cells, 4) int array
        Positive.
    plane : ((3,) float array, (3,) float array) or None
        A point on a plane of symmetry [mm] and its normal out of the body, along an axis.

    Returns
    -------
    Sides

    Raises
    ------
    MeshError
        If the body lies on both sides of the plane, or has no flat side there.
    """
    faces, notes = faces_of_one_cell(cells), tuple[str, ...]()
    in_plane = np.zeros(points.shape[0], dtype=bool)
    origin = points.mean(axis=0)
    if plane is not None:
        points, in_plane, notes = _cut(points, faces, *plane)
        faces, origin = faces[~in_plane[faces].all(axis=1)], plane[0]
    part = _parts(faces, points.shape[0])
    # seen from a point of the plane the cut has no part in the volume, so that an open piece has one, too
    volume = [enclosed_volume(points[faces[part == k]] - origin) for k in range(part.max() + 1)]
    is_outer = (np.array(volume) > 0.0)[part]
    return Sides(points, faces[is_outer], np.unique(faces[~is_outer]), np.flatnonzero(in_plane), notes)


def _cut(
    points: FloatArray, faces: IntArray, point: FloatArray, normal: FloatArray
) -> tuple[FloatArray, NDArray[np.bool_], tuple[str, ...]]:
    """Points with those of the cut in the plane, which they are, and what was moved."""
    height, corners = (points - point) @ normal, points[faces]
    edge = float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean())
    inside, highest = np.abs(height) <= _IN_PLANE * edge, int(np.argmax(height))
    where = place(points[highest])
    if height[highest] > _IN_PLANE * edge:
        raise MeshError(
            f"The body lies on both sides of boundary.plane: {where} is {height[highest]:.3g} mm beyond it.",
            "Give a point and a normal that points out of the body, or cut the body there.",
        )
    vectors = face_vectors(corners)
    is_flat = vectors @ normal > _AS_FLAT * np.linalg.norm(vectors, axis=1)
    beside = is_flat & (np.abs(height[faces]) < _NEAR * edge).all(axis=1) & ~inside[faces].all(axis=1)
    if beside.any():
        worst = faces[np.flatnonzero(beside)[0]]
        farthest = worst[np.argmax(np.abs(height[worst]))]
        raise MeshError(
            f"The flat side of the body does not lie in boundary.plane: {np.count_nonzero(beside)} of its "
            f"faces leave it, first at {place(points[farthest])}, by {-height[farthest]:.2g} mm.",
            f"Move the points of the cut into the plane; {_IN_PLANE * edge:.2g} mm are allowed.",
        )
    if not np.any(inside[faces].all(axis=1)):
        raise MeshError(
            f"The body has no face in boundary.plane: its nearest point, {where}, is "
            f"{abs(height[highest]):.3g} mm away.",
            "Give a point of the flat side of the body, in mm.",
        )
    axis, moved = int(np.argmax(np.abs(normal))), points.copy()
    moved[inside, axis] = point[axis]
    farthest_moved = float(np.abs(height[inside]).max())
    if farthest_moved <= 1e-9 * float(np.ptp(points, axis=0).max()):
        return moved, inside, ()
    return (
        moved,
        inside,
        (f"Points of the cut were moved into boundary.plane, by up to {farthest_moved:.2g} mm.",),
    )


def _parts(faces: IntArray, n_points: int) -> IntArray:
    """(n,) connected part of each triangle."""
    a, b = faces[:, [0, 1]].ravel(), faces[:, [1, 2]].ravel()
    graph = coo_array((np.ones(a.size), (a, b)), shape=(n_points, n_points))
    _, label = connected_components(graph, directed=False)
    return np.asarray(np.unique(label[faces[:, 0]], return_inverse=True)[1], dtype=np.int64)
