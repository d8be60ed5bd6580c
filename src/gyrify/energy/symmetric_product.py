"""Compiled products of a symmetric matrix of three by three blocks, of which the upper ones are kept."""

from __future__ import annotations

import numpy as np

from gyrify.base.compiled import njit

# Determinant of a block over that of its diagonal entries below which it counts as singular, not positive.
SINGULAR = 1e-12


@njit(cache=True)
def multiply(indptr, indices, blocks, x, y):  # type: ignore[no-untyped-def]
    """y += A x of a symmetric matrix whose upper blocks are given."""
    for i in range(indptr.size - 1):
        a, b, c = 0.0, 0.0, 0.0
        u, v, w = x[3 * i], x[3 * i + 1], x[3 * i + 2]
        for k in range(indptr[i], indptr[i + 1]):
            j = 3 * indices[k]
            p, q, r = x[j], x[j + 1], x[j + 2]
            a += blocks[k, 0, 0] * p + blocks[k, 0, 1] * q + blocks[k, 0, 2] * r
            b += blocks[k, 1, 0] * p + blocks[k, 1, 1] * q + blocks[k, 1, 2] * r
            c += blocks[k, 2, 0] * p + blocks[k, 2, 1] * q + blocks[k, 2, 2] * r
            if j != 3 * i:
                y[j] += blocks[k, 0, 0] * u + blocks[k, 1, 0] * v + blocks[k, 2, 0] * w
                y[j + 1] += blocks[k, 0, 1] * u + blocks[k, 1, 1] * v + blocks[k, 2, 1] * w
                y[j + 2] += blocks[k, 0, 2] * u + blocks[k, 1, 2] * v + blocks[k, 2, 2] * w
        y[3 * i] += a
        y[3 * i + 1] += b
        y[3 * i + 2] += c


@njit(cache=True)
def multiply_blocks(blocks, x, y):  # type: ignore[no-untyped-def]
    """y = A x of a matrix that has blocks on its diagonal alone."""
    for i in range(blocks.shape[0]):
        p, q, r = x[3 * i], x[3 * i + 1], x[3 * i + 2]
        for a in range(3):
            y[3 * i + a] = blocks[i, a, 0] * p + blocks[i, a, 1] * q + blocks[i, a, 2] * r


@njit(cache=True)
def invert_positive(blocks, inverse):  # type: ignore[no-untyped-def]
    """Write the inverses of symmetric blocks that are plainly positive definite; which ones are."""
    is_positive = np.zeros(blocks.shape[0], dtype=np.bool_)
    for i in range(blocks.shape[0]):
        a, b, c = blocks[i, 0, 0], blocks[i, 0, 1], blocks[i, 0, 2]
        d, e, f = blocks[i, 1, 1], blocks[i, 1, 2], blocks[i, 2, 2]
        p, q, r = d * f - e * e, c * e - b * f, b * e - c * d
        det = a * p + b * q + c * r
        if not (a > 0.0 and a * d - b * b > 0.0 and det > SINGULAR * a * d * f):
            continue
        is_positive[i] = True
        inverse[i, 0, 0], inverse[i, 1, 1], inverse[i, 2, 2] = (
            p / det,
            (a * f - c * c) / det,
            (a * d - b * b) / det,
        )
        inverse[i, 0, 1] = inverse[i, 1, 0] = q / det
        inverse[i, 0, 2] = inverse[i, 2, 0] = r / det
        inverse[i, 1, 2] = inverse[i, 2, 1] = (b * c - a * e) / det
    return is_positive
