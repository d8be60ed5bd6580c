"""Lobatto points and the matrices of a line, against what they must do to polynomials."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial import legendre

from gyrify.theory.spectral import Line, lagrange, lobatto_points


@pytest.mark.parametrize(
    ("degree", "inner"),
    [(1, []), (2, [0.0]), (3, [-(0.2**0.5), 0.2**0.5]), (4, [-((3 / 7) ** 0.5), 0.0, (3 / 7) ** 0.5])],
)
@pytest.mark.parametrize("kind", [float, complex])
def test_points_are_those_of_the_tables(
    degree: int, inner: list[float], kind: type, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whether NumPy gives real roots as real numbers, as it did before 2.5, or as complex ones."""
    roots = legendre.legroots
    monkeypatch.setattr(legendre, "legroots", lambda series: roots(series).astype(kind))
    points = lobatto_points(degree)
    assert points.dtype == np.float64
    np.testing.assert_allclose(points, [-1.0, *inner, 1.0], atol=1e-15)


@pytest.mark.parametrize("degree", [1, 2, 5, 9])
def test_polynomials_of_the_degree_are_exact(degree: int) -> None:
    line = Line.build([1.0, 1.5, 3.0], degree)
    assert {getattr(line, name).dtype.name for name in ("nodes", "points", "values", "slopes")} == {"float64"}
    np.testing.assert_allclose(line.values @ line.nodes**degree, line.points**degree, rtol=1e-12)
    slopes = degree * line.points ** (degree - 1)
    np.testing.assert_allclose(line.slopes @ line.nodes**degree, slopes, rtol=1e-11)
    assert line.weights @ line.points**degree == pytest.approx((3.0 ** (degree + 1) - 1.0) / (degree + 1))


def test_values_at_the_points_themselves_are_the_unit_matrix() -> None:
    values, slopes = lagrange(6, lobatto_points(6))
    np.testing.assert_allclose(values, np.eye(7), atol=1e-13)
    np.testing.assert_allclose(slopes.sum(axis=1), 0.0, atol=1e-12)
