"""The interface under an outer surface: as deep as the cortex is thick, and nowhere through itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from gyrify.base.places import place
from gyrify.errors import MeshError
from gyrify.mesh.mesh import FloatArray, IntArray
from gyrify.mesh.shells import prisms
from gyrify.metrics.surface import face_vectors
from gyrify.metrics.surface_pairs import crossings

# Where cells would be poor or surfaces cross, the cortex is made thinner by this factor at a time ...
_THINNER: Final = 0.9
# ... down to this share of its thickness.
_THINNEST: Final = 0.2
_MOST_ROUNDS: Final = 80
_ROUNDS_OF_BALLS: Final = 60
# Largest change of thickness along the surface.
_SLOPE: Final = 0.5
# Nothing may cross so far below the interface, over the shortest edge there or the thickness, so that white
# cells have room.
_ROOM: Final = 0.3
# Least volume of a cell of the cortex over that under a flat surface.
_VOLUME: Final = 0.2
# Least area of a triangle of the interface over that above it.
_AREA: Final = 0.04
# Orientation of the cells of a prism over a triangle whose numbers rise counter-clockwise.
_SIGNS: Final = np.array([1.0, -1.0, 1.0])


@dataclass(frozen=True, eq=False)
class Cortex:
    """The cortex under a surface.

    Attributes
    ----------
    inner : (n_points, 3) float array
        Points of the interface, each under that of the surface of the same number [mm].
    share : (n_points,) float array
        Thickness there over the wanted one: 1, but less where the body is too sharp or thin for it.
    """

    inner: FloatArray
    share: FloatArray


def offset_surface(points: FloatArray, triangles: IntArray, T: float, n_layers: int) -> Cortex:
    """Lay the interface under a surface.

    Every point goes inwards by T along the normal. Where layers between would be inverted or poor, or the
    interface meets itself or the surface, the cortex is made thinner, smoothly along the surface.

    Parameters
    ----------
    points : (n_points, 3) float array
        Outer surface [mm].
    triangles : (n, 3) int array
        Outwards counter-clockwise.
    T : float
        Thickness [mm].
    n_layers : int
        Layers of cells in the cortex.

    Returns
    -------
    Cortex

    Raises
    ------
    MeshError
        If less than a fifth of the thickness is possible somewhere.
    """
    inwards = -angle_normals(points, triangles)
    edges = np.unique(np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
    length = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
    shortest = np.full(points.shape[0], np.inf)
    np.minimum.at(shortest, edges, length[:, None])
    slope = _SLOPE * length / T
    share = np.ones(points.shape[0])
    for _ in range(_MOST_ROUNDS):
        inner = points + T * share[:, None] * inwards
        poor = np.unique(triangles[_is_poor(points, inner, triangles, n_layers)])
        if poor.size:
            inwards[poor] = -_most_visible(points, triangles, poor)
        else:
            room = _ROOM * np.minimum(shortest, T * share)
            poor = _meeting(points, inner + room[:, None] * inwards, triangles)
            if poor.size == 0:
                return Cortex(inner, share)
        share[poor] *= _THINNER
        share = _limited(share, edges, slope)
        if share.min() < _THINNEST:
            break
    worst = int(np.argmin(share))
    raise MeshError(
        f"A cortex of {T:g} mm does not fit under the surface at {place(points[worst])}: cells would be "
        "inverted or walls would meet even if it were five times thinner there.",
        "Lower geometry.cortical_thickness, smooth the surface there, or give geometry.interface_file.",
    )


def require_layers(points: FloatArray, inner: FloatArray, triangles: IntArray, n_layers: int) -> None:
    """Refuse an interface under which layers would be inverted, or that crosses itself or the surface.

    Parameters
    ----------
    points, inner : (n_points, 3) float array
        Points of the surface, and of the interface under each of them [mm].
    triangles : (n, 3) int array
        Of both.
    n_layers : int
        Layers of cells in the cortex.

    Raises
    ------
    MeshError
        With a place.
    """
    poor = np.unique(triangles[_is_poor(points, inner, triangles, n_layers)])
    if poor.size == 0:
        poor = _meeting(points, inner, triangles)
    if poor.size:
        raise MeshError(
            f"The interface does not lie under the surface at {poor.size} points, first at "
            f"{place(points[poor[0]])}: cells between them would be inverted, or surfaces cross.",
            "Check that the points of both files belong together, or leave geometry.interface_file out.",
        )


def angle_normals(points: FloatArray, triangles: IntArray) -> FloatArray:
    """(n_points, 3) unit normals, those of the triangles around by their angles at the point."""
    corners = points[triangles]
    normals = face_vectors(corners)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    found = np.zeros_like(points)
    for k in range(3):
        a, b = (corners[:, (k + n) % 3] - corners[:, k] for n in (1, 2))
        angle = np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), np.einsum("ni,ni->n", a, b))
        for axis in range(3):
            found[:, axis] += np.bincount(triangles[:, k], angle * normals[:, axis], points.shape[0])
    return np.asarray(found / np.linalg.norm(found, axis=1, keepdims=True))


def _is_poor(
    points: FloatArray, inner: FloatArray, triangles: IntArray, n_layers: int
) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Under which triangles a cell has too little volume, or the interface too little area."""
    n, above = points.shape[0], face_vectors(points[triangles])
    square = np.einsum("ni,ni->n", above, above)
    poor = np.einsum("ni,ni->n", above, face_vectors(inner[triangles])) < _AREA * square
    depth = np.linalg.norm(points - inner, axis=1)[triangles].min(axis=1)
    least = _VOLUME * np.sqrt(square) / 2.0 * depth / (3.0 * n_layers)
    for k in range(n_layers):
        low, high = (inner + (points - inner) * (j / n_layers) for j in (k, k + 1))
        poor |= _least_volume(np.concatenate([low, high]), triangles, n) < least
    return np.asarray(poor)


def _least_volume(points: FloatArray, triangles: IntArray, n: int) -> FloatArray:
    """(n,) least volume of the cells of each prism, cut in either way [mm^3]."""
    found = np.full(triangles.shape[0], np.inf)
    ordered = np.argsort(triangles, axis=1)
    even = (ordered[:, 0] + 1) % 3 == ordered[:, 1]
    for falling in (False, True):
        corners = points[prisms(triangles, 0, n, falling)]
        volumes = np.linalg.det(corners[:, :, 1:] - corners[:, :, :1]) / 6.0
        sign = np.where(even ^ falling, 1.0, -1.0)[:, None] * _SIGNS
        found = np.minimum(found, (sign * volumes).min(axis=1))
    return found


def _meeting(points: FloatArray, beyond: FloatArray, triangles: IntArray) -> IntArray:
    """Points under which a surface somewhat below the interface crosses itself or the outer one."""
    n = points.shape[0]
    edges, hit = crossings(np.concatenate([points, beyond]), np.concatenate([triangles, triangles + n]))
    both = np.concatenate([edges.ravel(), triangles[hit % triangles.shape[0]].ravel()])
    return np.unique(both % n)


def _most_visible(points: FloatArray, triangles: IntArray, chosen: IntArray) -> FloatArray:
    """(n, 3) unit directions that make the smallest possible largest angle with the normals around.

    The middle of the smallest ball about the normals, by the iteration of Badoiu and Clarkson (2003).
    """
    wanted = np.full(points.shape[0], -1)
    wanted[chosen] = np.arange(chosen.size)
    point = wanted[triangles.ravel()]
    face = np.repeat(np.arange(triangles.shape[0]), 3)[point >= 0]
    point = point[point >= 0]
    normals = face_vectors(points[triangles[face]])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    middle = angle_normals(points, triangles)[chosen]
    for k in range(_ROUNDS_OF_BALLS):
        away = np.square(normals - middle[point]).sum(axis=1)
        order = np.lexsort((away, point))
        last = np.append(np.flatnonzero(np.diff(point[order])), point.size - 1)
        farthest = normals[order[last]]
        middle = middle + (farthest - middle) / (k + 2.0)
    return np.asarray(middle / np.linalg.norm(middle, axis=1, keepdims=True))


def _limited(share: FloatArray, edges: IntArray, slope: FloatArray) -> FloatArray:
    """Shares that change by no more than a slope along any edge, lowered where need be."""
    limited, (a, b) = share.copy(), edges.T
    while True:
        before = limited.copy()
        np.minimum.at(limited, a, before[b] + slope)
        np.minimum.at(limited, b, before[a] + slope)
        if np.all(before - limited < 1e-12):
            return limited
