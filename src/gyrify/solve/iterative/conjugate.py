r"""Preconditioned conjugate gradients that end at the first direction of negative curvature.

.. math:: A x = b, \quad d^T A d \le 0

There is then no minimum of x A x / 2 - b x, and the direction tells by how much the matrix must at least be
shifted (Steihaug 1983; Nocedal and Wright, Numerical Optimization, section 7.1).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gyrify.solve.types import FloatArray

# Curvature over that of the first direction, both over the preconditioner's, below which it counts as none.
_NO_CURVATURE = 1e-13


@dataclass(frozen=True, eq=False)
class Ended:
    """How it ended.

    Attributes
    ----------
    x : float array
        The last iterate: of negative curvature none, the one before it was met.
    iterations : int
        Products with the matrix.
    residual : float
        Norm of b - A x over that of b.
    negative : float array or None
        Direction d with d^T A d <= 0; None where none was met.
    """

    x: FloatArray
    iterations: int
    residual: float
    negative: FloatArray | None


def conjugate_gradients(
    product: Callable[[FloatArray], FloatArray],
    right: FloatArray,
    precondition: Callable[[FloatArray], FloatArray],
    tolerance: float,
    max_iterations: int,
    watch: Callable[[], None] = lambda: None,
) -> Ended:
    """Solve A x = b to a relative residual, or up to the first direction of negative curvature.

    Parameters
    ----------
    product : callable
        A x of x.
    right : (n,) float array
        b.
    precondition : callable
        B x of x with B positive definite, near the inverse of A.
    tolerance : float
        Norm of the residual over that of b.
    max_iterations : int
        Products at most.
    watch : callable
        Called now and then; may raise to stop.

    Returns
    -------
    Ended
    """
    x, residual = np.zeros_like(right), right.copy()
    goal, size = tolerance * norm(right), norm(right)
    if size == 0.0:
        return Ended(x, 0, 0.0, None)
    z = precondition(residual)
    d, rz = z.copy(), dot(residual, z)
    first = 0.0
    for iteration in range(1, max_iterations + 1):
        if iteration % 50 == 0:
            watch()
        Ad = product(d)
        curvature = dot(d, Ad)
        first = first or abs(curvature) / rz
        # of the preconditioned matrix: d and Ad as they are would be small near the end
        if not curvature > _NO_CURVATURE * first * rz:
            return Ended(x, iteration, size and norm(residual) / size, d)
        step = rz / curvature
        x += step * d
        residual -= step * Ad
        if norm(residual) <= goal:
            return Ended(x, iteration, norm(residual) / size, None)
        z = precondition(residual)
        rz, before = dot(residual, z), rz
        d *= rz / before
        d += z
    return Ended(x, max_iterations, norm(residual) / size, None)


def dot(a: FloatArray, b: FloatArray) -> float:
    """Scalar product, not by BLAS, whose sums depend on the number of threads."""
    return float(np.einsum("i,i->", a, b))


def norm(a: FloatArray) -> float:
    """Euclidean norm, likewise."""
    return float(np.sqrt(dot(a, a)))
