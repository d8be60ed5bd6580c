"""Compiled arithmetic of a batch of Kelvin-Voigt dashpots; arrays as in `gyrify.energy.batch`.

With S the weighed strain rate, f_a = F g_a and s_a = S g_a, the force on node a is F s_a, and the cell matrix
is w/2 (f_b (x) f_a + (g_a . g_b) F F^T) + (g_a . s_b) I.
"""

from __future__ import annotations

import numpy as np

from gyrify.base.compiled import njit
from gyrify.energy.projection import project_to_psd

# The functions below write into their last arguments; numba compiles them without annotations.
# mypy: disable-error-code="no-untyped-def"


@njit(cache=True)
def strains(F, E):
    """E = (F^T F - I) / 2 of matrices with the point as the first axis."""
    n_dim = F.shape[1]
    for c in range(F.shape[0]):
        for i in range(n_dim):
            for j in range(n_dim):
                total = -1.0 if i == j else 0.0
                for k in range(n_dim):
                    total += F[c, k, i] * F[c, k, j]
                E[c, i, j] = 0.5 * total


@njit(cache=True, inline="always")
def subtract_from_strain(n_dim, n, F, E):
    """Replace the strain E at the start by the change (F^T F - I) / 2 - E."""
    for i in range(n_dim):
        for j in range(n_dim):
            for l in range(n):
                total = -1.0 if i == j else 0.0
                for k in range(n_dim):
                    total += F[k, i, l] * F[k, j, l]
                E[i, j, l] = 0.5 * total - E[i, j, l]


@njit(cache=True, inline="always")
def weigh(n_dim, first, n, weight, E, entries):
    """Sum of w/2 E : E, and w E in place of E."""
    entries[:n] = 0.0
    for i in range(n_dim):
        for j in range(n_dim):
            for l in range(n):
                entries[l] += 0.5 * weight[first + l] * E[i, j, l] * E[i, j, l]
                E[i, j, l] *= weight[first + l]
    total = 0.0
    for l in range(n):
        total += entries[l]
    return total


@njit(cache=True, inline="always")
def add_dashpot_forces(n_dim, n_nodes, first, n, F, s, cells, gradient):
    """Add F s_a to each node's force."""
    for a in range(n_nodes):
        for i in range(n_dim):
            for l in range(n):
                total = 0.0
                for j in range(n_dim):
                    total += F[i, j, l] * s[a, j, l]
                gradient[cells[first + l, a], i] += total


@njit(cache=True)
def project_stresses(n_dim, n, S):
    """Each stress without its negative part."""
    A = np.empty((n_dim, n_dim))
    for l in range(n):
        A[:] = S[:, :, l]
        project_to_psd(A)
        S[:, :, l] = A


@njit(cache=True, inline="always")
def squares(n_dim, n, F, B):
    """B = F F^T."""
    for i in range(n_dim):
        for k in range(n_dim):
            for l in range(n):
                B[i, k, l] = 0.0
                for j in range(n_dim):
                    B[i, k, l] += F[i, j, l] * F[k, j, l]


@njit(cache=True, inline="always")
def add_dashpot_matrices(n_dim, n_nodes, first, n, B, f, g, s, weight, position, entries, values):
    """Add the cell matrices, their upper triangles in the order of numpy.triu_indices."""
    entry = 0
    for a in range(n_nodes):
        for i in range(n_dim):
            for b in range(a, n_nodes):
                for k in range(i if b == a else 0, n_dim):
                    for l in range(n):
                        product = 0.0
                        stiffening = 0.0
                        for j in range(n_dim):
                            product += g[a, j, l] * g[b, j, l]
                            stiffening += g[a, j, l] * s[b, j, l]
                        total = product * B[i, k, l] + f[a, k, l] * f[b, i, l]
                        entries[l] = 0.5 * weight[first + l] * total
                        if i == k:
                            entries[l] += stiffening
                    for l in range(n):
                        values[position[first + l, entry]] += entries[l]
                    entry += 1
