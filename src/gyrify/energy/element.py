"""Reference elements: slopes of the shape functions at the integration points."""

from __future__ import annotations

import numpy as np

from gyrify.energy.term import FloatArray


def reference_element(n_nodes: int, n_dim: int) -> tuple[FloatArray, FloatArray]:
    """Slopes and weights of a simplex with corners at the origin and the unit vectors.

    Parameters
    ----------
    n_nodes : int
        d + 1 for a linear simplex, 6 for a quadratic triangle (corners, then the nodes between 01, 12, 20).
    n_dim : int
        Dimension d.

    Returns
    -------
    slopes : (n_q, n_nodes, n_dim) float array
        dN_a / dxi at the integration points.
    weights : (n_q,) float array
        Weights; their sum is the volume 1/d! of the simplex.
    """
    if n_nodes == n_dim + 1:
        slopes = np.concatenate([-np.ones((1, n_dim)), np.eye(n_dim)])
        return slopes[None], np.array([1.0 / np.prod(np.arange(1, n_dim + 1))])
    if (n_nodes, n_dim) != (6, 2):
        raise ValueError(f"no element with {n_nodes} nodes in {n_dim} dimensions")
    # degree 2, enough for the optimal order; area coordinates and their constant slopes
    area = np.full((3, 3), 1.0 / 6.0) + 0.5 * np.eye(3)
    slope = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
    after = [1, 2, 0]
    corners = (4.0 * area - 1.0)[:, :, None] * slope
    between = 4.0 * (area[:, :, None] * slope[after] + area[:, after, None] * slope)
    return np.concatenate([corners, between], axis=1), np.full(3, 1.0 / 6.0)
