"""Compiled sums over patches of cells that share a volume ratio."""

from __future__ import annotations

import numpy as np

from gyrify.base.compiled import njit
from gyrify.energy.cell import invert

# The functions below write into their last arguments; numba compiles them without annotations.
# mypy: disable-error-code="no-untyped-def, no-untyped-call"


@njit(cache=True, error_model="numpy")
def volume_ratios(F, f33, J):
    """Write J = det F with the out-of-plane stretch."""
    n_dim = F.shape[1]
    H = np.empty((n_dim, n_dim))
    for c in range(F.shape[0]):
        J[c] = (invert(2, F[c], H) if n_dim == 2 else invert(3, F[c], H)) * f33[c]


@njit(cache=True, error_model="numpy")
def add_patch_products(F, gradients, weighted_J, stiffness, starts, order, local, corners, position, values):
    """Add stiffness v (x) v of every patch, v the gradient of its volume; the upper triangle alone.

    Those of patch p are ``order[starts[p] : starts[p + 1]]``; ``local`` are the numbers of their nodes in it,
    and its nodes end at ``corners[p + 1]``; ``position`` holds its entries, one patch after the other.
    """
    n_nodes, n_dim = gradients.shape[1], gradients.shape[2]
    H = np.empty((n_dim, n_dim))
    v = np.empty(n_dim * int(np.diff(corners).max()))
    entry = 0
    for p in range(stiffness.size):
        size = n_dim * (corners[p + 1] - corners[p])
        v[:size] = 0.0
        for c in order[starts[p] : starts[p + 1]]:
            if n_dim == 2:
                invert(2, F[c], H)
            else:
                invert(3, F[c], H)
            for a in range(n_nodes):
                for i in range(n_dim):
                    slope = 0.0
                    for j in range(n_dim):
                        slope += H[i, j] * gradients[c, a, j]
                    v[local[c, a] * n_dim + i] += weighted_J[c] * slope
        for i in range(size):
            for j in range(i, size):
                values[position[entry]] += stiffness[p] * v[i] * v[j]
                entry += 1
