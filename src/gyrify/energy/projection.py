"""Projection of small symmetric matrices onto the positive semi-definite ones."""

from __future__ import annotations

import numpy as np

from gyrify.base.compiled import njit


@njit(cache=True)
def is_positive_definite(A):  # type: ignore[no-untyped-def]
    """Whether a symmetric matrix has positive pivots (Cholesky without storing the factor twice)."""
    n = A.shape[0]
    L = np.empty((n, n))
    for j in range(n):
        pivot = A[j, j]
        for k in range(j):
            pivot -= L[j, k] * L[j, k]
        if not pivot > 0.0:
            return False
        L[j, j] = np.sqrt(pivot)
        for i in range(j + 1, n):
            entry = A[i, j]
            for k in range(j):
                entry -= L[i, k] * L[j, k]
            L[i, j] = entry / L[j, j]
    return True


@njit(cache=True)
def project_to_psd(A):  # type: ignore[no-untyped-def]
    """Replace a symmetric matrix, in place, by the nearest one without negative eigenvalues."""
    if is_positive_definite(A):
        return
    eigenvalues, vectors = np.linalg.eigh(A)
    n = A.shape[0]
    for i in range(n):
        for j in range(n):
            entry = 0.0
            for k in range(n):
                if eigenvalues[k] > 0.0:
                    entry += eigenvalues[k] * vectors[i, k] * vectors[j, k]
            A[i, j] = entry


@njit(cache=True)
def project_all(blocks):  # type: ignore[no-untyped-def]
    """Project each matrix of a row of them, in place."""
    for n in range(blocks.shape[0]):
        project_to_psd(blocks[n])
