"""Compiled loops over cells, specialised for a dimension and a number of nodes.

The cell matrix needs no tangent tensor: with h_a = H g_a and f_a = F g_a of the shape-function gradients
g_a, every term of `gyrify.physics.isotropic` becomes a product of nodal vectors. Only where a projection
is asked for, and the tangent is indefinite, is it formed as a matrix.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numba import njit

from gyrify.energy.projection import project_to_psd
from gyrify.physics.isotropic import coefficients
from gyrify.physics.neo_hookean import density


class ElasticKernels(NamedTuple):
    """Compiled functions of one kind of simplex."""

    accumulate: Callable[..., float]
    largest_step: Callable[..., float]
    grow: Callable[..., None]
    volume_ratio: Callable[..., None]


@cache
def elastic_kernels(n_dim: int, n_nodes: int) -> ElasticKernels:
    """Kernels for cells of ``n_nodes`` nodes in ``n_dim`` dimensions, compiled at their first call."""
    deform, invert, largest_step = _geometry(n_dim, n_nodes)
    add_forces, add_matrix, add_projected = _derivatives(n_dim, n_nodes)

    @njit(cache=True)
    def accumulate(  # type: ignore[no-untyped-def]
        u,
        cells,
        base,
        gradients,
        f33,
        mu,
        kappa,
        pressure,
        weight,
        order,
        project_psd,
        position,
        gradient,
        values,
    ):
        """Add every cell's energy, forces and matrix; infinite as soon as one cell is inverted."""
        F, H = np.empty((n_dim, n_dim)), np.empty((n_dim, n_dim))
        f, h = np.empty((n_nodes, n_dim)), np.empty((n_nodes, n_dim))
        value = 0.0
        for c in range(cells.shape[0]):
            deform(u, cells[c], base[c], gradients[c], F)
            det = invert(F, H)
            if not det > 0.0:
                return np.inf
            J, I1 = det * f33[c], f33[c] * f33[c] if n_dim == 2 else 0.0
            for i in range(n_dim):
                for j in range(n_dim):
                    I1 += F[i, j] * F[i, j]
            value += weight[c] * density(I1, J, mu[c], kappa[c])
            if order == 0:
                continue
            moduli = coefficients(I1, J, mu[c], kappa[c], pressure[c])
            for a in range(n_nodes):
                for i in range(n_dim):
                    f[a, i], h[a, i] = 0.0, 0.0
                    for j in range(n_dim):
                        f[a, i] += F[i, j] * gradients[c, a, j]
                        h[a, i] += H[i, j] * gradients[c, a, j]
            add_forces(f, h, moduli, weight[c], cells[c], gradient)
            if order == 2 and project_psd:
                add_projected(F, H, gradients[c], moduli, weight[c], position[c], values)
            elif order == 2:
                add_matrix(f, h, gradients[c], moduli, weight[c], position[c], values)
        return value

    return ElasticKernels(accumulate, largest_step, *_preparation(n_dim, n_nodes, deform, invert))


def _geometry(n_dim: int, n_nodes: int) -> tuple[Any, Any, Any]:
    """Deformation gradient, its inverse transpose, and the step to the first inverted cell."""

    @njit(cache=True, inline="always")
    def deform(u, cell, base, gradients, F):  # type: ignore[no-untyped-def]
        for i in range(n_dim):
            for j in range(n_dim):
                F[i, j] = base[i, j]
                for a in range(n_nodes):
                    F[i, j] += u[cell[a], i] * gradients[a, j]

    @njit(cache=True, inline="always")
    def invert_plane(F, H):  # type: ignore[no-untyped-def]
        det = F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0]
        if det > 0.0:
            H[0, 0], H[0, 1] = F[1, 1] / det, -F[1, 0] / det
            H[1, 0], H[1, 1] = -F[0, 1] / det, F[0, 0] / det
        return det

    @njit(cache=True, inline="always")
    def invert_space(F, H):  # type: ignore[no-untyped-def]
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
    def largest_step(u, du, cells, base, gradients):  # type: ignore[no-untyped-def]
        """Smallest positive root over the cells of det(F + s D) = 0, at most 1.

        In the plane the determinant is a quadratic in s with an exact root; in space the step is halved
        until no cell is inverted at its end.
        """
        F, D, H = np.empty((n_dim, n_dim)), np.empty((n_dim, n_dim)), np.empty((n_dim, n_dim))
        zero = np.zeros((n_dim, n_dim))
        largest = 1.0
        for c in range(cells.shape[0]):
            deform(u, cells[c], base[c], gradients[c], F)
            deform(du, cells[c], zero, gradients[c], D)
            if n_dim == 2:
                p = D[0, 0] * D[1, 1] - D[0, 1] * D[1, 0]
                q = F[0, 0] * D[1, 1] + F[1, 1] * D[0, 0] - F[0, 1] * D[1, 0] - F[1, 0] * D[0, 1]
                r = F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0]
                discriminant = q * q - 4.0 * p * r
                # 2 r / (sqrt - q) is the smallest positive root for every sign of p, without cancellation
                if discriminant >= 0.0 and np.sqrt(discriminant) > q:
                    largest = min(largest, 2.0 * r / (np.sqrt(discriminant) - q))
            else:
                while largest > 1e-12 and not invert(F + largest * D, H) > 0.0:
                    largest *= 0.5
        return largest

    invert = invert_plane if n_dim == 2 else invert_space
    return deform, invert, largest_step


def _preparation(n_dim: int, n_nodes: int, deform: Any, invert: Any) -> tuple[Any, Any]:
    """Growth of the reference cells, and their volume ratio in a state."""

    @njit(cache=True)
    def grow(F_g, gradients, base, grown, det):  # type: ignore[no-untyped-def]
        """Write F_g^{-1}, the gradients with respect to the grown cell, and det F_g in the plane."""
        H = np.empty((n_dim, n_dim))
        for c in range(F_g.shape[0]):
            det[c] = invert(F_g[c], H)
            for i in range(n_dim):
                for j in range(n_dim):
                    base[c, i, j] = H[j, i]
            for a in range(n_nodes):
                for j in range(n_dim):
                    grown[c, a, j] = 0.0
                    for i in range(n_dim):
                        grown[c, a, j] += gradients[c, a, i] * base[c, i, j]

    @njit(cache=True)
    def volume_ratio(u, cells, gradients, ratio):  # type: ignore[no-untyped-def]
        """Write det(I + grad u)."""
        F, H, identity = np.empty((n_dim, n_dim)), np.empty((n_dim, n_dim)), np.eye(n_dim)
        for c in range(cells.shape[0]):
            deform(u, cells[c], identity, gradients[c], F)
            ratio[c] = invert(F, H)

    return grow, volume_ratio


def _derivatives(n_dim: int, n_nodes: int) -> tuple[Any, Any, Any]:
    """Nodal forces, the exact cell matrix, and the projected one; matrices as upper triangles."""

    @njit(cache=True, inline="always")
    def add_forces(f, h, moduli, weight, cell, gradient):  # type: ignore[no-untyped-def]
        a_, b_, _, _, _ = moduli
        for a in range(n_nodes):
            for i in range(n_dim):
                gradient[cell[a], i] += weight * (a_ * f[a, i] + b_ * h[a, i])

    @njit(cache=True, inline="always")
    def add_matrix(f, h, g, moduli, weight, position, values):  # type: ignore[no-untyped-def]
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
    def add_projected(F, H, g, moduli, weight, position, values):  # type: ignore[no-untyped-def]
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

    return add_forces, add_matrix, add_projected
