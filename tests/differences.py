"""Finite differences of energy terms, and what their error must look like."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np


def dense_hessian(hessian, n_dofs: int) -> np.ndarray:
    """Full matrix of a Hessian that is stored as an upper triangle."""
    upper = np.zeros((n_dofs, n_dofs))
    np.add.at(upper, (hessian.pattern.rows, hessian.pattern.cols), hessian.values)
    return upper + np.triu(upper, 1).T


def error_curve(
    function: Callable[[np.ndarray], np.ndarray],
    u: np.ndarray,
    du: np.ndarray,
    exact: np.ndarray,
    steps: np.ndarray,
) -> np.ndarray:
    """Relative error of the central difference of a function along du, for every step."""
    scale = np.linalg.norm(exact)
    differences = [(function(u + h * du) - function(u - h * du)) / (2 * h) for h in steps]
    return np.array([np.linalg.norm(difference - exact) / scale for difference in differences])


def assert_v_shape(steps: np.ndarray, errors: np.ndarray, lowest: float = 1e-8) -> None:
    """The error falls as h^2 (a hundredfold per decade), reaches round-off, and rises again as round-off / h.

    A wrong derivative leaves the error flat at its own size, and no V appears.
    """
    table = "\n".join(f"h = {h:.1e}  error = {error:.2e}" for h, error in zip(steps, errors, strict=True))
    bottom = int(np.argmin(errors))
    assert errors[bottom] < lowest, table
    assert 1 < bottom < len(steps) - 1, table
    slopes = np.diff(np.log(errors[:bottom])) / np.diff(np.log(steps[:bottom]))
    assert np.any(np.abs(slopes - 2.0) < 0.1), table
    assert errors[-1] > 10.0 * errors[bottom], table


def assert_derivatives(term, u: np.ndarray, du: np.ndarray, steps: np.ndarray, lowest: float = 1e-8) -> None:
    """Gradient against the energy, and Hessian against the gradient, along a direction."""
    evaluation = term.evaluate(u, 2)
    slope = np.array([np.sum(evaluation.gradient * du)])
    energy = error_curve(lambda v: np.array([term.evaluate(v, 0).value]), u, du, slope, steps)
    assert_v_shape(steps, energy, lowest)
    curvature = dense_hessian(evaluation.hessian, u.size) @ du.ravel()
    force = error_curve(lambda v: term.evaluate(v, 1).gradient.ravel(), u, du, curvature, steps)
    assert_v_shape(steps, force, lowest)
