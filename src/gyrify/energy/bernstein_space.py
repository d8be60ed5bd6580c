r"""Compiled bounds of det(dx/dxi) over whole quadratic tetrahedra.

The slopes of the map x(xi) are linear in the volume coordinates L, so that its determinant is a cubic form,

.. math:: \det \frac{\partial x}{\partial \xi} = \sum_{ijk} L_i L_j L_k M_{ijk} ,

symmetric in its indices, whose 20 different entries are the Bernstein coefficients. The least of them is a
lower bound; on the eight parts between the corners and the middles of the edges the coefficients are fixed
linear combinations of those of the whole, and subdivision drives the bound to the least value. As
`gyrify.energy.bernstein` does for triangles.
"""

from __future__ import annotations

from itertools import combinations_with_replacement, permutations
from typing import Final

import numpy as np

from gyrify.base.compiled import njit
from gyrify.energy.element import EDGES
from gyrify.energy.term import FloatArray

# The functions below write into their last arguments; numba compiles them without annotations.
# mypy: disable-error-code="no-untyped-def"

# Subdivisions after which a sign counts as not proven: the bound is then within some 4^-7 of the cell.
DEPTH = 7
# A step is found to this part of itself; one that is shorter than the second number is none.
STEP_PRECISION, NO_STEP = 1e-3, 1e-10
N_NODES: Final = 10

_EDGES: Final = EDGES[3]
_INDICES: Final = tuple(combinations_with_replacement(range(4), 3))
N: Final = len(_INDICES)
_PLACE: Final = {index: place for place, index in enumerate(_INDICES)}
_ORDERS: Final = np.array([list(permutations(index)) for index in _INDICES])
_CORNERS: Final = np.array([_PLACE[i, i, i] for i in range(4)])
# Corner by corner, the octahedron between them about its edge from the middle of 02 to that of 13.
_PARTS: Final = (
    ((0, 0), (0, 1), (0, 2), (0, 3)),
    ((0, 1), (1, 1), (1, 2), (1, 3)),
    ((0, 2), (1, 2), (2, 2), (2, 3)),
    ((0, 3), (1, 3), (2, 3), (3, 3)),
    ((0, 1), (0, 2), (1, 3), (1, 2)),
    ((0, 1), (0, 2), (0, 3), (1, 3)),
    ((0, 2), (1, 2), (2, 3), (1, 3)),
    ((0, 2), (0, 3), (1, 3), (2, 3)),
)


def _restrictions() -> FloatArray:
    """(8, N, N) from the coefficients of a tetrahedron to those of its parts."""
    matrices = np.zeros((len(_PARTS), N, N))
    for p, part in enumerate(_PARTS):
        V = np.array([0.5 * (np.eye(4)[a] + np.eye(4)[b]) for a, b in part])
        for row, (i, j, k) in enumerate(_INDICES):
            weights = np.einsum("a,b,c->abc", V[i], V[j], V[k])
            for place in np.ndindex(4, 4, 4):
                matrices[p, row, _PLACE[tuple(sorted(place))]] += weights[place]
    return matrices


_RESTRICT: Final = _restrictions()


@njit(cache=True)
def slopes(x, S):
    """dx/dxi_k (S[:, k]) at the corners of a tetrahedron with nodes x; linear in between."""
    c = np.empty((4, 4))
    for i in range(3):
        for a in range(4):
            c[a, a] = x[a, i]
        for e in range(6):
            a, b = _EDGES[e]
            # control points of the edges
            c[a, b] = c[b, a] = 2.0 * x[4 + e, i] - 0.5 * (x[a, i] + x[b, i])
        for p in range(4):
            for k in range(3):
                S[p, k, i] = 2.0 * (c[k + 1, p] - c[0, p])


@njit(cache=True)
def cofactors(B, C, N_):
    """N_[j, k] = B_j x C_k of the slopes along eta and zeta at the corners."""
    for j in range(4):
        for k in range(4):
            b, c = B[j, 1], C[k, 2]
            N_[j, k, 0] = b[1] * c[2] - b[2] * c[1]
            N_[j, k, 1] = b[2] * c[0] - b[0] * c[2]
            N_[j, k, 2] = b[0] * c[1] - b[1] * c[0]


@njit(cache=True)
def add_form(A, B, C, scratch, M):
    """Add the coefficients of det(A_xi, B_eta, C_zeta), made symmetric."""
    cofactors(B, C, scratch)
    for m in range(N):
        total = 0.0
        for o in range(6):
            i, j, k = _ORDERS[m, o]
            n = scratch[j, k]
            total += A[i, 0, 0] * n[0] + A[i, 0, 1] * n[1] + A[i, 0, 2] * n[2]
        M[m] += total / 6.0


@njit(cache=True)
def are_coefficients_positive(forms):
    """Whether all Bernstein coefficients of some forms are positive, so that the forms are."""
    for f in range(forms.shape[0]):
        for m in range(N):
            if not forms[f, m] > 0.0:  # also for NaN
                return False
    return True


@njit(cache=True)
def restrict(forms, part, inside):
    """Coefficients of forms on a part of the tetrahedron."""
    for f in range(forms.shape[0]):
        for m in range(N):
            total = 0.0
            for n in range(N):
                total += _RESTRICT[part, m, n] * forms[f, n]
            inside[f, m] = total


@njit(cache=True)
def are_positive(forms):
    """Whether forms that are the Bernstein coefficients in time of one are proven positive on the cell.

    The first and the last of them are values at the ends of the time; one form alone is its own value.
    """
    n = forms.shape[0]
    stack, levels = np.empty((7 * DEPTH + 8, n, N)), np.zeros(7 * DEPTH + 8, dtype=np.int64)
    inside = np.empty((n, N))
    stack[0] = forms
    size = 1
    while size > 0:
        size -= 1
        inside[:], level = stack[size], levels[size]
        if are_coefficients_positive(inside):
            continue
        for i in range(4):
            m = _CORNERS[i]
            if not (inside[0, m] > 0.0 and inside[n - 1, m] > 0.0):
                return False
        if level == DEPTH:
            return False
        for part in range(8):
            restrict(inside, part, stack[size + part])
            levels[size + part] = level + 1
        size += 8
    return True


@njit(cache=True)
def place(c, u, cells, points, x):
    """Deformed nodes of a cell."""
    for a in range(N_NODES):
        for i in range(3):
            x[a, i] = points[c, a, i] + u[cells[c, a], i]


@njit(cache=True)
def form_of(c, u, cells, points, x, S, scratch, M):
    """Coefficients of the determinant of a deformed cell."""
    place(c, u, cells, points, x)
    slopes(x, S)
    M[:] = 0.0
    add_form(S, S, S, scratch, M)


@njit(cache=True)
def first_inverted(u, cells, points):
    """Number of the first cell that is not proven positive all over, or -1."""
    x, S, scratch, M = np.empty((N_NODES, 3)), np.empty((4, 3, 3)), np.empty((4, 4, 3)), np.empty((1, N))
    for c in range(cells.shape[0]):
        form_of(c, u, cells, points, x, S, scratch, M[0])
        if not are_coefficients_positive(M) and not are_positive(M):
            return c
    return -1


@njit(cache=True)
def in_time(M, start, span, forms):
    """Bernstein coefficients in time, from start to start + span, of sum_k t^k M[k], k up to 3."""
    for m in range(N):
        a, b, c, d = M[0, m], M[1, m], M[2, m], M[3, m]
        value = a + start * (b + start * (c + start * d))
        slope = span * (b + start * (2.0 * c + 3.0 * start * d))
        bend, last = span * span * (c + 3.0 * start * d), span * span * span * d
        forms[0, m] = value
        forms[1, m] = value + slope / 3.0
        forms[2, m] = value + (2.0 * slope + bend) / 3.0
        forms[3, m] = value + slope + bend + last


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
    x, S, T = np.empty((N_NODES, 3)), np.empty((4, 3, 3)), np.empty((4, 3, 3))
    M, forms, scratch = np.empty((4, N)), np.empty((4, N)), np.empty((4, 4, 3))
    rest = np.zeros((1, N_NODES, 3))
    largest = 1.0
    for c in range(cells.shape[0]):
        place(c, u, cells, points, x)
        slopes(x, S)
        place(0, du, cells[c : c + 1], rest, x)
        slopes(x, T)
        M[:] = 0.0
        add_form(S, S, S, scratch, M[0])
        for A, B, C in ((T, S, S), (S, T, S), (S, S, T)):
            add_form(A, B, C, scratch, M[1])
        for A, B, C in ((S, T, T), (T, S, T), (T, T, S)):
            add_form(A, B, C, scratch, M[2])
        add_form(T, T, T, scratch, M[3])
        in_time(M, 0.0, largest, forms)
        if not are_coefficients_positive(forms):
            largest = time_to_inversion(M, largest, forms)
    return largest


@njit(cache=True)
def least_ratio(P, Q, tolerance):
    """Lower bound, within a tolerance, of the least value of one form over another, positive one.

    Where all coefficients of Q are positive, P / Q is a mean of the ratios of coefficients.
    """
    stack, levels = np.empty((7 * DEPTH + 8, 2, N)), np.zeros(7 * DEPTH + 8, dtype=np.int64)
    inside = np.empty((2, N))
    stack[0, 0], stack[0, 1] = P, Q
    size, bound, least = 1, np.inf, np.inf
    while size > 0:
        size -= 1
        inside[:], level = stack[size], levels[size]
        low = np.inf
        for i in range(4):
            least = min(least, inside[0, _CORNERS[i]] / inside[1, _CORNERS[i]])
        for m in range(N):
            low = min(low, inside[0, m] / inside[1, m] if inside[1, m] > 0.0 else -np.inf)
        if low >= least - tolerance * max(1.0, abs(least)) or level == DEPTH:
            bound = min(bound, low)
            continue
        for part in range(8):
            restrict(inside, part, stack[size + part])
            levels[size + part] = level + 1
        size += 8
    return bound


@njit(cache=True, error_model="numpy")
def least_ratios(u, cells, points, tolerance, ratio):
    """Write the least det(dx/dX) of each cell."""
    x, S, scratch = np.empty((N_NODES, 3)), np.empty((4, 3, 3)), np.empty((4, 4, 3))
    P, Q, none = np.empty(N), np.empty(N), np.zeros_like(u)
    for c in range(cells.shape[0]):
        form_of(c, none, cells, points, x, S, scratch, Q)
        form_of(c, u, cells, points, x, S, scratch, P)
        ratio[c] = least_ratio(P, Q, tolerance)
