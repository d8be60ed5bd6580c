"""Compiled product of a symmetric matrix of three by three blocks, of which the upper ones are kept."""

from __future__ import annotations

from gyrify.base.compiled import njit


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
