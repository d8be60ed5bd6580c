r"""A material of one's own: a cortex that stiffens with stretch, after Ogden.

.. math:: W = \frac{2 \mu}{\alpha^2} (\bar s_1^\alpha + \bar s_2^\alpha + \bar s_3^\alpha - 3)
          + \frac{\kappa}{2} (J - 1)^2, \quad \bar s_i = J^{-1/3} s_i

of the principal stretches s; mu and kappa are those of E and nu at small strain, whatever alpha is.

Run it: ``python examples/own_material.py``
"""

from __future__ import annotations

import gyrify
from gyrify.base.compiled import njit
from gyrify.physics.materials import MATERIALS, Material
from gyrify.physics.materials.neo_hookean import lame_parameters


@njit(inline="always")
def density(a, b, s, p, c):
    """W [Pa]; p holds mu, alpha and kappa of each point."""
    mu, alpha, kappa, J = p[0, c], p[1, c], p[2, c], a * b * s
    total = J ** (-alpha / 3.0) * (a**alpha + b**alpha + s**alpha) - 3.0
    return 2.0 * mu / (alpha * alpha) * total + 0.5 * kappa * (J - 1.0) * (J - 1.0)


@njit(inline="always")
def derivatives(a, b, s, p, c):
    """First and second derivatives by a, b and s: first, then pure and then mixed second ones [Pa]."""
    mu, alpha, kappa, J = p[0, c], p[1, c], p[2, c], a * b * s
    k, f = 2.0 * mu / alpha, J ** (-alpha / 3.0)
    x, y, z = f * a**alpha, f * b**alpha, f * s**alpha
    m, v = (x + y + z) / 3.0, kappa * J * (J - 1.0)
    W_a, W_b, W_s = (k * (x - m) + v) / a, (k * (y - m) + v) / b, (k * (z - m) + v) / s
    h, u = k * alpha / 9.0, kappa * J * J
    W_aa = (h * (3.0 * m + 3.0 * x) - k * (x - m) + u) / (a * a)
    W_bb = (h * (3.0 * m + 3.0 * y) - k * (y - m) + u) / (b * b)
    W_ss = (h * (3.0 * m + 3.0 * z) - k * (z - m) + u) / (s * s)
    W_ab = (3.0 * h * (m - x - y) + u + v) / (a * b)
    W_as = (3.0 * h * (m - x - z) + u + v) / (a * s)
    W_bs = (3.0 * h * (m - y - z) + u + v) / (b * s)
    return W_a, W_b, W_s, W_aa, W_bb, W_ss, W_ab, W_as, W_bs


def parameters(young_modulus, poisson_ratio):
    """mu, alpha and kappa of a tissue; brain tissue stiffens with alpha about 8 and more."""
    mu, kappa = lame_parameters(young_modulus, poisson_ratio)
    return mu, 8.0, kappa


OGDEN = Material("ogden_8", "stretches", density, derivatives, parameters)

if __name__ == "__main__":
    MATERIALS.append(OGDEN)
    coarse = {"mesh.n_around": 108, "mesh.n_layers": 9, "mesh.n_cortex_layers": 3, "material.law": OGDEN.name}
    print(gyrify.measure_state(gyrify.simulate(gyrify.Config().with_overrides(coarse))))
