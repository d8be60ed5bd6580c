r"""Stress and tangent of an isotropic solid W(I1, J).

With :math:`H = F^{-T}` and :math:`(H \boxtimes H)_{ijkl} = H_{il} H_{kj}`,

.. math::
   P &= a F + b H, \\
   \mathbb{C} = dP/dF &= a \, I + c \, H \otimes H + d \, F \otimes F + e \, (F \otimes H + H \otimes F)
   - b \, H \boxtimes H,

a = 2 W_1, b = J W_J, c = J W_J + J^2 W_JJ, d = 4 W_11, e = 2 J W_1J. In the plane, F is the block of a
three-dimensional gradient whose 33 entry is held: J and I1 are formed with it, and the formulas stay.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gyrify.base.compiled import njit
from gyrify.physics.neo_hookean import density, derivatives

FloatArray = NDArray[np.float64]


@njit(cache=True, inline="always")
def coefficients(I1, J, cube_root, mu, kappa, pressure):  # type: ignore[no-untyped-def]
    """a, b, c, d, e [Pa] of stress and tangent; a given pressure is added to dW/dJ."""
    W_1, W_J, W_11, W_1J, W_JJ = derivatives(I1, J, cube_root, mu, kappa)
    b = J * (W_J + pressure)
    return 2.0 * W_1, b, b + J * J * W_JJ, 4.0 * W_11, 2.0 * J * W_1J


def energy_density(F: FloatArray, f33: FloatArray, mu: FloatArray, kappa: FloatArray) -> FloatArray:
    """Energy density of each cell.

    Parameters
    ----------
    F : (n_cells, n_dim, n_dim) float array
        Elastic deformation gradient in the plane.
    f33 : (n_cells,) float array
        Out-of-plane elastic stretch.
    mu, kappa : (n_cells,) float array
        Shear and bulk modulus [Pa].

    Returns
    -------
    (n_cells,) float array
        W [Pa].
    """
    I1, J = invariants(F, f33)
    return np.asarray(density.py_func(I1, J, np.cbrt(J), mu, kappa))


def first_piola(
    F: FloatArray, f33: FloatArray, mu: FloatArray, kappa: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """First Piola stress dW/dF of each cell; parameters as in `energy_density`.

    Returns
    -------
    P : (n_cells, n_dim, n_dim) float array
        In-plane block [Pa].
    P33 : (n_cells,) float array
        Out-of-plane entry [Pa].
    """
    I1, J = invariants(F, f33)
    W_1, W_J, _, _, _ = derivatives.py_func(I1, J, np.cbrt(J), mu, kappa)
    H = np.swapaxes(np.linalg.inv(F), 1, 2)
    P = (2.0 * W_1)[:, None, None] * F + (J * W_J)[:, None, None] * H
    return P, 2.0 * W_1 * f33 + J * W_J / f33


def invariants(F: FloatArray, f33: FloatArray) -> tuple[FloatArray, FloatArray]:
    """I1 = tr F F^T and J = det F of the embedded gradient; parameters as in `energy_density`."""
    out_of_plane = f33 * f33 if F.shape[1] == 2 else 0.0
    return np.einsum("cij,cij->c", F, F) + out_of_plane, np.linalg.det(F) * f33
