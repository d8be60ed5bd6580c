"""Sinusoidal increments on a layer or a half-space in uniform stretch: stiffness of a surface against a wave.

The increment is U(Y) cos kX across the layers and V(Y) sin kX along them, in the reference coordinates X, Y.
In the scaled depth kY everything is free of k. With H = (U', V, -U, V') the increments of (F_11, F_22, F_12,
F_21), equilibrium is a constant first-order system for (U, V) and the tractions (S_1, S_2).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import expm, schur

FloatArray = NDArray[np.float64]

# H = _ACROSS q' + _ALONG q with q = (U, V)
_ACROSS = np.array([[1.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 1.0]])
_ALONG = np.array([[0.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, 0.0]])
# Largest growth exponent of one step through a film, lest the growing exponentials drown the others and a
# change of sign be passed unseen.
_STEP = 2.0


def state_matrix(tangent: FloatArray, incompressible_stretch: ArrayLike | None = None) -> FloatArray:
    """Matrix N of d/d(kY) (q, S/k) = N (q, S/k), with q = (U, V) and S its tractions.

    Parameters
    ----------
    tangent : (4, 4) float array
        In-plane tangent [Pa], in the order F_11, F_22, F_12, F_21 (1 across, 2 along the layers).
    incompressible_stretch : (2,) array_like, optional
        Total stretches (F_11, F_22) [-] of an incompressible tissue; the increment then keeps the volume.

    Returns
    -------
    (4, 4) float array
        N; the blocks are [-], [1/Pa], [Pa], [-].
    """
    k11 = _ACROSS.T @ tangent @ _ACROSS
    k10 = _ACROSS.T @ tangent @ _ALONG
    k00 = _ALONG.T @ tangent @ _ALONG
    source = np.hstack([-k10, np.eye(2)])
    to_force = k10.T
    if incompressible_stretch is not None:
        across, along = np.asarray(incompressible_stretch, dtype=np.float64)
        # Unknowns q' and the pressure increment; along U' + across V = 0.
        constraint = np.array([along, 0.0])
        k11 = np.block([[k11, -constraint[:, None]], [constraint[None, :], np.zeros((1, 1))]])
        source = np.vstack([source, [0.0, -across, 0.0, 0.0]])
        to_force = np.hstack([to_force, [[0.0], [-across]]])
    rate = np.linalg.solve(k11, source)
    return np.vstack([rate[:2], to_force @ rate + np.hstack([k00, np.zeros((2, 2))])])


def half_space_stiffness(matrix: FloatArray, above: bool = False) -> FloatArray:
    """Stiffness Z of the surface of a half-space: a wave q costs k/2 q^T Z q per area, averaged.

    Parameters
    ----------
    matrix : (4, 4) float array
        N of `state_matrix`.
    above : bool
        Whether the tissue fills Y > 0 instead of Y < 0.

    Returns
    -------
    (2, 2) float array
        Z [Pa], symmetric; NaN where the tissue itself has lost strong ellipticity, so that no wave decays.
    """
    # Tractions in units of the tissue's own stiffness, or those of a very soft one would drown in rounding.
    unit = float(np.sqrt(np.linalg.norm(matrix[2:, :2]) / np.linalg.norm(matrix[:2, 2:])))
    scale = np.array([1.0, 1.0, unit, unit])
    _, vectors, count = schur(matrix * scale / scale[:, None], output="real", sort="lhp" if above else "rhp")
    if count != 2:
        return np.full((2, 2), np.nan)
    stiffness = unit * np.linalg.solve(vectors[:2, :2].T, vectors[2:, :2].T).T
    return -stiffness if above else stiffness


def layered_stiffness(matrix: FloatArray, below: FloatArray, scaled_thickness: ArrayLike) -> FloatArray:
    """Stiffness Z of the free top of a film on a support.

    Parameters
    ----------
    matrix : (..., 4, 4) float array
        N of the film.
    below : (..., 2, 2) float array
        Z [Pa] of the support.
    scaled_thickness : (...) array_like
        k h [-], with k and h in the reference configuration.

    Returns
    -------
    (..., 2, 2) float array
        Z [Pa], symmetric; NaN where the film is unstable even if its top is held, and the support's NaN.
    """
    thickness = np.asarray(scaled_thickness, dtype=np.float64)
    rates = np.max(np.abs(np.linalg.eigvals(matrix)), axis=-1)
    steps = max(1, int(np.ceil(np.max(rates * thickness) / _STEP)))
    passage = expm(matrix * (thickness / steps)[..., None, None])
    support = np.broadcast_to(below, (*passage.shape[:-2], 2, 2))
    held = np.asarray(np.isfinite(support).all(axis=(-1, -2)))
    stiffness = np.where(held[..., None, None], support, 0.0)
    for _ in range(steps):
        surface = passage[..., :2, :2] + passage[..., :2, 2:] @ stiffness
        traction = passage[..., 2:, :2] + passage[..., 2:, 2:] @ stiffness
        # The determinant starts at one; where it changes sign, Z passes minus infinity on its way up.
        held = held & (np.linalg.det(surface) > 0.0)
        surface = np.where(held[..., None, None], surface, np.eye(2))
        stiffness = np.swapaxes(
            np.linalg.solve(np.swapaxes(surface, -1, -2), np.swapaxes(traction, -1, -2)), -1, -2
        )
        stiffness = np.where(held[..., None, None], stiffness, 0.0)
    return np.where(held[..., None, None], stiffness, np.nan)


def lowest_stiffness(stiffness: FloatArray) -> FloatArray:
    """Lowest eigenvalue [Pa] of Z (..., 2, 2); minus infinity where Z does not exist."""
    safe = np.asarray(np.isfinite(stiffness).all(axis=(-1, -2)))
    filled = np.where(safe[..., None, None], stiffness, np.eye(2))
    symmetric = 0.5 * (filled + np.swapaxes(filled, -1, -2))
    return np.where(safe, np.linalg.eigvalsh(symmetric)[..., 0], -np.inf)
