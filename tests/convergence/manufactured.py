r"""A smooth exact solution: the body force that makes a chosen deformation an equilibrium.

The deformation is a change of volume followed by two shears, J = 1 + (mu / kappa) q(X), so that
displacement and pressure stay of the same size however stiff the volume is; otherwise a loss of accuracy
near nu = 1/2 could be the solution's and not the element's. The body force is -Div P; P is written down
here once more, and its divergence taken by complex steps, exact to round-off.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from panels import Panel

from gyrify.physics.materials.neo_hookean import lame_parameters

_STEP = 1e-30


@dataclass(frozen=True)
class Manufactured:
    """Deformation of a body of a given size.

    Attributes
    ----------
    poisson_ratio : float
        nu [-].
    size : float
        Length over which the deformation varies [mm].
    amplitude : float
        Size of the shears [-].
    """

    poisson_ratio: float
    size: float = 1.0
    amplitude: float = 0.1

    @property
    def moduli(self) -> tuple[float, float]:
        """mu, kappa for E = 1 Pa."""
        return lame_parameters(1.0, self.poisson_ratio)

    def map(self, X: np.ndarray) -> np.ndarray:
        """Deformed places x of reference places X (..., 2)."""
        mu, kappa = self.moduli
        a, k = self.amplitude, np.pi / self.size
        X0, X1 = X[..., 0], X[..., 1]
        stretched = X0 + 0.3 * mu / kappa * np.sin(k * X0) * np.cos(k * X1) / k
        x = stretched + a * np.sin(k * X1 + 0.3) / k * 2.0
        return np.stack([x, X1 + a * np.sin(k * x + 0.7) / k * 2.0], axis=-1)

    def displacement(self, X: np.ndarray) -> np.ndarray:
        """u = x - X."""
        return self.map(X) - X

    def slope(self, X: np.ndarray) -> np.ndarray:
        """(..., 2, 2) du / dX."""
        return self.deformation(X) - np.eye(2)

    def deformation(self, X: np.ndarray) -> np.ndarray:
        """(..., 2, 2) F, in closed form so that it takes complex places."""
        mu, kappa = self.moduli
        b, k, e = 2.0 * self.amplitude, np.pi / self.size, 0.3 * mu / kappa
        X0, X1 = X[..., 0], X[..., 1]
        x = self.map(X)[..., 0]
        x_0 = 1.0 + e * np.cos(k * X0) * np.cos(k * X1)
        x_1 = -e * np.sin(k * X0) * np.sin(k * X1) + b * np.cos(k * X1 + 0.3)
        turn = b * np.cos(k * x + 0.7)
        rows = [np.stack([x_0, x_1], axis=-1), np.stack([turn * x_0, 1.0 + turn * x_1], axis=-1)]
        return np.stack(rows, axis=-2)

    def stress(self, X: np.ndarray) -> np.ndarray:
        """(..., 2, 2) P = mu J^(-2/3) (F - I1/3 F^-T) + kappa (J - 1) J F^-T, with F33 = 1."""
        mu, kappa = self.moduli
        F = self.deformation(X)
        J = F[..., 0, 0] * F[..., 1, 1] - F[..., 0, 1] * F[..., 1, 0]
        I1 = np.sum(F * F, axis=(-2, -1)) + 1.0
        cofactor = np.stack(
            [
                np.stack([F[..., 1, 1], -F[..., 1, 0]], axis=-1),
                np.stack([-F[..., 0, 1], F[..., 0, 0]], axis=-1),
            ],
            axis=-2,
        )
        shear = mu * J ** (-2.0 / 3.0)
        along = kappa * (J - 1.0) - shear * I1 / (3.0 * J)
        return shear[..., None, None] * F + along[..., None, None] * cofactor

    def body_force(self, X: np.ndarray) -> np.ndarray:
        """(..., 2) -Div P by complex steps [Pa/mm]."""
        force = np.zeros(X.shape)
        for j in range(2):
            shifted = X.astype(complex)
            shifted[..., j] += 1j * _STEP
            force -= self.stress(shifted).imag[..., j] / _STEP
        return force

    def errors(self, panel: Panel) -> tuple[float, float]:
        """Relative errors in L2 and the H1 seminorm of the equilibrium that a panel finds."""
        u = panel.solve(*self.moduli, panel.load(self.body_force), self.displacement(panel.points))
        return panel.errors(u, self.displacement, self.slope)
