r"""Energy, stress and tangent of a material at given deformation gradients; nobody else forms a stress.

For a solid W(I1, J), with :math:`H = F^{-T}` and :math:`(H \boxtimes H)_{ijkl} = H_{il} H_{kj}`,

.. math::
   P &= a F + b H, \\
   \mathbb{C} = dP/dF &= a \, I + c \, H \otimes H + d \, F \otimes F + e \, (F \otimes H + H \otimes F)
   - b \, H \boxtimes H,

a = 2 W_1, b = J W_J, c = J W_J + J^2 W_JJ, d = 4 W_11, e = 2 J W_1J. For a solid W(s_1, s_2, s_3) of the
principal stretches, with the principal directions n of space and N of the grown tissue,

.. math::
   P = \sum_i W_i \, n_i \otimes N_i, \quad
   \mathbb{C} = \sum_{ij} W_{ij} \, n_i N_i \otimes n_j N_j
   + \sum_{i \ne j} \left( \frac{s_i W_i - s_j W_j}{s_i^2 - s_j^2} \, n_i N_j \otimes n_i N_j
   + \frac{s_j W_i - s_i W_j}{s_i^2 - s_j^2} \, n_i N_j \otimes n_j N_i \right) .

In the plane, F is the block of a three-dimensional gradient whose 33 entry is held: J and I1 are formed with
it, and the formulas stay.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gyrify.base.compiled import njit
from gyrify.physics.materials import Material
from gyrify.physics.materials.dispatch import derivatives

FloatArray = NDArray[np.float64]
# Every point: what takes the place of a single one's number.
_ALL = slice(None)
# Relative distance of two squared stretches below which their difference quotients take the limit.
EQUAL = 1e-6


@njit(cache=True, inline="always")
def coefficients(material, I1, J, cube_root, p, c, pressure):  # type: ignore[no-untyped-def]
    """a, b, c, d, e [Pa] of stress and tangent; a given pressure is added to dW/dJ."""
    W_1, W_J, W_11, W_1J, W_JJ = derivatives(material, I1, J, cube_root, p, c)  # type: ignore[no-untyped-call]
    b = J * (W_J + pressure)
    return 2.0 * W_1, b, b + J * J * W_JJ, 4.0 * W_11, 2.0 * J * W_1J


def energy_density(material: Material, F: FloatArray, f33: FloatArray, parameters: FloatArray) -> FloatArray:
    """Energy density of each point.

    Parameters
    ----------
    material : Material
        Which solid.
    F : (n, n_dim, n_dim) float array
        Elastic deformation gradient in the plane.
    f33 : (n,) float array
        Out-of-plane elastic stretch.
    parameters : (n_parameters, n) float array
        Of the material.

    Returns
    -------
    (n,) float array
        W [Pa].
    """
    if material.form == "stretches":
        stretches = _stretches(F, f33)[0]
        return np.asarray(_plain(material.density)(*stretches, parameters, _ALL))
    I1, J = invariants(F, f33)
    return np.asarray(_plain(material.density)(I1, J, np.cbrt(J), parameters, _ALL))


def first_piola(
    material: Material, F: FloatArray, f33: FloatArray, parameters: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """First Piola stress dW/dF of each point; parameters as in `energy_density`.

    Returns
    -------
    P : (n, n_dim, n_dim) float array
        In-plane block [Pa].
    P33 : (n,) float array
        Out-of-plane entry [Pa].
    """
    if material.form == "stretches":
        stretches, n, N = _stretches(F, f33)
        W = np.stack(_plain(material.derivatives)(*stretches, parameters, _ALL)[:3])
        d = F.shape[1]
        return np.einsum("ac,cia,cja->cij", W[:d], n, N), W[2]
    I1, J = invariants(F, f33)
    W_1, W_J, _, _, _ = _plain(material.derivatives)(I1, J, np.cbrt(J), parameters, _ALL)
    H = np.swapaxes(np.linalg.inv(F), 1, 2)
    P = (2.0 * W_1)[:, None, None] * F + (J * W_J)[:, None, None] * H
    return P, 2.0 * W_1 * f33 + J * W_J / f33


def planar_cauchy(
    material: Material,
    F: FloatArray,
    f33: FloatArray,
    J: FloatArray,
    parameters: FloatArray,
    pressure: FloatArray | None = None,
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Cauchy stress of each point of a planar body.

    Parameters
    ----------
    material, f33, parameters
        As in `energy_density`.
    F : (2, 2, n) float array
        Elastic deformation gradient in the plane, points last.
    J : (n,) float array
        Its volume ratio, the 33 entry included.
    pressure : (n,) float array, optional
        kappa (J - 1) of elements that average it [Pa], in place of the material's own.

    Returns
    -------
    tuple of (n,) float arrays
        Components 11, 22, 33 and 12 [Pa]; 13 and 23 are zero.
    """
    if pressure is not None:
        parameters = np.concatenate([parameters[:-1], np.zeros_like(parameters[-1:])])
    if material.form == "stretches":
        return _planar_cauchy_by_stretches(material, F, f33, J, parameters, pressure)
    b11, b22 = F[0, 0] ** 2 + F[0, 1] ** 2, F[1, 0] ** 2 + F[1, 1] ** 2
    b33, b12 = f33**2, F[0, 0] * F[1, 0] + F[0, 1] * F[1, 1]
    W_1, W_J, *_ = _plain(material.derivatives)(b11 + b22 + b33, J, np.cbrt(J), parameters, _ALL)
    W_J += 0.0 if pressure is None else pressure
    factor = 2.0 * W_1 / J
    return factor * b11 + W_J, factor * b22 + W_J, factor * b33 + W_J, factor * b12


def cauchy(
    material: Material, F: FloatArray, parameters: FloatArray, pressure: FloatArray | None = None
) -> FloatArray:
    """Cauchy stress of a body in space.

    Parameters
    ----------
    material : Material
        Which solid.
    F : (n, 3, 3) float array
        Elastic deformation gradient.
    parameters : (n_parameters, n) float array
        Of the material; the last one is the bulk modulus [Pa].
    pressure : (n,) float array, optional
        Volumetric part of the stress [Pa], where it is not that of the material at F.

    Returns
    -------
    (n, 3, 3) float array
        [Pa].
    """
    J = np.linalg.det(F)
    if pressure is not None:
        parameters = np.concatenate([parameters[:-1], np.zeros_like(parameters[-1:])])
    extra = np.zeros_like(J) if pressure is None else pressure
    if material.form == "stretches":
        stretches, n, _ = _stretches(F, np.ones_like(J))
        W = np.stack(_plain(material.derivatives)(*stretches, parameters, _ALL)[:3])
        principal = W * stretches / J + extra
        return np.asarray(np.einsum("ac,cia,cja->cij", principal, n, n))
    b = np.einsum("cik,cjk->cij", F, F)
    I1 = np.trace(b, axis1=1, axis2=2)
    W_1, W_J, *_ = _plain(material.derivatives)(I1, J, np.cbrt(J), parameters, _ALL)
    return np.asarray((2.0 * W_1 / J)[:, None, None] * b + (W_J + extra)[:, None, None] * np.eye(3))


def _planar_cauchy_by_stretches(
    material: Material,
    F: FloatArray,
    f33: FloatArray,
    J: FloatArray,
    parameters: FloatArray,
    pressure: FloatArray | None,
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    stretches, n, _ = _stretches(np.moveaxis(F, 2, 0), f33)
    W = np.stack(_plain(material.derivatives)(*stretches, parameters, _ALL)[:3])
    principal = W * stretches / J + (0.0 if pressure is None else pressure)
    inside = np.einsum("ac,cia,cja->ijc", principal[:2], n, n)
    return inside[0, 0], inside[1, 1], principal[2], inside[0, 1]


def response(
    material: Material, F: FloatArray, f33: FloatArray, parameters: FloatArray, pressure: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Stress and tangent of each point of a planar body; parameters as in `energy_density`.

    ``pressure`` is added to dW/dJ [Pa].

    Returns
    -------
    stress : (n, 4) float array
        First Piola stress, row by row [Pa].
    tangent : (n, 4, 4) float array
        Its derivative by F [Pa].
    """
    J = np.linalg.det(F) * f33
    if material.form == "stretches":
        return _response_by_stretches(material, F, f33, J, parameters, pressure)
    I1 = np.einsum("cij,cij->c", F, F) + f33 * f33
    W_1, W_J, W_11, W_1J, W_JJ = _plain(material.derivatives)(I1, J, np.cbrt(J), parameters, _ALL)
    b = J * (W_J + pressure)
    H3 = np.swapaxes(np.linalg.inv(F), 1, 2)
    f, h = F.reshape(-1, 4), H3.reshape(-1, 4)
    box = np.einsum("cil,ckj->cijkl", H3, H3).reshape(-1, 4, 4)
    pairs = (
        (b + J * J * W_JJ, h[:, :, None] * h[:, None, :]),
        (4.0 * W_11 + 0.0 * J, f[:, :, None] * f[:, None, :]),
        (2.0 * J * W_1J, f[:, :, None] * h[:, None, :] + h[:, :, None] * f[:, None, :]),
        (-b, box),
    )
    tangent = (2.0 * W_1)[:, None, None] * np.eye(4)
    for factor, matrix in pairs:
        tangent = tangent + factor[:, None, None] * matrix
    return (2.0 * W_1)[:, None] * f + b[:, None] * h, tangent


def _response_by_stretches(
    material: Material,
    F: FloatArray,
    f33: FloatArray,
    J: FloatArray,
    parameters: FloatArray,
    pressure: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    stretches, n, N = _stretches(F, f33)
    a, b, _ = stretches
    W_a, W_b, _, W_aa, W_bb, _, W_ab, _, _ = _plain(material.derivatives)(*stretches, parameters, _ALL)
    W_a, W_b, W_ab = W_a + pressure * J / a, W_b + pressure * J / b, W_ab + pressure * J / (a * b)
    apart = a * a - b * b
    is_near = np.abs(apart) <= EQUAL * (a * a + b * b)
    quotient = np.where(is_near, 1.0, apart)
    along = np.where(is_near, 0.5 * (W_aa - W_ab + W_a / a), (a * W_a - b * W_b) / quotient)
    across = np.where(is_near, 0.5 * (W_aa - W_ab - W_a / a), (b * W_a - a * W_b) / quotient)
    frames = np.einsum("cia,cjb->cabij", n, N).reshape(-1, 2, 2, 4)
    aa, bb, ab, ba = frames[:, 0, 0], frames[:, 1, 1], frames[:, 0, 1], frames[:, 1, 0]
    tangent = np.zeros((len(F), 4, 4))
    for factor, left, right in (
        (W_aa, aa, aa),
        (W_bb, bb, bb),
        (W_ab, aa, bb),
        (W_ab, bb, aa),
        (along, ab, ab),
        (along, ba, ba),
        (across, ab, ba),
        (across, ba, ab),
    ):
        tangent += factor[:, None, None] * left[:, :, None] * right[:, None, :]
    return W_a[:, None] * aa + W_b[:, None] * bb, tangent


def invariants(F: FloatArray, f33: FloatArray) -> tuple[FloatArray, FloatArray]:
    """I1 = tr F F^T and J = det F of the embedded gradient; parameters as in `energy_density`."""
    out_of_plane = f33 * f33 if F.shape[1] == 2 else 0.0
    return np.einsum("cij,cij->c", F, F) + out_of_plane, np.linalg.det(F) * f33


def _stretches(F: FloatArray, f33: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """(3, n) principal stretches, and (n, n_dim, n_dim) directions of space and of the tissue as columns."""
    left, values, right = np.linalg.svd(F)
    stretches = [*values.T, f33] if F.shape[1] == 2 else list(values.T)
    return np.stack(stretches), left, np.swapaxes(right, 1, 2)


def _plain(compiled: Callable[..., Any]) -> Callable[..., Any]:
    """A compiled function as Python has it, for whole arrays."""
    plain: Callable[..., Any] = getattr(compiled, "py_func", compiled)
    return plain
