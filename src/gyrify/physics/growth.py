"""Growth as thermal expansion: F = F_e F_g (paper, Eqs 3-5)."""

from __future__ import annotations

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


def growth_tensor(stretch: FloatArray, tangential: NDArray[np.bool_], across: FloatArray) -> FloatArray:
    """In-plane growth tensor of each cell.

    Parameters
    ----------
    stretch : (n_cells,) float array
        Growth stretch lambda_g.
    tangential : (n_cells,) bool array
        Where growth is tangential, F_g = lambda_g (I - N N) + N N; elsewhere F_g = lambda_g I.
    across : (n_cells, n_dim) float array
        Unit reference direction N across the layers.

    Returns
    -------
    (n_cells, n_dim, n_dim) float array
        Symmetric positive definite F_g.
    """
    n_dim = across.shape[1]
    tensor = stretch[:, None, None] * np.eye(n_dim)
    if not tangential.any():
        return tensor
    normal = np.where(tangential, 1.0 - stretch, 0.0)
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
