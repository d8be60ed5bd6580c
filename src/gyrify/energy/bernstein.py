r"""Compiled bounds of det(dx/dxi) over whole quadratic triangles.

The slopes of the map x(xi) are linear in the area coordinates L, so that its determinant is a quadratic form,

.. math:: \det \frac{\partial x}{\partial \xi} = \sum_{ij} L_i M_{ij} L_j ,

whose entries are the Bernstein coefficients: values at the corners on the diagonal, the others beside it. On
the triangle with corners V (rows of area coordinates) they are those of V M V^T. The least of them is a
lower bound, which subdivision drives to the least value with second order.
"""

from __future__ import annotations

import numpy as np

from gyrify.base.compiled import njit

# The functions below write into their last arguments; numba compiles them without annotations.
# mypy: disable-error-code="no-untyped-def"

# Subdivisions after which a sign counts as not proven: the bound is then within some 4^-10 of the cell.
DEPTH = 10
# A step is found to this part of itself; one that is shorter than the second number is none.
STEP_PRECISION, NO_STEP = 1e-3, 1e-10


@njit(cache=True)
def slopes(x, S):
    """dx/dxi (S[:, 0]) and dx/deta (S[:, 1]) at the corners of a triangle with nodes x; linear in between."""
    for i in range(2):
        # control points of the edges
        c01 = 2.0 * x[3, i] - 0.5 * (x[0, i] + x[1, i])
        c12 = 2.0 * x[4, i] - 0.5 * (x[1, i] + x[2, i])
        c20 = 2.0 * x[5, i] - 0.5 * (x[2, i] + x[0, i])
        S[0, 0, i], S[0, 1, i] = 2.0 * (c01 - x[0, i]), 2.0 * (c20 - x[0, i])
        S[1, 0, i], S[1, 1, i] = 2.0 * (x[1, i] - c01), 2.0 * (c12 - c01)
        S[2, 0, i], S[2, 1, i] = 2.0 * (c12 - c20), 2.0 * (x[2, i] - c20)


@njit(cache=True)
def add_form(factor, S, T, M):
    """Add the form of det(S_xi, T_eta), made symmetric, times a factor."""
    for i in range(3):
        for j in range(3):
            one = S[i, 0, 0] * T[j, 1, 1] - S[i, 0, 1] * T[j, 1, 0]
            other = S[j, 0, 0] * T[i, 1, 1] - S[j, 0, 1] * T[i, 1, 0]
            M[i, j] += 0.5 * factor * (one + other)


@njit(cache=True)
def restrict(M, V, C):
    """C = V M V^T: the coefficients on the triangle with corners V."""
    for i in range(3):
        for j in range(i, 3):
            total = 0.0
            for k in range(3):
                for l in range(3):
                    total += V[i, k] * M[k, l] * V[j, l]
            C[i, j] = C[j, i] = total


@njit(cache=True)
def subdivide(V, children):
    """The four triangles between the corners V and the middles of the edges."""
    for k in range(3):
        middle = (0.5 * (V[0, k] + V[1, k]), 0.5 * (V[1, k] + V[2, k]), 0.5 * (V[2, k] + V[0, k]))
        children[0, 0, k], children[0, 1, k], children[0, 2, k] = V[0, k], middle[0], middle[2]
        children[1, 0, k], children[1, 1, k], children[1, 2, k] = middle[0], V[1, k], middle[1]
        children[2, 0, k], children[2, 1, k], children[2, 2, k] = middle[2], middle[1], V[2, k]
        children[3, 0, k], children[3, 1, k], children[3, 2, k] = middle[0], middle[1], middle[2]


@njit(cache=True)
def are_coefficients_positive(forms):
    """Whether all Bernstein coefficients of some forms are positive, so that the forms are."""
    for f in range(forms.shape[0]):
        for i in range(3):
            for j in range(i, 3):
                if not forms[f, i, j] > 0.0:  # also for NaN
                    return False
    return True


@njit(cache=True)
def are_positive(forms):
    """Whether forms that are the Bernstein coefficients in time of one are proven positive on the triangle.

    The first and the last of them are values at the ends of the time; one form alone is its own value.
    """
    n = forms.shape[0]
    stack, levels = np.empty((3 * DEPTH + 4, 3, 3)), np.zeros(3 * DEPTH + 4, dtype=np.int64)
    inside = np.empty((n, 3, 3))
    stack[0] = np.eye(3)
    size = 1
    while size > 0:
        size -= 1
        V, level = stack[size].copy(), levels[size]
        for f in range(n):
            restrict(forms[f], V, inside[f])
        if are_coefficients_positive(inside):
            continue
        for i in range(3):
            if not (inside[0, i, i] > 0.0 and inside[n - 1, i, i] > 0.0):
                return False
        if level == DEPTH:
            return False
        subdivide(V, stack[size : size + 4])
        levels[size : size + 4] = level + 1
        size += 4
    return True


@njit(cache=True)
def place(c, u, cells, points, x):
    """Deformed nodes of a cell."""
    for a in range(6):
        for i in range(2):
            x[a, i] = points[c, a, i] + u[cells[c, a], i]


@njit(cache=True)
def first_inverted(u, cells, points):
    """Number of the first cell that is not proven positive all over, or -1."""
    x, S, M = np.empty((6, 2)), np.empty((3, 2, 2)), np.empty((1, 3, 3))
    for c in range(cells.shape[0]):
        place(c, u, cells, points, x)
        slopes(x, S)
        M[:] = 0.0
        add_form(1.0, S, S, M[0])
        if not are_coefficients_positive(M) and not are_positive(M):
            return c
    return -1


@njit(cache=True)
def least_coefficients(u, cells, points, least, mean):
    """Write the least Bernstein coefficient of each cell, and their mean, which is twice its area."""
    x, S, M = np.empty((6, 2)), np.empty((3, 2, 2)), np.empty((3, 3))
    for c in range(cells.shape[0]):
        place(c, u, cells, points, x)
        slopes(x, S)
        M[:] = 0.0
        add_form(1.0, S, S, M)
        least[c], mean[c] = np.inf, 0.0
        for i in range(3):
            for j in range(i, 3):
                least[c] = min(least[c], M[i, j])
                mean[c] += M[i, j] / 6.0


@njit(cache=True)
def in_time(M, start, span, forms):
    """Bernstein coefficients in time, from start to start + span, of M[0] + t M[1] + t^2 M[2]."""
    for i in range(3):
        for j in range(3):
            value = M[0, i, j] + start * (M[1, i, j] + start * M[2, i, j])
            slope = span * (M[1, i, j] + 2.0 * start * M[2, i, j])
            forms[0, i, j] = value
            forms[1, i, j] = value + 0.5 * slope
            forms[2, i, j] = value + slope + span * span * M[2, i, j]


@njit(cache=True)
def time_to_inversion(M, end, forms):
    """Time up to which, at most the end, a form that changes in time is proven positive."""
    start, span = 0.0, end
    while start < end:
        in_time(M, start, span, forms)
        if are_positive(forms):
            start = start + span
            span = min(span, end - start)
        else:
            span *= 0.5
            if span < STEP_PRECISION * start or span < NO_STEP:
                return start
    return end


@njit(cache=True)
def largest_step(u, du, cells, points):
    """Largest fraction of du, at most 1, up to which every cell is proven positive all over."""
    x, S, T = np.empty((6, 2)), np.empty((3, 2, 2)), np.empty((3, 2, 2))
    M, forms = np.empty((3, 3, 3)), np.empty((3, 3, 3))
    rest = np.zeros((cells.shape[0], 6, 2))
    largest = 1.0
    for c in range(cells.shape[0]):
        place(c, u, cells, points, x)
        slopes(x, S)
        place(c, du, cells, rest, x)
        slopes(x, T)
        M[:] = 0.0
        add_form(1.0, S, S, M[0])
        add_form(1.0, S, T, M[1])
        add_form(1.0, T, S, M[1])
        add_form(1.0, T, T, M[2])
        in_time(M, 0.0, largest, forms)
        if not are_coefficients_positive(forms):
            largest = time_to_inversion(M, largest, forms)
    return largest


@njit(cache=True)
def least_ratio(P, Q, tolerance):
    """Lower bound, within a tolerance, of the least value of one form over another, positive one.

    Where all coefficients of Q are positive, P / Q is a mean of the ratios of coefficients.
    """
    stack, levels = np.empty((3 * DEPTH + 4, 3, 3)), np.zeros(3 * DEPTH + 4, dtype=np.int64)
    p, q = np.empty((3, 3)), np.empty((3, 3))
    stack[0] = np.eye(3)
    size, bound, least = 1, np.inf, np.inf
    while size > 0:
        size -= 1
        V, level = stack[size].copy(), levels[size]
        restrict(P, V, p)
        restrict(Q, V, q)
        low = np.inf
        for i in range(3):
            least = min(least, p[i, i] / q[i, i])
            for j in range(i, 3):
                low = min(low, p[i, j] / q[i, j] if q[i, j] > 0.0 else -np.inf)
        if low >= least - tolerance * max(1.0, abs(least)) or level == DEPTH:
            bound = min(bound, low)
            continue
        subdivide(V, stack[size : size + 4])
        levels[size : size + 4] = level + 1
        size += 4
    return bound


@njit(cache=True, error_model="numpy")
def least_ratios(u, cells, points, tolerance, ratio):
    """Write the least det(dx/dX) of each cell."""
    x, S = np.empty((6, 2)), np.empty((3, 2, 2))
    P, Q = np.empty((3, 3)), np.empty((3, 3))
    for c in range(cells.shape[0]):
        slopes(points[c], S)
        Q[:] = 0.0
        add_form(1.0, S, S, Q)
        place(c, u, cells, points, x)
        slopes(x, S)
        P[:] = 0.0
        add_form(1.0, S, S, P)
        ratio[c] = least_ratio(P, Q, tolerance)
