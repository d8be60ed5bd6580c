"""Elastic forces and stiffness against finite differences, symbolic differentiation and the complex step."""

from __future__ import annotations

import bodies
import numpy as np
import pytest
from differences import assert_derivatives, dense_hessian
from oracle import area, complex_step, deformation, embedded, neo_hookean, symbolic_triangle

STEPS = 10.0 ** -np.arange(1.0, 9.5, 0.5)


@pytest.mark.parametrize("kind", ["ungrown", "isotropic", "tangential", "out_of_plane"])
def test_error_of_differences_is_a_v(rng: np.random.Generator, kind: str) -> None:
    points, cells, _ = bodies.distorted_square(rng)
    n = len(cells)
    isotropic = rng.uniform(1.0, 1.8, n)
    tangential, F_g33 = bodies.random_growth(rng, n)
    growth = {
        "ungrown": (None, None),
        "isotropic": (isotropic[:, None, None] * np.eye(2), isotropic),
        "tangential": (tangential, isotropic),
        "out_of_plane": (None, F_g33),
    }[kind]
    u, du = 0.02 * rng.standard_normal((2, *points.shape))
    assert_derivatives(bodies.elastic(points, cells, *growth), u, du, STEPS)


def test_error_of_differences_is_a_v_in_space(rng: np.random.Generator) -> None:
    """The same kernels, for tetrahedra: two that share a face, with isotropic and oblique growth."""
    points = np.array([[0, 0, 0], [1, 0.1, 0], [0.1, 1, 0.1], [0, 0.2, 1], [0.9, 0.8, 0.7]])
    cells = np.array([[0, 1, 2, 3], [1, 4, 2, 3]])
    N = np.array([1.0, 2.0, 2.0]) / 3.0
    F_g = np.stack([1.4 * np.eye(3), 1.4 * np.eye(3) - 0.4 * np.outer(N, N)])
    term = bodies.elastic(points, cells, F_g, np.ones(2))
    assert np.all(term.kinematics.volumes > 0)
    u, du = 0.05 * rng.standard_normal((2, *points.shape))
    assert_derivatives(term, u, du, STEPS)


def test_energy_of_a_tetrahedron_has_no_embedding() -> None:
    """F = 2 I in space: J = 8, I1 = 12, W = mu/2 (12/4 - 3) + kappa/2 7^2 = 24.5 kappa; volume 1/6."""
    points = np.concatenate([np.zeros((1, 3)), np.eye(3)])
    term = bodies.elastic(points, np.array([[0, 1, 2, 3]]))
    assert term.evaluate(points.copy(), 0).value == pytest.approx(24.5 * bodies.KAPPA / 6, rel=1e-14)


def test_energy_forces_and_stiffness_equal_the_symbolic_ones(rng: np.random.Generator) -> None:
    """Every triangle has its own shape, growth and deformation; the Hessian is a row of 6 x 6 blocks."""
    n, oracle = 40, symbolic_triangle()
    points, cells = bodies.separate_triangles(rng, n)
    F_g, F_g33 = bodies.random_growth(rng, n)
    term = bodies.elastic(points, cells, F_g, F_g33)
    u = 0.1 * rng.standard_normal(points.shape)
    found = term.evaluate(u, 2)
    hessian, energy = dense_hessian(found.hessian, u.size), 0.0
    for c in range(n):
        X, mine = points[cells[c]], slice(6 * c, 6 * c + 6)
        W, gradient, block = oracle(X, u[cells[c]], F_g[c], F_g33[c], bodies.MU, bodies.KAPPA)
        weight = area(X[None])[0] * np.linalg.det(F_g[c]) * F_g33[c]
        energy += weight * W
        for found_part, part in ((found.gradient.ravel()[mine], gradient), (hessian[mine, mine], block)):
            assert found_part == pytest.approx(weight * part, abs=1e-12 * weight * abs(part).max())
    assert found.value == pytest.approx(energy, rel=1e-12)


def test_forces_equal_the_complex_step(rng: np.random.Generator) -> None:
    points, cells, _ = bodies.distorted_square(rng)
    F_g, F_g33 = bodies.random_growth(rng, len(cells))
    u = 0.02 * rng.standard_normal(points.shape)
    X = points[cells]
    inverse = np.linalg.inv(embedded(F_g, F_g33))

    def energies(flat: np.ndarray) -> np.ndarray:
        F = embedded(deformation(X, flat.reshape(-1, 3, 2)), 1.0) @ inverse
        return area(X) / np.linalg.det(inverse) * neo_hookean(F, bodies.MU, bodies.KAPPA)

    expected = np.zeros_like(u)
    np.add.at(expected, cells, complex_step(energies, u[cells].reshape(-1, 6)).reshape(-1, 3, 2))
    found = bodies.elastic(points, cells, F_g, F_g33).evaluate(u, 1).gradient
    assert found == pytest.approx(expected, abs=1e-12 * abs(expected).max())


def test_stress_of_the_arrays_is_that_of_the_kernel(rng: np.random.Generator) -> None:
    """Forces on a triangle are weight P grad N; P33 is the derivative by the out-of-plane stretch."""
    from gyrify.physics.materials import NEO_HOOKEAN
    from gyrify.physics.stress import energy_density, first_piola

    n, h = 30, 1e-30
    F, f33 = np.eye(2) + rng.uniform(-0.3, 0.3, (n, 2, 2)), rng.uniform(0.5, 1.2, n)
    mu, kappa = rng.uniform(1, 4, n), rng.uniform(5, 30, n)
    W = energy_density(NEO_HOOKEAN, F, f33, np.stack([mu, kappa]))
    assert pytest.approx(neo_hookean(embedded(F, f33), mu, kappa), rel=1e-12) == W
    P, P33 = first_piola(NEO_HOOKEAN, F, f33, np.stack([mu, kappa]))
    in_plane = F.reshape(n, 4)
    expected = complex_step(lambda z: neo_hookean(embedded(z.reshape(-1, 2, 2), f33), mu, kappa), in_plane)
    assert P.reshape(n, 4) == pytest.approx(expected, abs=1e-12 * abs(expected).max())
    by_f33 = neo_hookean(embedded(F.astype(complex), f33 + 1j * h), mu, kappa).imag / h
    assert pytest.approx(by_f33, abs=1e-12 * abs(by_f33).max()) == P33
