"""Compiled arithmetic of a batch of integration points, the last axis of every array.

Inner loops run over the points of the batch, so that the compiler makes vector instructions of them. As in
`gyrify.energy.cell` dimension and number of nodes are arguments for which the callers pass constants. The
cell matrix needs no tangent tensor: with h_a = H g_a and f_a = F g_a of the shape-function gradients g_a,
every term of `gyrify.physics.stress` becomes a product of nodal vectors.
"""

from __future__ import annotations

import numpy as np

from gyrify.base.compiled import njit
from gyrify.physics.materials.dispatch import density
from gyrify.physics.stress import coefficients

# The functions below write into their last arguments; numba compiles them without annotations.
# mypy: disable-error-code="no-untyped-def, no-untyped-call"

# Points of a batch: enough for long loops, few enough to stay in the first cache.
BATCH = 64
# Part of a step by which a place next to an inversion is missed.
ROOT = 1e-6


@njit(cache=True, inline="always")
def gather(n_dim, n_nodes, first, n, u, cells, x):
    """Rows of ``u`` at the nodes of ``n`` points from ``first``."""
    for l in range(n):
        for a in range(n_nodes):
            for i in range(n_dim):
                x[a, i, l] = u[cells[first + l, a], i]


@njit(cache=True, inline="always")
def load(n_rows, n_columns, first, n, matrices, M):
    """Matrices of ``n`` points from ``first``, given with the point as the first axis."""
    for l in range(n):
        for i in range(n_rows):
            for j in range(n_columns):
                M[i, j, l] = matrices[first + l, i, j]


@njit(cache=True, inline="always")
def store(n_rows, n_columns, first, n, M, matrices):
    """The reverse of `load`."""
    for l in range(n):
        for i in range(n_rows):
            for j in range(n_columns):
                matrices[first + l, i, j] = M[i, j, l]


@njit(cache=True, inline="always")
def add_products(n_dim, n_nodes, n, x, g, F):
    """Add sum_a x_a (x) g_a."""
    for i in range(n_dim):
        for j in range(n_dim):
            for a in range(n_nodes):
                for l in range(n):
                    F[i, j, l] += x[a, i, l] * g[a, j, l]


@njit(cache=True, inline="always", error_model="numpy")
def invert(n_dim, n, F, H, det):
    """H = F^{-T} and det F, and whether that is positive at every point."""
    for l in range(n):
        if n_dim == 2:
            det[l] = F[0, 0, l] * F[1, 1, l] - F[0, 1, l] * F[1, 0, l]
            inverse = 1.0 / det[l]
            H[0, 0, l], H[0, 1, l] = F[1, 1, l] * inverse, -F[1, 0, l] * inverse
            H[1, 0, l], H[1, 1, l] = -F[0, 1, l] * inverse, F[0, 0, l] * inverse
        else:
            for i in range(3):
                a, b = (i + 1) % 3, (i + 2) % 3
                for j in range(3):
                    c, d = (j + 1) % 3, (j + 2) % 3
                    H[i, j, l] = F[a, c, l] * F[b, d, l] - F[a, d, l] * F[b, c, l]
            det[l] = F[0, 0, l] * H[0, 0, l] + F[0, 1, l] * H[0, 1, l] + F[0, 2, l] * H[0, 2, l]
            for i in range(3):
                for j in range(3):
                    H[i, j, l] /= det[l]
    is_positive = True
    for l in range(n):
        is_positive &= det[l] > 0.0  # false for NaN, which must not pass for a volume
    return is_positive


@njit(cache=True, inline="always")
def step_to_inversion(n, F, D, steps):
    """Smallest positive root of det(F + s D) = 0 in the plane of each point, or 1; the smallest of all."""
    for l in range(n):
        p = D[0, 0, l] * D[1, 1, l] - D[0, 1, l] * D[1, 0, l]
        q = (
            F[0, 0, l] * D[1, 1, l]
            + F[1, 1, l] * D[0, 0, l]
            - F[0, 1, l] * D[1, 0, l]
            - F[1, 0, l] * D[0, 1, l]
        )
        r = F[0, 0, l] * F[1, 1, l] - F[0, 1, l] * F[1, 0, l]
        # 2 r / (sqrt - q) is the smallest positive root for every sign of p, without cancellation
        below = np.sqrt(max(q * q - 4.0 * p * r, 0.0)) - q
        has_root = q * q >= 4.0 * p * r and below > 0.0
        steps[l] = 2.0 * r / below if has_root else 1.0
    smallest = 1.0
    for l in range(n):
        smallest = min(smallest, steps[l])
    return smallest


@njit(cache=True)
def step_to_inversion_in_space(n, F, D, longest):
    """Step up to which det(F + s D) of every point, a cubic in s, stays positive; at most ``longest``."""
    for l in range(n):
        c0 = c1 = c2 = c3 = 0.0
        for i in range(3):
            a, b = (i + 1) % 3, (i + 2) % 3
            # the minors of the two rows after row i, of F, mixed, and of D
            for j in range(3):
                c, d = (j + 1) % 3, (j + 2) % 3
                f = F[a, c, l] * F[b, d, l] - F[a, d, l] * F[b, c, l]
                g = D[a, c, l] * D[b, d, l] - D[a, d, l] * D[b, c, l]
                if i == 0:
                    c0 += F[i, j, l] * f
                    c3 += D[i, j, l] * g
                c1 += D[i, j, l] * f
                c2 += F[i, j, l] * g
        longest = positive_until(c0, c1, c2, c3, longest)
    return longest


@njit(cache=True)
def positive_until(c0, c1, c2, c3, longest):
    """Up to where c0 + c1 s + c2 s^2 + c3 s^3 is known to be positive, from 0; at most ``longest``.

    It is between two places where all coefficients of its Bernstein form there are; next to a root these
    places come ever closer.
    """
    s, h = 0.0, longest
    while s < longest and h > ROOT * longest:
        h = min(h, longest - s)
        # value and slopes at s, over h
        p0, p1 = c0 + s * (c1 + s * (c2 + s * c3)), h * (c1 + s * (2.0 * c2 + s * 3.0 * c3))
        p2, p3 = h * h * (c2 + 3.0 * s * c3), h * h * h * c3
        b1, b2, b3 = p0 + p1 / 3.0, p0 + 2.0 * p1 / 3.0 + p2 / 3.0, p0 + p1 + p2 + p3
        if p0 > 0.0 and b1 > 0.0 and b2 > 0.0 and b3 > 0.0:
            s += h
            h *= 2.0
        else:
            h *= 0.5
    return s


@njit(cache=True, inline="always")
def invariants(n_dim, first, n, F, det, f33, I1, J, root):
    """I1 = tr F F^T, J = det F with the out-of-plane stretch, and its cube root."""
    for l in range(n):
        J[l], I1[l] = det[l] * f33[first + l], f33[first + l] * f33[first + l] if n_dim == 2 else 0.0
        for i in range(n_dim):
            for j in range(n_dim):
                I1[l] += F[i, j, l] * F[i, j, l]
    cube_roots(n, J, root)


@njit(cache=True, inline="always", error_model="numpy")
def cube_roots(n, x, root):
    """Cube roots of positive numbers to the last digit or two.

    Between 1/4 and 4 a cubic is within 2.2 % of them, and Halley's iteration, which has vector instructions
    where the library's function has none, makes that 7e-6 and then 3e-16.
    """
    is_near = True
    for l in range(n):
        is_near &= 0.25 <= x[l] <= 4.0
    for l in range(n):
        y = 0.48689039 + x[l] * (0.67161651 + x[l] * (0.02062432 * x[l] - 0.1808009))
        y *= (y * y * y + 2.0 * x[l]) / (2.0 * y * y * y + x[l])
        root[l] = y * (y * y * y + 2.0 * x[l]) / (2.0 * y * y * y + x[l])
    if not is_near:
        for l in range(n):
            root[l] = np.cbrt(x[l])


@njit(cache=True, inline="always")
def energy(material, first, n, I1, J, root, parameters, weight, entries):
    """Sum of w W."""
    for l in range(n):
        c = first + l
        entries[l] = weight[c] * density(material, I1[l], J[l], root[l], parameters, c)
    total = 0.0
    for l in range(n):
        total += entries[l]
    return total


@njit(cache=True, inline="always")
def weigh_moduli(material, first, n, I1, J, root, parameters, pressure, weight, moduli):
    """w times a, b, c, d, e of `gyrify.physics.stress`."""
    for l in range(n):
        c, w = first + l, weight[first + l]
        a_, b_, c_, d_, e_ = coefficients(material, I1[l], J[l], root[l], parameters, c, pressure[c])
        moduli[0, l], moduli[1, l], moduli[2, l] = w * a_, w * b_, w * c_
        moduli[3, l], moduli[4, l] = w * d_, w * e_


@njit(cache=True, inline="always")
def products(n_dim, n_nodes, n, M, g, m):
    """m_a = M g_a."""
    for a in range(n_nodes):
        for i in range(n_dim):
            for l in range(n):
                total = 0.0
                for j in range(n_dim):
                    total += M[i, j, l] * g[a, j, l]
                m[a, i, l] = total


@njit(cache=True, inline="always")
def add_forces(n_dim, n_nodes, first, n, f, h, moduli, cells, gradient):
    """Add w P g_a to each node's force."""
    for a in range(n_nodes):
        for i in range(n_dim):
            for l in range(n):
                gradient[cells[first + l, a], i] += moduli[0, l] * f[a, i, l] + moduli[1, l] * h[a, i, l]


@njit(cache=True, inline="always")
def add_matrices(n_dim, n_nodes, first, n, f, h, g, moduli, position, entries, values):
    """Add the exact cell matrices, their upper triangles in the order of numpy.triu_indices."""
    entry = 0
    for a in range(n_nodes):
        for i in range(n_dim):
            for b in range(a, n_nodes):
                for k in range(i if b == a else 0, n_dim):
                    for l in range(n):
                        total = (
                            moduli[2, l] * h[a, i, l] * h[b, k, l]
                            - moduli[1, l] * h[b, i, l] * h[a, k, l]
                            + moduli[3, l] * f[a, i, l] * f[b, k, l]
                            + moduli[4, l] * (f[a, i, l] * h[b, k, l] + h[a, i, l] * f[b, k, l])
                        )
                        if i == k:
                            for j in range(n_dim):
                                total += moduli[0, l] * g[a, j, l] * g[b, j, l]
                        entries[l] = total
                    for l in range(n):
                        values[position[first + l, entry]] += entries[l]
                    entry += 1


@njit(cache=True, inline="always", error_model="numpy")
def add_axial_force(first, n, f33, slope, moduli, gradient):
    """Add w P33 dF33/dw to the force on the axial unknown w, the first entry of the last row."""
    total = 0.0
    for l in range(n):
        z = f33[first + l]
        total += slope[first + l] * (moduli[0, l] * z + moduli[1, l] / z)
    gradient[-1, 0] += total


@njit(cache=True, inline="always", error_model="numpy")
def add_axial_matrices(n_dim, n_nodes, first, n, f33, slope, f, h, moduli, position, entries, values):
    """Add the exact column of the axial unknown, whose entries come after the triangle of the nodes."""
    size = n_dim * n_nodes
    column = size * (size + 1) // 2
    for a in range(n_nodes):
        for i in range(n_dim):
            for l in range(n):
                z = f33[first + l]
                along_h = moduli[2, l] / z + moduli[4, l] * z
                along_f = moduli[3, l] * z + moduli[4, l] / z
                entries[l] = slope[first + l] * (along_h * h[a, i, l] + along_f * f[a, i, l])
            for l in range(n):
                values[position[first + l, column + a * n_dim + i]] += entries[l]
    total = 0.0
    for l in range(n):
        total += slope[first + l] * slope[first + l] * axial_modulus(l, f33[first + l], moduli)
    values[position[first, column + size]] += total


@njit(cache=True, inline="always", error_model="numpy")
def axial_modulus(l, z, moduli):
    """dP33/dF33 of one point, weighed, at F33 = z."""
    return moduli[0, l] + (moduli[2, l] - moduli[1, l]) / (z * z) + moduli[3, l] * z * z + 2.0 * moduli[4, l]
