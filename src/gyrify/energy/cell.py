"""Compiled arithmetic of one integration point.

Dimension and number of nodes are arguments; the loops of `gyrify.energy.kernels` pass constants, so that
everything here is inlined and unrolled. A file of plain functions, because only those are found again in
numba's cache by the next process.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from gyrify.energy.projection import project_to_psd

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


@njit(cache=True, inline="always")
def nodal_vectors(n_dim, n_nodes, F, H, gradients, f, h):
    """f_a = F g_a and h_a = H g_a."""
    for a in range(n_nodes):
        for i in range(n_dim):
            f[a, i], h[a, i] = 0.0, 0.0
            for j in range(n_dim):
                f[a, i] += F[i, j] * gradients[a, j]
                h[a, i] += H[i, j] * gradients[a, j]


@njit(cache=True, inline="always")
def add_forces(n_dim, n_nodes, f, h, moduli, weight, cell, gradient):
    """Add w P g_a to each node's force."""
    a_, b_, _, _, _ = moduli
    for a in range(n_nodes):
        for i in range(n_dim):
            gradient[cell[a], i] += weight * (a_ * f[a, i] + b_ * h[a, i])


@njit(cache=True, inline="always")
def add_matrix(n_dim, n_nodes, f, h, g, moduli, weight, position, values):
    """Add the exact cell matrix, its upper triangle in the order of numpy.triu_indices."""
    a_, b_, c_, d_, e_ = moduli
    entry = 0
    for a in range(n_nodes):
        for i in range(n_dim):
            for b in range(a, n_nodes):
                dot = 0.0
                for j in range(n_dim):
                    dot += g[a, j] * g[b, j]
                for k in range(i if b == a else 0, n_dim):
                    total = (
                        c_ * h[a, i] * h[b, k]
                        - b_ * h[b, i] * h[a, k]
                        + d_ * f[a, i] * f[b, k]
                        + e_ * (f[a, i] * h[b, k] + h[a, i] * f[b, k])
                    )
                    if i == k:
                        total += a_ * dot
                    values[position[entry]] += weight * total
                    entry += 1


@njit(cache=True)
def add_projected(n_dim, n_nodes, F, H, g, moduli, weight, position, values):
    """Add the cell matrix of the tangent without its negative eigenvalues."""
    a_, b_, c_, d_, e_ = moduli
    C = np.empty((n_dim * n_dim, n_dim * n_dim))
    for i in range(n_dim):
        for j in range(n_dim):
            for k in range(n_dim):
                for l in range(n_dim):
                    C[i * n_dim + j, k * n_dim + l] = (
                        c_ * H[i, j] * H[k, l]
                        - b_ * H[i, l] * H[k, j]
                        + d_ * F[i, j] * F[k, l]
                        + e_ * (F[i, j] * H[k, l] + H[i, j] * F[k, l])
                    )
        for j in range(n_dim):
            C[i * n_dim + j, i * n_dim + j] += a_
    project_to_psd(C)
    entry = 0
    for a in range(n_nodes):
        for i in range(n_dim):
            for b in range(a, n_nodes):
                for k in range(i if b == a else 0, n_dim):
                    total = 0.0
                    for j in range(n_dim):
                        for l in range(n_dim):
                            total += g[a, j] * C[i * n_dim + j, k * n_dim + l] * g[b, l]
                    values[position[entry]] += weight * total
                    entry += 1


@njit(cache=True, inline="always")
def step_to_inversion(F, D):
    """Smallest positive root of det(F + s D) = 0 in the plane, or 1 if that is smaller."""
    p = D[0, 0] * D[1, 1] - D[0, 1] * D[1, 0]
    q = F[0, 0] * D[1, 1] + F[1, 1] * D[0, 0] - F[0, 1] * D[1, 0] - F[1, 0] * D[0, 1]
    r = F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0]
    discriminant = q * q - 4.0 * p * r
    # 2 r / (sqrt - q) is the smallest positive root for every sign of p, without cancellation
    if discriminant >= 0.0 and np.sqrt(discriminant) > q:
        return min(1.0, 2.0 * r / (np.sqrt(discriminant) - q))
    return 1.0
