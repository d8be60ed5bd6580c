"""Compiled arithmetic of one integration point.

Dimension and number of nodes are arguments; the loops of `gyrify.energy.kernels` pass constants, so that
everything here is inlined and unrolled. A file of plain functions, because only those are found again in
numba's cache by the next process.
"""

from __future__ import annotations

from gyrify.base.compiled import njit

# The functions below write into their last arguments; numba compiles them without annotations.
# mypy: disable-error-code="no-untyped-def"


@njit(cache=True, inline="always")
def deform(n_dim, n_nodes, u, cell, base, gradients, F):
    """F = base + sum_a u_a (x) g_a."""
    for i in range(n_dim):
        for j in range(n_dim):
            F[i, j] = base[i, j]
            for a in range(n_nodes):
                F[i, j] += u[cell[a], i] * gradients[a, j]


@njit(cache=True, inline="always")
def invert(n_dim, F, H):
    """Write H = F^{-T} where det F > 0; det F."""
    if n_dim == 2:
        det = F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0]
        if det > 0.0:
            H[0, 0], H[0, 1] = F[1, 1] / det, -F[1, 0] / det
            H[1, 0], H[1, 1] = -F[0, 1] / det, F[0, 0] / det
    else:
        for i in range(3):
            a, b = (i + 1) % 3, (i + 2) % 3
            for j in range(3):
                c, d = (j + 1) % 3, (j + 2) % 3
                H[i, j] = F[a, c] * F[b, d] - F[a, d] * F[b, c]
        det = F[0, 0] * H[0, 0] + F[0, 1] * H[0, 1] + F[0, 2] * H[0, 2]
        if det > 0.0:
            for i in range(3):
                for j in range(3):
                    H[i, j] /= det
    return det


@njit(cache=True)
def scatter_add(source, target, values, data):
    """data[target] += values[source], entry by entry."""
    for n in range(source.size):
        data[target[n]] += values[source[n]]
