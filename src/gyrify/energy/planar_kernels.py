"""Compiled geometry of contact in the plane: boxes, distances, the barrier, and conservative steps.

One file, because numba looks at no other when it decides whether what it has stored is still right.
"""

from __future__ import annotations

import numpy as np

from gyrify.base.compiled import njit

# The functions below are compiled without annotations.
# mypy: disable-error-code="no-untyped-def"

# Part of the present distance that one advance may use up: less than all of it, for the sake of round-off.
ADVANCE = 0.9
# Advances along one path; a pair that needs more is taken to meet where they end.
MOST_ADVANCES = 100_000
# Distance, over the size of coordinates and path, that rounding leaves uncertain.
ROUNDING = 1e-15


@njit(cache=True, error_model="numpy")
def meeting_boxes(low, high, edges, n_own, order, pairs):
    """Write vertices and edges whose boxes meet, as far as there is room; how many there are.

    Boxes are given per vertex (``low``, ``high``); that of an edge holds those of its ends. ``order`` sorts
    the edges by the lower x of their boxes. Of what lies at or above ``n_own`` one alone must be below.
    """
    n_vertices, n_edges, found = low.shape[0], edges.shape[0], 0
    widest = 0.0
    left = np.empty(n_edges)
    for k in range(n_edges):
        a, b = edges[order[k], 0], edges[order[k], 1]
        left[k] = min(low[a, 0], low[b, 0])
        widest = max(widest, max(high[a, 0], high[b, 0]) - left[k])
    for v in range(n_vertices):
        k = np.searchsorted(left, low[v, 0] - widest)
        while k < n_edges and left[k] <= high[v, 0]:
            e = order[k]
            a, b = edges[e, 0], edges[e, 1]
            k += 1
            if v in (a, b) or (v >= n_own and a >= n_own and b >= n_own):
                continue
            if max(high[a, 0], high[b, 0]) < low[v, 0]:
                continue
            if min(low[a, 1], low[b, 1]) > high[v, 1] or max(high[a, 1], high[b, 1]) < low[v, 1]:
                continue
            if found < pairs.shape[0]:
                pairs[found, 0], pairs[found, 1] = v, e
            found += 1
    return found


@njit(cache=True, error_model="numpy")
def nearest(px, py, ax, ay, bx, by):
    """Squared distance from a point to a segment, and where: 0 or 1 at an end, 2 between them."""
    ex, ey, qx, qy = bx - ax, by - ay, px - ax, py - ay
    along, length = qx * ex + qy * ey, ex * ex + ey * ey
    if along <= 0.0:
        return qx * qx + qy * qy, 0
    if along >= length:
        return (px - bx) ** 2 + (py - by) ** 2, 1
    cross = qx * ey - qy * ex
    return cross * cross / length, 2


@njit(cache=True, error_model="numpy")
def close_pairs(x, edges, pairs, limit, kind, squared):
    """Write where the edge of each pair is nearest to its vertex, and the squared distance; -1 if too far."""
    for n in range(pairs.shape[0]):
        v, e = pairs[n, 0], pairs[n, 1]
        a, b = edges[e, 0], edges[e, 1]
        squared[n], kind[n] = nearest(x[v, 0], x[v, 1], x[a, 0], x[a, 1], x[b, 0], x[b, 1])
        if not squared[n] < limit:
            kind[n] = -1


@njit(cache=True, error_model="numpy")
def barrier(s):
    """b(s) = -(s - 1)^2 ln s and its first two derivatives."""
    r, logarithm = s - 1.0, np.log(s)
    first = -2.0 * r * logarithm - r * r / s
    return -r * r * logarithm, first, -2.0 * logarithm - 4.0 * r / s + r * r / (s * s)


@njit(cache=True, error_model="numpy")
def vertex_pairs(x, ends, weight, scale, limit, order, gradient, blocks):
    """Energy of pairs of vertices; add their forces, write their (4, 4) matrices."""
    total = 0.0
    for n in range(ends.shape[0]):
        a, b = ends[n, 0], ends[n, 1]
        dx, dy = x[a, 0] - x[b, 0], x[a, 1] - x[b, 1]
        value, first, second = barrier((dx * dx + dy * dy) / limit)
        w = weight[n] * scale
        total += w * value
        if order == 0:
            continue
        f, c = w * first / limit, w * second / (limit * limit)
        gradient[a, 0] += 2.0 * f * dx
        gradient[a, 1] += 2.0 * f * dy
        gradient[b, 0] -= 2.0 * f * dx
        gradient[b, 1] -= 2.0 * f * dy
        if order == 1:
            continue
        d = (dx, dy)
        for i in range(2):
            for j in range(2):
                entry = 4.0 * c * d[i] * d[j] + (2.0 * f if i == j else 0.0)
                blocks[n, i, j] = blocks[n, 2 + i, 2 + j] = entry
                blocks[n, i, 2 + j] = blocks[n, 2 + i, j] = -entry
    return total


@njit(cache=True, error_model="numpy")
def edge_pairs(x, ends, weight, scale, limit, order, gradient, blocks):
    """Energy of vertices before the inside of edges; add their forces, write their (6, 6) matrices.

    With q = p - a, e = b - a, the squared distance is D = c^2 / L, c = q x e, L = e . e.
    """
    total = 0.0
    dc, dL, dD = np.empty(6), np.zeros(6), np.empty(6)
    ddc, ddL = np.zeros((6, 6)), np.zeros((6, 6))
    for i, j, sign in ((0, 5, 1.0), (0, 3, -1.0), (2, 5, -1.0), (1, 4, -1.0), (1, 2, 1.0), (3, 4, 1.0)):
        ddc[i, j] = ddc[j, i] = sign
    for i in range(2):
        ddL[2 + i, 2 + i] = ddL[4 + i, 4 + i] = 2.0
        ddL[2 + i, 4 + i] = ddL[4 + i, 2 + i] = -2.0
    for n in range(ends.shape[0]):
        p, a, b = ends[n, 0], ends[n, 1], ends[n, 2]
        qx, qy, ex, ey = x[p, 0] - x[a, 0], x[p, 1] - x[a, 1], x[b, 0] - x[a, 0], x[b, 1] - x[a, 1]
        c, L = qx * ey - qy * ex, ex * ex + ey * ey
        value, first, second = barrier(c * c / L / limit)
        w = weight[n] * scale
        total += w * value
        if order == 0:
            continue
        dc[0], dc[1], dc[2], dc[3], dc[4], dc[5] = ey, -ex, qy - ey, ex - qx, -qy, qx
        dL[2], dL[3], dL[4], dL[5] = -2.0 * ex, -2.0 * ey, 2.0 * ex, 2.0 * ey
        r = c / L
        f, g = w * first / limit, w * second / (limit * limit)
        for i in range(6):
            dD[i] = 2.0 * r * dc[i] - r * r * dL[i]
        for k in range(3):
            gradient[ends[n, k], 0] += f * dD[2 * k]
            gradient[ends[n, k], 1] += f * dD[2 * k + 1]
        if order == 1:
            continue
        for i in range(6):
            for j in range(6):
                mixed = dc[i] * dL[j] + dL[i] * dc[j]
                ddD = 2.0 / L * (dc[i] * dc[j] - r * mixed + r * r * dL[i] * dL[j])
                ddD += 2.0 * r * ddc[i, j] - r * r * ddL[i, j]
                blocks[n, i, j] = g * dD[i] * dD[j] + f * ddD
    return total


@njit(cache=True, error_model="numpy")
def free_step(start, end, edges, pairs, gap):
    """Fraction of the straight path, at most 1, on which no pair comes nearer than a part of its distance.

    Additive advances (Li, Kaufman and Jiang 2021): with l the largest speed of a pair about its mean motion,
    a distance d is not used up before d / l, so that each advance, and their sum, is safe.
    """
    step = 1.0
    for n in range(pairs.shape[0]):
        v, e = pairs[n, 0], pairs[n, 1]
        step = pair_step(start, end, v, edges[e, 0], edges[e, 1], gap, step)
        if step == 0.0:
            break
    return step


@njit(cache=True, error_model="numpy")
def pair_step(start, end, p, a, b, gap, longest):
    """Fraction of the path up to which a vertex and an edge are known not to meet, at most ``longest``."""
    mx = (end[p, 0] - start[p, 0] + end[a, 0] - start[a, 0] + end[b, 0] - start[b, 0]) / 3.0
    my = (end[p, 1] - start[p, 1] + end[a, 1] - start[a, 1] + end[b, 1] - start[b, 1]) / 3.0
    upx, upy = end[p, 0] - start[p, 0] - mx, end[p, 1] - start[p, 1] - my
    uax, uay = end[a, 0] - start[a, 0] - mx, end[a, 1] - start[a, 1] - my
    ubx, uby = end[b, 0] - start[b, 0] - mx, end[b, 1] - start[b, 1] - my
    speed = np.hypot(upx, upy) + max(np.hypot(uax, uay), np.hypot(ubx, uby))
    px, py, ax, ay, bx, by = start[p, 0], start[p, 1], start[a, 0], start[a, 1], start[b, 0], start[b, 1]
    distance = np.sqrt(nearest(px, py, ax, ay, bx, by)[0])
    size = max(abs(px), abs(py), abs(ax), abs(ay), abs(bx), abs(by)) + speed + abs(mx) + abs(my)
    # nearer than rounding, no distance is known
    nearest_allowed = max(gap * distance, ROUNDING * size)
    if not distance > nearest_allowed or not np.isfinite(speed):
        return 0.0
    t = 0.0
    for _ in range(MOST_ADVANCES):
        if speed * (longest - t) < ADVANCE * (distance - nearest_allowed):
            return longest
        t += ADVANCE * (distance - nearest_allowed) / speed
        distance = np.sqrt(
            nearest(px + t * upx, py + t * upy, ax + t * uax, ay + t * uay, bx + t * ubx, by + t * uby)[0]
        )
        if distance <= 2.0 * nearest_allowed:
            break
    return min(t, longest)
