"""Geometry of triangulated surfaces in space: areas, volume, normals, mean curvature."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array, diags_array
from scipy.sparse.linalg import splu

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def face_areas(corners: FloatArray) -> FloatArray:
    """(n,) areas of triangles with (n, 3, 3) corners [mm^2]."""
    return np.asarray(0.5 * np.linalg.norm(face_vectors(corners), axis=1))


def face_vectors(corners: FloatArray) -> FloatArray:
    """(n, 3) normals of triangles, outwards, as long as twice their area [mm^2]."""
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def enclosed_volume(corners: FloatArray) -> float:
    """Volume within a closed surface of triangles with (n, 3, 3) corners [mm^3] (divergence theorem)."""
    return float(np.einsum("ni,ni->", corners[:, 0], face_vectors(corners)) / 6.0)


def vertex_areas(n_points: int, faces: IntArray, corners: FloatArray) -> FloatArray:
    """(n_points,) a third of the areas of the triangles at each point [mm^2]."""
    shares = np.repeat(face_areas(corners) / 3.0, 3)
    return np.bincount(faces.ravel(), shares, n_points).astype(np.float64)


def vertex_normals(n_points: int, faces: IntArray, corners: FloatArray) -> FloatArray:
    """(n_points, 3) unit normals, the means of those of the triangles around by area."""
    normals = np.zeros((n_points, 3))
    np.add.at(normals, faces.ravel(), np.repeat(face_vectors(corners), 3, axis=0))
    return np.asarray(normals / np.linalg.norm(normals, axis=1, keepdims=True))


def laplacian(n_points: int, faces: IntArray, corners: FloatArray) -> csr_array:
    """Stiffness of the Laplace-Beltrami operator by linear elements, positive semi-definite [-].

    Its off-diagonal entries are the cotangent weights, -(cot a + cot b) / 2 (Pinkall and Polthier 1993).
    """
    rows, cols, values = [], [], []
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        to_i, to_j = corners[:, i] - corners[:, k], corners[:, j] - corners[:, k]
        sine = np.linalg.norm(np.cross(to_i, to_j), axis=1)
        half_cotangent = 0.5 * np.einsum("ni,ni->n", to_i, to_j) / sine
        a, b = faces[:, i], faces[:, j]
        rows += [a, b, a, b]
        cols += [b, a, a, b]
        values += [-half_cotangent, -half_cotangent, half_cotangent, half_cotangent]
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(cols)))
    return csr_array(coo_array(entries, shape=(n_points, n_points)))


def mean_curvature(points: FloatArray, faces: IntArray, corners: FloatArray) -> FloatArray:
    """(n_points,) mean curvature [1/mm], positive where the surface bulges outwards: 1/R on a sphere.

    The Laplacian of the position is -2 H N (Meyer et al. 2003).
    """
    n = points.shape[0]
    pull = np.zeros_like(points)
    # corners, not points: a periodic surface is unwrapped
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        to_i, to_j = corners[:, i] - corners[:, k], corners[:, j] - corners[:, k]
        sine = np.linalg.norm(np.cross(to_i, to_j), axis=1)
        weight = (0.5 * np.einsum("ni,ni->n", to_i, to_j) / sine)[:, None] * (corners[:, i] - corners[:, j])
        np.add.at(pull, faces[:, i], weight)
        np.add.at(pull, faces[:, j], -weight)
    normals = vertex_normals(n, faces, corners)
    areas = vertex_areas(n, faces, corners)
    return np.asarray(np.einsum("ni,ni->n", pull, normals) / (2.0 * areas))


def roughness(
    points: FloatArray, faces: IntArray, corners: FloatArray, cutoff: float, origin: FloatArray | None = None
) -> FloatArray:
    """(n_points,) height above the smoothed surface, outwards [mm]; its mean over the surface is zero.

    The smoothed positions solve (M + t K) y = M x with the lumped areas M and the Laplacian K, so that a wave
    of length L keeps 1 / (1 + (cutoff / L)^2) of its height.

    Parameters
    ----------
    points, faces, corners
        As of `mean_curvature`.
    cutoff : float
        Wavelength of which one half is smoothed away [mm].
    origin : (n_points, 3) float array, optional
        What is taken from the positions of a periodic surface, which then are displacements.
    """
    n, areas = points.shape[0], vertex_areas(points.shape[0], faces, corners)
    mass = diags_array(areas)
    smoothing = splu((mass + (cutoff / (2.0 * np.pi)) ** 2 * laplacian(n, faces, corners)).tocsc())
    x = points if origin is None else points - origin
    rest = x - smoothing.solve(areas[:, None] * x)
    height = np.einsum("ni,ni->n", rest, vertex_normals(n, faces, corners))
    return np.asarray(height - areas @ height / areas.sum())


def sampled(corners: FloatArray, spacing: float) -> FloatArray:
    """(n, 3) points on triangles, no farther from each other than about a spacing [mm]."""
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    parts = np.maximum(np.ceil(longest / spacing).astype(np.int64), 1)
    found = []
    for n in np.unique(parts):
        i, j = (index.ravel() for index in np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij"))
        inside = i + j <= n
        weights = np.stack([n - i - j, i, j], axis=1)[inside] / n
        found.append(np.einsum("wk,fkd->fwd", weights, corners[parts == n]).reshape(-1, 3))
    return np.concatenate(found)
