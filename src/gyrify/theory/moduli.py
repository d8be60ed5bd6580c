"""Compressible neo-Hookean tissue that grows, linearised about a state without shear.

Directions are always ordered (across the layers, along the layers, out of the plane).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gyrify.errors import ConfigError

FloatArray = NDArray[np.float64]
Law = Literal["isotropic", "tangential"]
OutOfPlane = Literal["blocked", "none", "generalised"]
Stretch = Literal["linear", "exponential"]
EnergyPer = Literal["grown", "reference"]

_OFF_DIAGONAL = 1.0 - np.eye(3)


def elastic_moduli(young_modulus: float, poisson_ratio: float) -> tuple[float, float]:
    """Shear and bulk modulus, mu = E / 2(1 + nu) and kappa = E / 3(1 - 2 nu).

    Parameters
    ----------
    young_modulus : float
        E [Pa], positive.
    poisson_ratio : float
        nu [-], in (-1, 0.5).

    Returns
    -------
    tuple of float
        mu [Pa], kappa [Pa].

    Raises
    ------
    ConfigError
        If a value is out of bounds.
    """
    if not young_modulus > 0.0:
        raise ConfigError(f"Young's modulus is {young_modulus} Pa.", "It must be positive.")
    if not -1.0 < poisson_ratio < 0.5:
        raise ConfigError(f"Poisson's ratio is {poisson_ratio}.", "It must lie between -1 and 0.5.")
    return young_modulus / (2.0 * (1.0 + poisson_ratio)), young_modulus / (3.0 * (1.0 - 2.0 * poisson_ratio))


def growth_stretch(rate: ArrayLike, time: float, stretch: Stretch) -> FloatArray:
    """Growth stretch lambda_g = 1 + G t (`linear`) or exp(G t) (`exponential`).

    Parameters
    ----------
    rate : array_like
        G [1/time].
    time : float
        t [time].
    stretch : {"linear", "exponential"}
        The law.

    Returns
    -------
    float array
        lambda_g [-], shaped as `rate`.
    """
    strain = np.asarray(rate, dtype=np.float64) * time
    return np.exp(strain) if stretch == "exponential" else 1.0 + strain


@dataclass(frozen=True, eq=False)
class Response:
    """Energy, stress and tangent at principal stretches, per reference volume.

    Attributes
    ----------
    energy : (...) float array
        psi [Pa].
    stress : (..., 3) float array
        Principal first Piola stresses P_i = d psi / d F_i [Pa].
    moduli : (..., 3, 3) float array
        d2 psi / d F_i d F_j of the principal stretches [Pa].
    shear : (..., 2, 2) float array
        d2 psi / d (F_12, F_21)^2 of the in-plane shears [Pa].
    """

    energy: FloatArray
    stress: FloatArray
    moduli: FloatArray
    shear: FloatArray

    @property
    def in_plane(self) -> FloatArray:
        """(..., 4, 4) tangent in the plane [Pa], in the order F_11, F_22, F_12, F_21."""
        tangent = np.zeros((*self.energy.shape, 4, 4))
        tangent[..., :2, :2] = self.moduli[..., :2, :2]
        tangent[..., 2:, 2:] = self.shear
        return tangent


def _assemble(
    energy: FloatArray, elastic: FloatArray, growth: FloatArray, weight: FloatArray, density: _Derivatives
) -> Response:
    """Pull the derivatives by the elastic stretches back to the total stretches."""
    jacobian = np.prod(elastic, axis=-1)[..., None]
    cofactor = jacobian / elastic
    pair = jacobian[..., None] * _OFF_DIAGONAL / (elastic[..., :, None] * elastic[..., None, :])
    cross = elastic[..., :, None] * cofactor[..., None, :]
    stress = density.i[..., None] * elastic + density.j[..., None] * cofactor
    moduli = (
        density.i[..., None, None] * np.eye(3)
        + density.ij[..., None, None] * (cross + np.swapaxes(cross, -1, -2))
        + density.jj[..., None, None] * cofactor[..., :, None] * cofactor[..., None, :]
        + density.j[..., None, None] * pair
    )
    # F_12 changes I1 only; F_12 F_21 together change J by -F_33.
    shear = np.empty((*energy.shape, 2, 2))
    shear[..., 0, 0] = shear[..., 1, 1] = density.i
    shear[..., 0, 1] = shear[..., 1, 0] = -density.j * elastic[..., 2]
    shear_growth = growth[..., [1, 0]]
    return Response(
        weight * energy,
        weight[..., None] * stress / growth,
        weight[..., None, None] * moduli / (growth[..., :, None] * growth[..., None, :]),
        weight[..., None, None] * shear / (shear_growth[..., :, None] * shear_growth[..., None, :]),
    )


@dataclass(frozen=True, eq=False)
class _Derivatives:
    """Derivatives of W by half of I1 = tr F_e F_e^T (`i`), by J_e (`j`), and the second ones."""

    i: FloatArray
    j: FloatArray
    ij: FloatArray
    jj: FloatArray


def volume_weight(growth: FloatArray, energy_per: EnergyPer) -> FloatArray:
    """Factor from W to the energy per reference volume: det F_g (`grown`) or 1 (`reference`).

    Parameters
    ----------
    growth : (..., 3) float array
        Principal growth stretches [-].
    energy_per : {"grown", "reference"}
        The volume that W is counted in.

    Returns
    -------
    (...) float array
        The factor [-].
    """
    return np.prod(growth, axis=-1) if energy_per == "grown" else np.ones(growth.shape[:-1])


def compressible(
    stretch: FloatArray,
    growth: FloatArray,
    mu: FloatArray,
    kappa: FloatArray,
    energy_per: EnergyPer = "grown",
) -> Response:
    """Response of W = mu/2 (J_e^(-2/3) tr F_e F_e^T - 3) + kappa/2 (J_e - 1)^2, F_e = F F_g^-1.

    Parameters
    ----------
    stretch, growth : (..., 3) float array
        Principal total and growth stretches [-], same axes.
    mu, kappa : (...) float array
        Shear and bulk modulus [Pa].
    energy_per : {"grown", "reference"}
        The volume that W is counted in.

    Returns
    -------
    Response
        Per reference volume.
    """
    elastic = stretch / growth
    jacobian = np.prod(elastic, axis=-1)
    invariant = np.sum(elastic**2, axis=-1)
    scale = mu * jacobian ** (-2.0 / 3.0)
    energy = 0.5 * (scale * invariant - 3.0 * mu) + 0.5 * kappa * (jacobian - 1.0) ** 2
    density = _Derivatives(
        i=scale,
        j=-scale * invariant / (3.0 * jacobian) + kappa * (jacobian - 1.0),
        ij=-2.0 / 3.0 * scale / jacobian,
        jj=5.0 / 9.0 * scale * invariant / jacobian**2 + kappa,
    )
    return _assemble(energy, elastic, growth, volume_weight(growth, energy_per), density)


def incompressible(
    stretch: FloatArray, growth: FloatArray, mu: FloatArray, energy_per: EnergyPer = "grown"
) -> Response:
    """Response of W = mu/2 (tr F_e F_e^T - 3) - p (J_e - 1) with no stress across the layers.

    The pressure p is the one that makes the first principal stress vanish; it is held in the tangent.

    Parameters
    ----------
    stretch, growth : (..., 3) float array
        Principal total and growth stretches [-] with det F = det F_g.
    mu : (...) float array
        Shear modulus [Pa].
    energy_per : {"grown", "reference"}
        The volume that W is counted in.

    Returns
    -------
    Response
        Per reference volume.
    """
    elastic = stretch / growth
    pressure = mu * elastic[..., 0] ** 2
    zero = np.zeros_like(pressure)
    energy = 0.5 * mu * (np.sum(elastic**2, axis=-1) - 3.0)
    density = _Derivatives(i=mu + zero, j=-pressure, ij=zero, jj=zero)
    return _assemble(energy, elastic, growth, volume_weight(growth, energy_per), density)
