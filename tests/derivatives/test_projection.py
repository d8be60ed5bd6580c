"""Projection of cell matrices onto the semi-definite ones."""

from __future__ import annotations

import bodies
import numpy as np
from differences import dense_hessian

from gyrify.energy.projection import is_positive_definite, project_to_psd


def test_projection_is_the_nearest_semi_definite_matrix(rng: np.random.Generator) -> None:
    """Eigenvalues below zero become zero, the others and all directions stay."""
    for n in (2, 4, 9):
        directions, _ = np.linalg.qr(rng.standard_normal((n, n)))
        values = rng.uniform(-1.0, 1.0, n)
        values[0] = -0.5
        A = (directions * values) @ directions.T
        A = (A + A.T) / 2
        assert not is_positive_definite(A)
        project_to_psd(A)
        np.testing.assert_allclose(A, (directions * np.maximum(values, 0.0)) @ directions.T, atol=1e-14)


def test_projection_leaves_a_definite_matrix_alone(rng: np.random.Generator) -> None:
    half = rng.standard_normal((4, 4))
    A = half @ half.T + 0.1 * np.eye(4)
    before = A.copy()
    project_to_psd(A)
    assert is_positive_definite(A)
    np.testing.assert_array_equal(A, before)


def test_projected_cells_are_semi_definite_and_else_exact(rng: np.random.Generator) -> None:
    """Stretched and squeezed triangles: some have a semi-definite matrix, some do not."""
    n = 200
    points, cells = bodies.separate_triangles(rng, n)
    term = bodies.elastic(points, cells)
    u = 0.1 * rng.standard_normal(points.shape) + np.repeat(rng.uniform(-0.3, 0.5, n), 3)[:, None] * points
    # triangles that this would invert stay at rest
    bad = np.repeat(np.linalg.det(term.kinematics.deformation(u)) <= 0.02, 3)
    u[bad] = 0.0
    exact, projected = (_blocks(term, u, p) for p in (False, True))
    n_exact = 0
    for A, B in zip(exact, projected, strict=True):
        scale = abs(A).max()
        values = np.linalg.eigvalsh(A)
        assert np.linalg.eigvalsh(B).min() > -1e-12 * scale
        if values.min() > -1e-12 * scale:
            n_exact += 1
            np.testing.assert_allclose(B, A, atol=1e-12 * scale)
        else:
            assert abs(B - A).max() > 1e-6 * abs(values.min())
    assert 10 < n_exact < n - 10


def _blocks(term, u: np.ndarray, project_psd: bool) -> list[np.ndarray]:
    whole = dense_hessian(term.evaluate(u, 2, project_psd).hessian, u.size)
    return [whole[k : k + 6, k : k + 6] for k in range(0, u.size, 6)]
