"""The contact barrier against finite differences and against the barrier written down once more."""

from __future__ import annotations

import bodies
import numpy as np
import pytest
from differences import assert_derivatives, dense_hessian
from oracle import barrier


def test_error_of_differences_is_a_v(rng: np.random.Generator) -> None:
    contact, u, _ = bodies.pinched_contact()
    du = rng.standard_normal(u.shape)
    # steps stay well below the gaps of 0.06 to 0.18
    assert_derivatives(contact, u, du, 10.0 ** -np.arange(3.0, 10.5, 0.5), lowest=1e-7)


def test_energy_and_forces_equal_the_barrier_written_down(rng: np.random.Generator) -> None:
    contact, u, d_hat = bodies.pinched_contact(stiffness=7.0)
    for _ in range(20):
        v = u + 0.01 * rng.standard_normal(u.shape)
        found = contact.evaluate(v, 1)
        energy, gradient = barrier(contact.surface.reference, contact.surface.vertices(v), d_hat, 7.0)
        assert energy > 0.0
        assert found.value == pytest.approx(energy, rel=1e-12)
        assert found.gradient == pytest.approx(gradient, abs=1e-11 * abs(gradient).max())


def test_one_vertex_before_one_edge_by_hand() -> None:
    """A vertex with d = d_hat / 2 before the middle of an edge: s = 1/4, b = (9/16) ln 4.

    The tip of a narrow spike, two sides of length sqrt(10) meeting, has the share A = sqrt(10); the energy is
    A k_b d_hat b / 2. Its force on the vertex pushes away from the edge:
    dE/dd = A k_b d_hat / 2 b'(s) 2 d / d_hat^2, b'(s) = -2 (s - 1) ln s - (s - 1)^2 / s = -(3/2) ln 4 - 9/4.
    """
    from gyrify.energy.contact import ContactEnergy, ContactSurface

    d_hat, k_b = 0.2, 7.0
    points = np.array([[-4, 0], [4, 0], [4, 3.1], [1, 3.1], [0, 0.1], [-1, 3.1], [-4, 3.1]], dtype=float)
    term = ContactEnergy(ContactSurface(points, np.arange(7), True), d_hat, k_b)
    found = term.evaluate(np.zeros_like(points), 1)
    share = np.sqrt(10.0)
    assert found.value == pytest.approx(share * k_b * d_hat / 2 * 9 / 16 * np.log(4), rel=1e-12)
    by_gap = share * k_b * d_hat / 2 * (-1.5 * np.log(4) - 2.25) * 2 * 0.1 / 0.04
    assert found.gradient[4] == pytest.approx([0.0, by_gap], rel=1e-12)
    assert by_gap < 0.0  # the energy falls as the gap widens


def test_far_apart_costs_nothing() -> None:
    contact, _, _ = bodies.pinched_contact()
    rest = np.zeros((contact.surface.n_points, 2))
    found = contact.evaluate(rest, 2)
    outside = bodies.pinched_contour()[0] * [1.0, 8.0] - contact.surface.reference
    apart = contact.evaluate(outside, 2)
    assert apart.value == 0.0
    assert not apart.gradient.any()
    assert apart.hessian.values.size == 0
    assert found.value > 0.0  # the reference itself is within the activation distance


def test_projected_stiffness_is_semi_definite_and_above_the_exact_one() -> None:
    """Negative eigenvalues go pair by pair, so that projected - exact is semi-definite too."""
    contact, u, _ = bodies.pinched_contact()
    exact, projected = (dense_hessian(contact.evaluate(u, 2, p).hessian, u.size) for p in (False, True))
    scale = abs(exact).max()
    assert np.linalg.eigvalsh(exact).min() < -1e-3 * scale
    assert np.linalg.eigvalsh(projected).min() > -1e-12 * scale
    assert np.linalg.eigvalsh(projected - exact).min() > -1e-12 * scale
