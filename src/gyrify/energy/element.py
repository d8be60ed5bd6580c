"""Reference elements: slopes of the shape functions at the integration points."""

from __future__ import annotations

from typing import Final

import numpy as np

from gyrify.energy.term import FloatArray

# Ends of the edges of a quadratic simplex, by dimension, in the order of VTK.
EDGES: Final = {2: ((0, 1), (1, 2), (2, 0)), 3: ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))}
# Volume coordinates of an integration point, and what that of the nearest corner has more.
_COORDINATES: Final = {2: (1.0 / 6.0, 0.5), 3: (0.25 - np.sqrt(5.0) / 20.0, np.sqrt(5.0) / 5.0)}


def reference_element(n_nodes: int, n_dim: int) -> tuple[FloatArray, FloatArray]:
    """Slopes and weights of a simplex with corners at the origin and the unit vectors.

    Parameters
    ----------
    n_nodes : int
        d + 1 for a linear simplex, 6 for a quadratic triangle (corners, then the nodes between 01, 12, 20),
        10 for a quadratic tetrahedron (corners, then between 01, 12, 20, 03, 13, 23).
    n_dim : int
        Dimension d.

    Returns
    -------
    slopes : (n_q, n_nodes, n_dim) float array
        dN_a / dxi at the integration points.
    weights : (n_q,) float array
        Weights; their sum is the volume 1/d! of the simplex.
    """
    n_corners, volume = n_dim + 1, 1.0 / np.prod(np.arange(1, n_dim + 1))
    slope = np.concatenate([-np.ones((1, n_dim)), np.eye(n_dim)])
    if n_nodes == n_corners:
        return slope[None], np.array([volume])
    edges = EDGES.get(n_dim, ())
    if n_nodes != n_corners + len(edges):
        raise ValueError(f"no element with {n_nodes} nodes in {n_dim} dimensions")
    # degree 2, enough for the optimal order; volume coordinates have constant slopes
    L = _integration_points(n_dim)
    corners = (4.0 * L - 1.0)[:, :, None] * slope
    a, b = np.array(edges).T
    between = 4.0 * (L[:, a, None] * slope[b] + L[:, b, None] * slope[a])
    return np.concatenate([corners, between], axis=1), np.full(n_corners, volume / n_corners)


def quadratic_values(n_dim: int) -> FloatArray:
    """(n_q, n_nodes) values of the shape functions of a quadratic simplex at its integration points."""
    L = _integration_points(n_dim)
    a, b = np.array(EDGES[n_dim]).T
    return np.concatenate([L * (2.0 * L - 1.0), 4.0 * L[:, a] * L[:, b]], axis=1)


def _integration_points(n_dim: int) -> FloatArray:
    """(n_q, n_dim + 1) volume coordinates of the integration points of a quadratic simplex."""
    far, more = _COORDINATES[n_dim]
    return np.asarray(np.full((n_dim + 1, n_dim + 1), far) + more * np.eye(n_dim + 1))
