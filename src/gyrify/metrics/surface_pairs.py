"""What of a surface is close to what: crossings, the narrowest sulcus, distances to another surface."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from gyrify.metrics.surface import FloatArray, IntArray, face_vectors, vertex_normals

# Walls of a sulcus face each other: the cosine of the angle between their normals is below this.
_FACING: Final = -0.3
_NEAREST: Final = 8
# Volumes over the cube of the size of their corners that are rounding.
_ROUNDING: Final = 1e-12


def crosses_itself(points: FloatArray, faces: IntArray) -> bool:
    """Whether an edge of a surface passes through a triangle that it has no point in common with.

    Every crossing of two triangles has such an edge. The test knows nothing of the solver that made the
    state.
    """
    return any(hit.size > 0 for _, hit in _crossings(points, faces))


def crossings(points: FloatArray, faces: IntArray) -> tuple[IntArray, IntArray]:
    """(n, 2) points of the edges that pass through triangles, and (n,) which triangles."""
    found = list(_crossings(points, faces))
    return np.concatenate([edges for edges, _ in found]), np.concatenate([hit for _, hit in found])


def _crossings(points: FloatArray, faces: IntArray) -> Iterator[tuple[IntArray, IntArray]]:
    """Crossings, by classes of edges and triangles of like size.

    Pairs that may touch are searched within the sum of the largest radii, so that one long edge does not make
    all others look far.
    """
    edges = np.unique(
        np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], 2).reshape(-1, 2), axis=1), axis=0
    )
    ends, corners = points[edges], points[faces]
    middles, centres = ends.mean(axis=1), corners.mean(axis=1)
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / 2.0
    sizes = np.linalg.norm(corners - centres[:, None], axis=2).max(axis=1)
    for of_edges in _size_classes(lengths):
        tree = cKDTree(middles[of_edges])
        for of_faces in _size_classes(sizes):
            reach = lengths[of_edges].max() + sizes[of_faces].max()
            near = tree.sparse_distance_matrix(cKDTree(centres[of_faces]), reach, output_type="ndarray")
            edge, face = of_edges[near["i"]], of_faces[near["j"]]
            close = near["v"] <= lengths[edge] + sizes[face]
            edge, face = edge[close], face[close]
            apart = ~np.any(edges[edge][:, :, None] == faces[face][:, None, :], axis=(1, 2))
            edge, face = edge[apart], face[apart]
            hit = _pierce(ends[edge], corners[face])
            yield edges[edge[hit]], face[hit]


def _size_classes(sizes: FloatArray) -> list[IntArray]:
    """Numbers of those of like size: those above the median by factors of two, the rest in one class."""
    steps = np.floor(np.log2(np.maximum(sizes, 1e-300) / np.median(sizes))).astype(np.int64)
    steps = np.maximum(steps, 0)
    return [np.flatnonzero(steps == step) for step in np.unique(steps)]


def _pierce(ends: FloatArray, corners: FloatArray) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Which of (n, 2, 3) edges pass through which of (n, 3, 3) triangles.

    What lies in the plane of a triangle but for rounding touches it, and does not pass through.
    """
    p, q = ends[:, 0], ends[:, 1]
    a, b, c = (corners[:, k] for k in range(3))
    below, above = _volume(a, b, c, p), _volume(a, b, c, q)
    sides = np.stack([_volume(p, q, a, b), _volume(p, q, b, c), _volume(p, q, c, a)], axis=1)
    inside = np.all(sides > 0.0, axis=1) | np.all(sides < 0.0, axis=1)
    size = np.abs(np.concatenate([ends, corners], axis=1) - p[:, None]).max(axis=(1, 2))
    is_apart = np.minimum(np.abs(below), np.abs(above)) > _ROUNDING * size**3
    return np.asarray((below * above < 0.0) & inside & is_apart)


def _volume(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray) -> FloatArray:
    """Six times the signed volume of tetrahedra."""
    return np.asarray(np.einsum("ni,ni->n", np.cross(b - a, c - a), d - a))


def contains(corners: FloatArray, point: FloatArray) -> bool:
    """Whether a closed surface with (n, 3, 3) corners has a point inside: its solid angle is then 4 pi."""
    to = corners - point
    size = np.linalg.norm(to, axis=2)
    top = np.einsum("ni,ni->n", to[:, 0], np.cross(to[:, 1], to[:, 2]))
    below = size.prod(axis=1)
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        below = below + np.einsum("ni,ni->n", to[:, i], to[:, j]) * size[:, k]
    return bool(abs(np.arctan2(top, below).sum()) > np.pi)


def smallest_gap(points: FloatArray, faces: IntArray) -> float:
    """Smallest way across a sulcus: outwards from a point of the surface to a triangle that faces it [mm].

    Looked for from the points and the middles of the edges, to triangles that have no point in common with
    them; infinite where nothing faces anything within a tenth of the body's size.
    """
    corners = points[faces]
    edges = np.unique(
        np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], 2).reshape(-1, 2), axis=1), axis=0
    )
    normals = vertex_normals(points.shape[0], faces, corners)
    owners = np.concatenate([np.repeat(np.arange(points.shape[0])[:, None], 2, axis=1), edges])
    starts = points[owners].mean(axis=1)
    directions = np.concatenate([normals, normals[edges].sum(axis=1)])
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    facets = face_vectors(corners)
    facets /= np.linalg.norm(facets, axis=1, keepdims=True)
    centres = corners.mean(axis=1)
    sizes = np.linalg.norm(corners - centres[:, None], axis=2).max(axis=1)
    groups = []
    for own, facing in _facing_groups(directions, facets):
        tree = cKDTree(starts[own])
        # by size, so that a few large triangles do not make all others look far
        for part in _size_classes(sizes[facing]):
            other = facing[part]
            groups.append((tree, cKDTree(centres[other]), sizes[other].max(), own, other))
    gap, limit = float(np.median(sizes)), 0.1 * float(np.ptp(points, axis=0).max())
    while True:
        found = np.inf
        for tree, of_faces, size, own, other in groups:
            reach = size + min(gap, found)
            near = tree.sparse_distance_matrix(of_faces, reach, output_type="ndarray")
            start, face = own[near["i"]], other[near["j"]]
            kept = np.einsum("ni,ni->n", directions[start], facets[face]) < _FACING
            # at the bottom of a sharp sulcus a point faces triangles about itself, at no distance
            kept &= ~np.any(owners[start][:, :, None] == faces[face][:, None, :], axis=(1, 2))
            start, face = start[kept], face[kept]
            across = closest_points(starts[start], corners[face]) - starts[start]
            outwards = np.einsum("ni,ni->n", across, directions[start]) > 0.0
            found = min(found, float(np.linalg.norm(across[outwards], axis=1).min(initial=np.inf)))
        if found <= gap:  # nothing nearer was out of reach
            return found
        if gap >= limit:
            return np.inf
        gap = min(2.0 * gap if found == np.inf else found, limit)


def _facing_groups(directions: FloatArray, facets: FloatArray) -> Iterator[tuple[IntArray, IntArray]]:
    """Starts and facets among which all pairs are that face each other.

    Facets are grouped by the nearest of 26 directions, so that on a smooth surface no start has to look at
    those around it, of which there may be many within the reach.
    """
    steps = np.array([step for step in np.ndindex(3, 3, 3) if step != (1, 1, 1)]) - 1.0
    axes = steps / np.linalg.norm(steps, axis=1, keepdims=True)
    group = np.argmax(facets @ axes.T, axis=1)
    for k in np.unique(group):
        other = np.flatnonzero(group == k)
        # the facet farthest from the axis of its group may face what is nearer to that axis by as much
        away = np.arccos(np.clip((facets[other] @ axes[k]).min(), -1.0, 1.0))
        nearest = max(np.arccos(_FACING) - away - 1e-9, 0.0)
        own = np.flatnonzero(directions @ axes[k] <= np.cos(nearest))
        if own.size:
            yield own, other


def distances_to(points: FloatArray, corners: FloatArray) -> FloatArray:
    """(n,) shortest distances from points to a surface of triangles [mm]."""
    centres = corners.mean(axis=1)
    n_near = min(_NEAREST, centres.shape[0])
    _, face = cKDTree(centres).query(points, k=n_near)
    face = face.reshape(points.shape[0], n_near)
    flat = np.repeat(points, n_near, axis=0)
    distance = np.linalg.norm(closest_points(flat, corners[face.ravel()]) - flat, axis=1)
    return np.asarray(distance.reshape(face.shape).min(axis=1))


def closest_points(points: FloatArray, corners: FloatArray) -> FloatArray:
    """(n, 3) point of each of (n, 3, 3) triangles that is nearest to each of (n, 3) points."""
    normal = face_vectors(corners)
    square = np.maximum(np.einsum("ni,ni->n", normal, normal), 1e-300)
    offset = points - corners[:, 0]
    on_plane = points - (np.einsum("ni,ni->n", offset, normal) / square)[:, None] * normal
    best, distance = on_plane, np.where(_is_inside(on_plane, corners, normal), -1.0, np.inf)
    for k in range(3):
        a, b = corners[:, k], corners[:, (k + 1) % 3]
        side = b - a
        length = np.maximum(np.einsum("ni,ni->n", side, side), 1e-300)
        part = np.clip(np.einsum("ni,ni->n", points - a, side) / length, 0.0, 1.0)
        on_side = a + part[:, None] * side
        away = np.linalg.norm(points - on_side, axis=1)
        nearer = away < distance
        best, distance = np.where(nearer[:, None], on_side, best), np.where(nearer, away, distance)
    return np.asarray(best)


def _is_inside(
    points: FloatArray, corners: FloatArray, normal: FloatArray
) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Which points of the planes of triangles lie within them."""
    inside = np.ones(points.shape[0], dtype=bool)
    for k in range(3):
        a, b = corners[:, k], corners[:, (k + 1) % 3]
        inside &= np.einsum("ni,ni->n", np.cross(b - a, points - a), normal) >= 0.0
    return inside
