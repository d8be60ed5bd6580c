"""Cook's panel: a tapered cantilever, 48 mm long and 44 to 16 mm high, sheared upwards at its end.

Bending with large rotations, and a corner at the clamp where the stress is singular: no element reaches its
full order in the deflection of the tip, but those that lock show it.
"""

from __future__ import annotations

import dataclasses

import numpy as np
from panels import Panel, quadrilaterals

from gyrify.physics.materials.neo_hookean import lame_parameters

# Shear force over mu [mm]; the tip then moves by about 7 of 60 mm.
FORCE = 1.25
TIP = (48.0, 60.0)


def panel(n: int, element: str, graded: bool = False) -> Panel:
    """n x n quadrilaterals with alternating diagonals; graded, they shrink towards the clamped corners."""
    s = t = np.linspace(0.0, 1.0, n + 1)
    if graded:
        s, t = s**3, 0.5 - 0.5 * np.cos(np.pi * t)
    along, up = np.meshgrid(s, t)
    points = np.stack([48.0 * along, 44.0 * along + up * (44.0 - 28.0 * along)], axis=2)
    body = quadrilaterals(points, element, np.indices((n, n)).sum(axis=0) % 2 == 0)
    return dataclasses.replace(body, held=np.flatnonzero(body.points[:, 0] < 1e-9))


def end_shear(body: Panel, force: float) -> np.ndarray:
    """Nodal forces of a uniform shear traction on the end, consistent with the element."""
    points = body.points
    end = np.flatnonzero(points[:, 0] > 48.0 - 1e-9)
    end = end[np.argsort(points[end, 1])]
    forces = np.zeros_like(points)
    stride, share = (2, [1 / 6, 4 / 6, 1 / 6]) if body.element == "quadratic" else (1, [0.5, 0.5])
    for first in range(0, end.size - 1, stride):
        nodes = end[first : first + stride + 1]
        length = points[nodes[-1], 1] - points[nodes[0], 1]
        forces[nodes, 1] += force * length / 16.0 * np.array(share)
    return forces


def tip_deflection(n: int, element: str, poisson_ratio: float, graded: bool = False) -> float:
    """Upward displacement of the upper end [mm], mu = 1 Pa."""
    mu, kappa = lame_parameters(1.0, poisson_ratio)
    body = panel(n, element, graded)
    u = body.solve(mu, kappa, end_shear(body, FORCE * mu), np.zeros_like(body.points), steps=4)
    return float(u[np.argmin(np.linalg.norm(body.points - TIP, axis=1)), 1])
