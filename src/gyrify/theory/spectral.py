"""One-dimensional high-order elements: Gauss-Lobatto-Legendre nodes, Gauss-Legendre quadrature.

The matrices are dense on purpose: some ninety nodes reach 1e-10, and everything that is linear in the nodal
values becomes one matrix product.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]


def lobatto_points(degree: int) -> FloatArray:
    """Gauss-Lobatto-Legendre points on [-1, 1].

    Parameters
    ----------
    degree : int
        Polynomial degree, at least 1.

    Returns
    -------
    (degree + 1,) float array
        The ends and the roots of the derivative of the Legendre polynomial [-].
    """
    inner = legendre.legroots(legendre.legder([0.0] * degree + [1.0])) if degree > 1 else np.empty(0)
    # All roots are real; from NumPy 2.5 on they come as complex numbers all the same.
    return np.concatenate([[-1.0], np.sort(inner.real), [1.0]])


def lagrange(degree: int, x: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Lagrange polynomials through the Lobatto points, and their derivatives.

    Parameters
    ----------
    degree : int
        Polynomial degree.
    x : (n,) array_like
        Places in [-1, 1].

    Returns
    -------
    tuple of (n, degree + 1) float array
        Values and derivatives [-].
    """
    # A Legendre Vandermonde matrix on Lobatto points is well conditioned at any degree used here.
    modal = np.linalg.inv(legendre.legvander(lobatto_points(degree), degree))
    values = legendre.legvander(np.asarray(x, dtype=np.float64), degree)
    derivative = np.zeros((degree + 1, degree + 1))
    derivative[:degree] = legendre.legder(np.eye(degree + 1))
    return values @ modal, values @ derivative @ modal


@dataclass(frozen=True, eq=False)
class Line:
    """A line cut into elements of one degree.

    Attributes
    ----------
    edges : (n_elements + 1,) float array
        Ends of the elements [mm], increasing.
    degree : int
        Polynomial degree.
    nodes : (n_nodes,) float array
        Lobatto nodes [mm], shared between neighbours.
    points, weights : (n_points,) float array
        Gauss points and weights [mm].
    values, slopes : (n_points, n_nodes) float array
        From nodal values to the function [-] and to its derivative [1/mm] at the points.
    """

    edges: FloatArray
    degree: int
    nodes: FloatArray
    points: FloatArray
    weights: FloatArray
    values: FloatArray
    slopes: FloatArray

    @classmethod
    def build(cls, edges: ArrayLike, degree: int) -> Line:
        """Elements between the given edges [mm]."""
        ends = np.asarray(edges, dtype=np.float64)
        half = 0.5 * np.diff(ends)
        middle = 0.5 * (ends[:-1] + ends[1:])
        local = lobatto_points(degree)
        nodes = np.append((middle[:, None] + half[:, None] * local[:-1]).ravel(), ends[-1])
        # Two points more than the degree: 1/R and the energy are not polynomials.
        place, weight = legendre.leggauss(degree + 2)
        points = (middle[:, None] + half[:, None] * place).ravel()
        values, slopes = _matrices(ends, degree, points)
        return cls(ends, degree, nodes, points, (half[:, None] * weight).ravel(), values, slopes)

    def at(self, places: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Matrices (n, n_nodes) from nodal values to values [-] and derivatives [1/mm] at places [mm]."""
        return _matrices(self.edges, self.degree, np.atleast_1d(np.asarray(places, dtype=np.float64)))


def _matrices(edges: FloatArray, degree: int, places: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Dense value and derivative matrices of the elements at any places."""
    element = np.clip(np.searchsorted(edges, places, side="right") - 1, 0, len(edges) - 2)
    half = 0.5 * (edges[element + 1] - edges[element])
    local, slope = lagrange(degree, (places - edges[element]) / half - 1.0)
    columns = element[:, None] * degree + np.arange(degree + 1)
    rows = np.arange(len(places))[:, None]
    values = np.zeros((len(places), (len(edges) - 1) * degree + 1))
    slopes = np.zeros_like(values)
    values[rows, columns] = local
    slopes[rows, columns] = slope / half[:, None]
    return values, slopes
