"""Growth as thermal expansion: F = F_e F_g (paper, Eqs 3-5)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

Stretch = Literal["linear", "exponential"]
OutOfPlane = Literal["blocked", "none", "generalised"]


def growth_stretch(rate: FloatArray | float, time: float, stretch: Stretch) -> FloatArray:
    """Growth stretch of a tissue at a growth time.

    Parameters
    ----------
    rate : float array
        Growth rate G [1/time], one value per cell or a scalar.
    time : float
        Growth time t [time].
    stretch : {"linear", "exponential"}
        lambda_g = 1 + G t (paper, Eq. 4), or exp(G t): thermal strain added as a logarithmic strain.

    Returns
    -------
    float array
        lambda_g, in the shape of ``rate``.
    """
    strain = np.asarray(rate, dtype=np.float64) * time
    return np.exp(strain) if stretch == "exponential" else 1.0 + strain


def growth_tensor(
    stretch: FloatArray,
    tangential: NDArray[np.bool_],
    across: FloatArray,
    stretch_across: FloatArray | float = 1.0,
) -> FloatArray:
    """Growth tensor of each cell, in the plane for a planar body.

    Parameters
    ----------
    stretch : (n_cells,) float array
        Growth stretch lambda_g.
    tangential : (n_cells,) bool array
        Where growth is tangential, F_g = lambda_g (I - N N) + lambda_n N N; elsewhere F_g = lambda_g I.
    across : (n_cells, n_dim) float array
        Unit reference direction N across the layers.
    stretch_across : (n_cells,) float array or float
        lambda_n: 1 where tissue does not grow across the layers.

    Returns
    -------
    (n_cells, n_dim, n_dim) float array
        Symmetric positive definite F_g.
    """
    n_dim = across.shape[1]
    tensor = stretch[:, None, None] * np.eye(n_dim)
    if not tangential.any():
        return tensor
    normal = np.where(tangential, stretch_across - stretch, 0.0)
    return tensor + normal[:, None, None] * across[:, :, None] * across[:, None, :]


def out_of_plane_growth(stretch: FloatArray, out_of_plane: OutOfPlane, exponent: float = 1.0) -> FloatArray:
    """Out-of-plane entry F_g,33 of the growth tensor.

    Parameters
    ----------
    stretch : (n_cells,) float array
        Growth stretch lambda_g.
    out_of_plane : {"blocked", "none", "generalised"}
        ``blocked``: the tissue grows in z too but is held, F_g,33 = lambda_g^s, so F_e,33 = 1 / F_g,33.
        ``none``: no growth in z, F_g,33 = 1. ``generalised``: grows in z, with a free common F33.
    exponent : float
        s, how much of the growth in the plane there is in z: 1 for as much, 0 for none.

    Returns
    -------
    (n_cells,) float array
    """
    if out_of_plane == "none":
        return np.ones_like(stretch)
    # A power of 1 may differ in the last bit, and results must not.
    return stretch.copy() if exponent == 1.0 else stretch**exponent


@dataclass(frozen=True, eq=False)
class Growth:
    """Growth over a body: how fast, in which directions and by which law of time each of its points grows.

    Attributes
    ----------
    rate : (n,) float array
        Growth rate [1/time].
    tangential : (n,) bool array
        Where growth along the layers and across them differ; elsewhere it is isotropic.
    across : (n, n_dim) float array
        Unit reference direction across the layers.
    law : {"linear", "exponential"}
        Law of time; see `growth_stretch`.
    out_of_plane_rule : {"blocked", "none", "generalised"}
        As of `out_of_plane_growth`; of no meaning in space.
    exponent : float
        s of `out_of_plane_growth`.
    rate_across : (n,) float array or float
        Growth rate across the layers where growth is tangential [1/time].
    """

    rate: FloatArray
    tangential: NDArray[np.bool_]
    across: FloatArray
    law: Stretch = "linear"
    out_of_plane_rule: OutOfPlane = "none"
    exponent: float = 1.0
    rate_across: FloatArray | float = 0.0

    @property
    def is_isotropic(self) -> bool:
        """Whether no point grows tangentially."""
        return not self.tangential.any()

    def stretch(self, time: float) -> FloatArray:
        """(n,) growth stretch lambda_g at a growth time."""
        return growth_stretch(self.rate, time, self.law)

    def stretch_across(self, time: float) -> FloatArray:
        """(n,) growth stretch across the layers where growth is tangential."""
        return growth_stretch(np.broadcast_to(self.rate_across, self.rate.shape), time, self.law)

    def tensor(self, time: float) -> FloatArray:
        """(n, n_dim, n_dim) growth tensor F_g, in the plane for a planar body."""
        return growth_tensor(self.stretch(time), self.tangential, self.across, self.stretch_across(time))

    def inverse(self, time: float) -> FloatArray:
        """(n, n_dim, n_dim) its inverse: the same form with 1 / lambda_g."""
        across = 1.0 / self.stretch_across(time)
        return growth_tensor(1.0 / self.stretch(time), self.tangential, self.across, across)

    def out_of_plane(self, time: float) -> FloatArray:
        """(n,) entry F_g,33 of a planar body; ones in space."""
        stretch = self.stretch(time)
        if self.across.shape[1] == 3:
            return np.ones_like(stretch)
        return out_of_plane_growth(stretch, self.out_of_plane_rule, self.exponent)

    def volume(self, time: float) -> FloatArray:
        """(n,) J_g = det F_g, the 33 entry included."""
        stretch = self.stretch(time)
        across = np.where(self.tangential, self.stretch_across(time), stretch)
        in_plane = stretch ** (self.across.shape[1] - 1) * across
        return np.asarray(in_plane * self.out_of_plane(time))
