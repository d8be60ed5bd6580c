"""Compiled energy of materials that are given by their principal stretches, point by point."""

from __future__ import annotations

from typing import Any

import numpy as np

from gyrify.base.compiled import njit
from gyrify.energy.cell import deform
from gyrify.energy.projection import project_to_psd
from gyrify.energy.tangents import add_matrix
from gyrify.physics.materials.dispatch import density, derivatives
from gyrify.physics.stress import EQUAL

# numba compiles what follows without annotations.
# mypy: disable-error-code="no-untyped-def, no-untyped-call"


def principal_kernel(n_dim: int, n_nodes: int, axial: int, material: int, digest: int) -> Any:
    """Energy, forces and matrices of all points; as `gyrify.energy.kernels` has them by invariants."""

    @njit(cache=True, error_model="numpy")
    def accumulate(
        u,
        cells,
        base,
        gradients,
        f33,
        slope,
        parameters,
        pressure,
        weight,
        order,
        project_psd,
        position,
        gradient,
        values,
    ):
        """Add every point's energy, forces and matrix; infinite as soon as one is inverted."""
        F, s = np.empty((n_dim, n_dim)), np.ones(3 + 0 * digest)
        n, N = np.empty((n_dim, n_dim)), np.empty((n_dim, n_dim))
        W, WW = np.empty(3), np.empty((3, 3))
        C = np.empty((n_dim * n_dim + axial, n_dim * n_dim + axial))
        value = 0.0
        for c in range(cells.shape[0]):
            deform(n_dim, n_nodes, u, cells[c], base[c], gradients[c], F)
            s[2] = f33[c]
            if not decompose(n_dim, F, s, n, N):
                return np.inf
            value += weight[c] * density(material, s[0], s[1], s[2], parameters, c)
            if order == 0:
                continue
            found = derivatives(material, s[0], s[1], s[2], parameters, c)
            weigh(s, found, pressure[c], weight[c], W, WW)
            add_force(n_dim, n_nodes, n, N, W, gradients[c], cells[c], gradient)
            if axial:
                gradient[-1, 0] += slope[c] * W[2]
            if order == 2:
                tangent(n_dim, axial, s, n, N, W, WW, C)
                if project_psd:
                    project_to_psd(C)
                slope_here = slope[c] if axial else 0.0
                add_matrix(n_dim, n_nodes, axial, C, gradients[c], slope_here, position[c], values)
        return value

    return accumulate


@njit(cache=True, error_model="numpy")
def decompose(n_dim, F, s, n, N):
    """Principal stretches s and directions n (space) and N (tissue), as columns; false where det F <= 0."""
    det = F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0] if n_dim == 2 else np.linalg.det(F)
    if not det > 0.0:
        return False
    squared, vectors = np.linalg.eigh(F.T @ F)
    for a in range(n_dim):
        s[a] = np.sqrt(squared[a])
        if not s[a] > 0.0:
            return False
        for i in range(n_dim):
            N[i, a] = vectors[i, a]
            total = 0.0
            for j in range(n_dim):
                total += F[i, j] * vectors[j, a]
            n[i, a] = total / s[a]
    return True


@njit(cache=True, inline="always", error_model="numpy")
def weigh(s, found, pressure, weight, W, WW):
    """First and second derivatives by the stretches, weighed, with a pressure added to dW/dJ."""
    J = s[0] * s[1] * s[2]
    W[0], W[1], W[2] = found[0], found[1], found[2]
    WW[0, 0], WW[1, 1], WW[2, 2] = found[3], found[4], found[5]
    WW[0, 1], WW[0, 2], WW[1, 2] = found[6], found[7], found[8]
    for i in range(3):
        W[i] = weight * (W[i] + pressure * J / s[i])
        WW[i, i] *= weight
        for j in range(i + 1, 3):
            WW[i, j] = weight * (WW[i, j] + pressure * J / (s[i] * s[j]))
            WW[j, i] = WW[i, j]


@njit(cache=True)
def add_force(n_dim, n_nodes, n, N, W, gradients, cell, gradient):
    """Add P g_a to each node's force."""
    for i in range(n_dim):
        for j in range(n_dim):
            stress = 0.0
            for a in range(n_dim):
                stress += W[a] * n[i, a] * N[j, a]
            for b in range(n_nodes):
                gradient[cell[b], i] += stress * gradients[b, j]


@njit(cache=True, error_model="numpy")
def tangent(n_dim, axial, s, n, N, W, WW, C):
    """Tangent as a matrix over (i, j), (k, m), with the row and column of F33 after it."""
    size = n_dim * n_dim
    C[:] = 0.0
    for a in range(n_dim):
        for b in range(n_dim):
            along, across = 0.0, 0.0
            if a != b:
                apart = s[a] * s[a] - s[b] * s[b]
                if abs(apart) > EQUAL * (s[a] * s[a] + s[b] * s[b]):
                    along, across = (s[a] * W[a] - s[b] * W[b]) / apart, (s[b] * W[a] - s[a] * W[b]) / apart
                else:
                    along = 0.5 * (WW[a, a] - WW[a, b] + W[a] / s[a])
                    across = 0.5 * (WW[a, a] - WW[a, b] - W[a] / s[a])
            for x in range(size):
                i, j = x // n_dim, x % n_dim
                for y in range(size):
                    k, m = y // n_dim, y % n_dim
                    C[x, y] += WW[a, b] * n[i, a] * N[j, a] * n[k, b] * N[m, b]
                    if a != b:
                        C[x, y] += along * n[i, a] * N[j, b] * n[k, a] * N[m, b]
                        C[x, y] += across * n[i, a] * N[j, b] * n[k, b] * N[m, a]
    if axial:
        for x in range(size):
            for a in range(n_dim):
                C[size, x] += WW[a, 2] * n[x // n_dim, a] * N[x % n_dim, a]
            C[x, size] = C[size, x]
        C[size, size] = WW[2, 2]
