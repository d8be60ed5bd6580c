"""Damped explicit dynamics of the same cells: one compiled time step, as explicit folding codes do it."""

from __future__ import annotations

import numpy as np
from numba import njit

# mypy: disable-error-code="no-untyped-def"


@njit(cache=True, error_model="numpy")
def add_forces(u, cells, gradients, volumes, stretch, mu, kappa, forces):
    """Add minus the gradient of the energy of cells that grew by ``stretch`` everywhere, also out of plane.

    Returns the energy.
    """
    energy = 0.0
    for c in range(cells.shape[0]):
        inverse = 1.0 / stretch[c]
        F00, F01, F10, F11 = 1.0, 0.0, 0.0, 1.0
        for a in range(3):
            x, y = u[cells[c, a], 0], u[cells[c, a], 1]
            gx, gy = gradients[c, a, 0], gradients[c, a, 1]
            F00 += x * gx
            F01 += x * gy
            F10 += y * gx
            F11 += y * gy
        F00, F01, F10, F11 = F00 * inverse, F01 * inverse, F10 * inverse, F11 * inverse
        det = F00 * F11 - F01 * F10
        J = det * inverse
        I1 = F00 * F00 + F01 * F01 + F10 * F10 + F11 * F11 + inverse * inverse
        root = np.cbrt(J)
        a_ = mu[c] / (root * root)
        p = kappa[c] * (J - 1.0)
        b_ = (J * p - a_ * I1 / 3.0) / det
        counted = volumes[c] * stretch[c] ** 3
        energy += counted * 0.5 * (a_ * I1 - 3.0 * mu[c] + p * (J - 1.0))
        scale = counted * inverse
        P00, P01 = scale * (a_ * F00 + b_ * F11), scale * (a_ * F01 - b_ * F10)
        P10, P11 = scale * (a_ * F10 - b_ * F01), scale * (a_ * F11 + b_ * F00)
        for a in range(3):
            gx, gy = gradients[c, a, 0], gradients[c, a, 1]
            forces[cells[c, a], 0] -= P00 * gx + P01 * gy
            forces[cells[c, a], 1] -= P10 * gx + P11 * gy
    return energy


@njit(cache=True, error_model="numpy")
def advance(u, v, forces, mass, is_free, damping, dt):
    """Move every free point by one step of central differences with a drag c m du/dt; kinetic energy."""
    kinetic = 0.0
    slowed = 1.0 / (1.0 + 0.5 * damping * dt)
    kept = (1.0 - 0.5 * damping * dt) * slowed
    for i in range(u.shape[0]):
        for k in range(2):
            if is_free[i, k]:
                v[i, k] = kept * v[i, k] + slowed * dt * forces[i, k] / mass[i]
                u[i, k] += dt * v[i, k]
                kinetic += 0.5 * mass[i] * v[i, k] * v[i, k]
    return kinetic


@njit(cache=True, error_model="numpy")
def steps(number, t, dt, duration, u, v, cells, gradients, volumes, rate, mu, kappa, mass, is_free, damping):
    """Take so many steps while the tissue grows; ``t`` is the time, of ``duration``, at the start.

    Returns
    -------
    elastic, kinetic : float
        Energies after the last step.
    """
    forces, stretch = np.empty_like(u), np.empty_like(rate)
    elastic, kinetic = 0.0, 0.0
    for step in range(number):
        fraction = (t + (step + 1) * dt) / duration
        for c in range(rate.size):
            stretch[c] = 1.0 + rate[c] * fraction
        forces[:] = 0.0
        elastic = add_forces(u, cells, gradients, volumes, stretch, mu, kappa, forces)
        kinetic = advance(u, v, forces, mass, is_free, damping, dt)
    return elastic, kinetic
