r"""Modes of the growing sphere: the second variation about its smooth state, degree by degree.

In degree l an increment is spheroidal, U(R) Y e_r + V(R) grad Y, or toroidal, W(R) e_r x grad Y, with a real
spherical harmonic Y of degree l and grad on the unit sphere. Different degrees, orders and kinds do not see
each other, and orders of one degree are alike. With L = l (l + 1), the identities

.. math:: \int |\nabla Y|^2 = L, \quad \int |\nabla\nabla Y|^2 = L^2 - L, \quad
   \int \det \nabla\nabla Y = L / 2

of a Y with a mean square of one over the unit sphere leave integrals over R alone. A_ij are the moduli of the
principal stretches (1 radial), S those of the shears 12 and 21, and b, c those of the shears 23 and 32, with
b + c = A_22 - A_23, since the tissue is isotropic along its layers:

.. math:: \int R^2 dR \left[ A_{11} U'^2 + 2 A_{12} U' e + \tfrac12 (A_{22} + A_{23}) e^2
   + (A_{22} - A_{23}) (\tfrac12 L - 1) v^2 / R^2 + S_{11} a^2 + 2 S_{12} a v' + S_{22} v'^2 \right],

v = sqrt(L) V, e = (2 U - sqrt(L) v) / R, a = (sqrt(L) U - v) / R; and for w = sqrt(L) W

.. math:: \int R^2 dR \left[ S_{11} w^2 / R^2 - 2 S_{12} w w' / R + S_{22} w'^2
   + (b L - b - c) w^2 / R^2 \right] .
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh, solve_triangular

from gyrify.theory.mode_numbers import quadratic_forms
from gyrify.theory.sphere import SphereState

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SphericalVariation:
    """The quadratic forms of all degrees of one state, whitened so that the mass is the identity.

    Attributes
    ----------
    state : SphereState
        The state.
    spheroidal : (3, 2 n, 2 n) float array
        K_0, K_1, K_2 of K = K_0 + sqrt(L) K_1 + L K_2 [Pa/mm^2], radial unknowns first.
    toroidal : (2, n, n) float array
        K_0, K_1 of K = K_0 + L K_1 [Pa/mm^2].
    root : (n, n) float array
        Lower Cholesky factor of the mass of one component.
    """

    state: SphereState
    spheroidal: FloatArray
    toroidal: FloatArray
    root: FloatArray

    @classmethod
    def of(cls, state: SphereState) -> SphericalVariation:
        """Assemble about a state."""
        line, held = state.line, int(state.sphere.is_held)
        volume, R = line.weights * line.points**2, line.points[:, None]
        values, slopes = line.values[:, held:], line.slopes[:, held:]
        root = np.asarray(np.linalg.cholesky(values.T @ (volume[:, None] * values)), dtype=np.float64)
        values, slopes = (
            solve_triangular(root, (np.sqrt(volume)[:, None] * shape).T, lower=True).T
            for shape in (values, slopes)
        )
        stretches = state.stretches(line.points)
        response = state.response(line.points)
        along = state.sphere.tangential_response(line.points, stretches, state.growth_time)
        moduli, shear, layer = response.moduli, response.shear, along.shear
        return cls(
            state,
            _spheroidal(values / R, slopes, moduli, shear),
            _toroidal(values / R, slopes, shear, layer),
            root,
        )

    def matrix(self, degree: int) -> FloatArray:
        """Whitened second variation [Pa/mm^2] of the spheroidal modes of a degree; of U alone in degree 0."""
        L, size = float(degree * (degree + 1)), len(self.root)
        matrix: FloatArray = self.spheroidal[0] + np.sqrt(L) * self.spheroidal[1] + L * self.spheroidal[2]
        return matrix if degree else matrix[:size, :size]

    def twist(self, degree: int) -> FloatArray:
        """Whitened second variation [Pa/mm^2] of the toroidal modes of a degree, from 1 on."""
        L = float(degree * (degree + 1))
        return np.asarray(self.toroidal[0] + L * self.toroidal[1])

    def lowest(self, degree: int) -> float:
        """Lowest eigenvalue [Pa/mm^2] of a degree, rigid motion of a sphere that nothing holds left out."""
        matrices = [self.matrix(degree)] + ([self.twist(degree)] if degree else [])
        if degree == 1 and not self.state.sphere.is_held:
            matrices = [
                _deflated(matrix, motion) for matrix, motion in zip(matrices, self._rigid(), strict=True)
            ]
        return min(float(eigh(m, eigvals_only=True, subset_by_index=[0, 0])[0]) for m in matrices)

    def _rigid(self) -> tuple[FloatArray, FloatArray]:
        """Whitened translation, U = V = 1, and rotation, W = r: increments follow the deformed radius."""
        one = self.root.T @ np.ones(len(self.root))
        nodes = self.state.line.nodes + self.state.displacement
        return np.concatenate([one, np.sqrt(2.0) * one]), self.root.T @ nodes


def _deflated(matrix: FloatArray, motion: FloatArray) -> FloatArray:
    """A matrix in which a motion has the largest eigenvalue."""
    unit = motion / np.linalg.norm(motion)
    return np.asarray(matrix + np.linalg.norm(matrix) * np.outer(unit, unit))


def _spheroidal(hoop: FloatArray, slopes: FloatArray, moduli: FloatArray, shear: FloatArray) -> FloatArray:
    """K_0, K_1, K_2 of U and v; rows of the forms are U', e, a, v'."""
    none = np.zeros_like(hoop)
    fixed = np.stack(
        [np.hstack(row) for row in ([slopes, none], [2.0 * hoop, none], [none, -hoop], [none, slopes])]
    )
    turning = np.stack([np.hstack(row) for row in ([none, none], [none, -hoop], [hoop, none], [none, none])])
    tangent = np.zeros((4, 4, len(moduli)))
    tangent[0, 0], tangent[0, 1] = moduli[:, 0, 0], moduli[:, 0, 1]
    tangent[1, 0], tangent[1, 1] = moduli[:, 0, 1], 0.5 * (moduli[:, 1, 1] + moduli[:, 1, 2])
    tangent[2:, 2:] = np.moveaxis(shear, 0, -1)
    forms = quadratic_forms(fixed, turning, tangent)
    size = hoop.shape[1]
    stretching = hoop.T @ ((moduli[:, 1, 1] - moduli[:, 1, 2])[:, None] * hoop)
    forms[0, size:, size:] -= stretching
    forms[2, size:, size:] += 0.5 * stretching
    return forms


def _toroidal(hoop: FloatArray, slopes: FloatArray, shear: FloatArray, layer: FloatArray) -> FloatArray:
    """K_0, K_1 of w; ``layer`` has the shears of the layers."""
    b, c = layer[:, 0, 0], layer[:, 0, 1]
    mixed = hoop.T @ (shear[:, 0, 1, None] * slopes)
    own = hoop.T @ ((shear[:, 0, 0] - b - c)[:, None] * hoop)
    across = slopes.T @ (shear[:, 1, 1, None] * slopes)
    return np.stack([own - mixed - mixed.T + across, hoop.T @ (b[:, None] * hoop)])
