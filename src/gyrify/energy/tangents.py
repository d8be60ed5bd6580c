"""Compiled tangents as matrices, formed only where a projection onto semi-definite ones is asked for."""

from __future__ import annotations

import numpy as np

from gyrify.base.compiled import njit
from gyrify.energy.batch import axial_modulus
from gyrify.energy.projection import project_to_psd

# The functions below write into their last arguments; numba compiles them without annotations.
# mypy: disable-error-code="no-untyped-def"


@njit(cache=True)
def add_projected(n_dim, n_nodes, axial, first, n, F, H, g, f33, slope, moduli, position, values):
    """Add the cell matrices of the tangents without their negative eigenvalues."""
    C = np.empty((n_dim * n_dim + axial, n_dim * n_dim + axial))
    for l in range(n):
        tangent(n_dim, l, F, H, moduli, C)
        if axial:
            axial_tangent(n_dim, l, F, H, f33[first + l], moduli, C)
        project_to_psd(C)
        slope_here = slope[first + l] if axial else 0.0
        add_matrix(n_dim, n_nodes, axial, C, g[:, :, l], slope_here, position[first + l], values)


@njit(cache=True)
def add_matrix(n_dim, n_nodes, axial, C, g, slope, position, values):
    """Add the cell matrix of one point of a tangent over (i, j), (k, m), its upper triangle row by row."""
    entry = 0
    for a in range(n_nodes):
        for i in range(n_dim):
            for b in range(a, n_nodes):
                for k in range(i if b == a else 0, n_dim):
                    total = 0.0
                    for j in range(n_dim):
                        for m in range(n_dim):
                            total += g[a, j] * C[i * n_dim + j, k * n_dim + m] * g[b, m]
                    values[position[entry]] += total
                    entry += 1
    if axial:
        add_axial_column(n_dim, n_nodes, C, g, slope, position[entry:], values)


@njit(cache=True)
def add_axial_column(n_dim, n_nodes, C, g, slope, position, values):
    """Add the column of the axial unknown to the matrix of one point."""
    last = n_dim * n_dim
    for a in range(n_nodes):
        for i in range(n_dim):
            total = 0.0
            for j in range(n_dim):
                total += C[last, i * n_dim + j] * g[a, j]
            values[position[a * n_dim + i]] += slope * total
    values[position[n_nodes * n_dim]] += slope * slope * C[last, last]


@njit(cache=True)
def tangent(n_dim, l, F, H, moduli, C):
    """Weighed tangent of one point as a matrix over (i, j), (k, m)."""
    for i in range(n_dim):
        for j in range(n_dim):
            for k in range(n_dim):
                for m in range(n_dim):
                    C[i * n_dim + j, k * n_dim + m] = (
                        moduli[2, l] * H[i, j, l] * H[k, m, l]
                        - moduli[1, l] * H[i, m, l] * H[k, j, l]
                        + moduli[3, l] * F[i, j, l] * F[k, m, l]
                        + moduli[4, l] * (F[i, j, l] * H[k, m, l] + H[i, j, l] * F[k, m, l])
                    )
            C[i * n_dim + j, i * n_dim + j] += moduli[0, l]


@njit(cache=True, error_model="numpy")
def axial_tangent(n_dim, l, F, H, z, moduli, C):
    """Last row and column of the same, those of F33 = z."""
    last = n_dim * n_dim
    for i in range(n_dim):
        for j in range(n_dim):
            C[last, i * n_dim + j] = (
                moduli[2, l] * H[i, j, l] / z
                + moduli[3, l] * F[i, j, l] * z
                + moduli[4, l] * (F[i, j, l] / z + H[i, j, l] * z)
            )
            C[i * n_dim + j, last] = C[last, i * n_dim + j]
    C[last, last] = axial_modulus(l, z, moduli)
