"""What energies must not feel: the observer, and motions without deformation."""

from __future__ import annotations

import bodies
import numpy as np
import pytest
from differences import dense_hessian


def elastic(rng):
    points, cells, _ = bodies.distorted_square(rng)
    return bodies.elastic(points, cells, *bodies.random_growth(rng, len(cells))), points, points


def kelvin_voigt(rng):
    points, cells, _ = bodies.distorted_square(rng)
    half = 0.1 * rng.standard_normal((len(cells), 2, 2))
    strain = half + np.swapaxes(half, 1, 2)
    term = bodies.kelvin_voigt(points, cells, strain, *bodies.random_growth(rng, len(cells)))
    return term, points, points


def contact(rng):  # noqa: ARG001
    term, u, _ = bodies.pinched_contact()
    return term, term.surface.reference, term.surface.reference + u


TERMS = pytest.mark.parametrize("build", [elastic, kelvin_voigt, contact])


@TERMS
def test_turned_and_shifted_states_cost_the_same_and_forces_turn_along(
    rng: np.random.Generator, build
) -> None:
    term, X, x = build(rng)
    x = x + 0.02 * rng.standard_normal(x.shape)
    seen = term.evaluate(x - X, 2)
    stiffness = dense_hessian(seen.hessian, x.size)
    assert seen.value > 0.0
    for _ in range(5):
        Q, shift = bodies.rotation(rng.uniform(0, 2 * np.pi)), rng.uniform(-10, 10, 2)
        turned = term.evaluate(x @ Q.T + shift - X, 2)
        assert turned.value == pytest.approx(seen.value, rel=1e-10)
        assert turned.gradient == pytest.approx(seen.gradient @ Q.T, abs=1e-9 * abs(seen.gradient).max())
        whole = np.kron(np.eye(len(x)), Q)
        found = dense_hessian(turned.hessian, x.size)
        assert found == pytest.approx(whole @ stiffness @ whole.T, abs=1e-9 * abs(stiffness).max())


@TERMS
def test_inner_forces_have_no_resultant_and_no_moment(rng: np.random.Generator, build) -> None:
    term, X, x = build(rng)
    x = x + 0.02 * rng.standard_normal(x.shape)
    force = term.evaluate(x - X, 1).gradient
    scale = abs(force).sum()
    assert force.sum(axis=0) == pytest.approx([0.0, 0.0], abs=1e-13 * scale)
    assert np.sum(x[:, 0] * force[:, 1] - x[:, 1] * force[:, 0]) == pytest.approx(0.0, abs=1e-12 * scale)


@pytest.mark.parametrize("viscous", [False, True])
def test_rigid_motion_of_a_body_at_rest_costs_nothing(rng: np.random.Generator, viscous: bool) -> None:
    points, cells, _ = bodies.distorted_square(rng)
    at_rest = np.zeros((len(cells), 2, 2))
    term = bodies.kelvin_voigt(points, cells, at_rest) if viscous else bodies.elastic(points, cells)
    scale = abs(term.evaluate(0.1 * points, 1).gradient).max()
    for _ in range(5):
        Q, shift = bodies.rotation(rng.uniform(0, 2 * np.pi)), rng.uniform(-10, 10, 2)
        found = term.evaluate(points @ Q.T + shift - points, 1)
        assert found.value == pytest.approx(0.0, abs=1e-12)
        assert found.gradient == pytest.approx(np.zeros_like(points), abs=1e-11 * scale)


def test_rigid_motion_of_an_open_contour_meets_no_barrier(rng: np.random.Generator) -> None:
    term, _, _ = bodies.pinched_contact()
    wide = bodies.pinched_contour()[0] * [1.0, 8.0]
    for _ in range(5):
        x = wide @ bodies.rotation(rng.uniform(0, 2 * np.pi)).T + rng.uniform(-10, 10, 2)
        assert term.evaluate(x - term.surface.reference, 0).value == 0.0


def test_rigid_step_is_free_of_viscosity_but_not_of_drag(rng: np.random.Generator) -> None:
    """Kelvin-Voigt is objective; drag has a fixed background: moving m = 2 by (3, 4) costs c/2 2 25."""
    from gyrify.energy.viscous import DragEnergy, green_lagrange

    points, cells, _ = bodies.distorted_square(rng)
    u = 0.02 * rng.standard_normal(points.shape)
    strain = green_lagrange(bodies.kinematics(points, cells).deformation(u))
    term = bodies.kelvin_voigt(points, cells, strain)
    moved = (points + u) @ bodies.rotation(1.0).T + [3.0, 4.0] - points
    assert term.evaluate(moved, 0).value == pytest.approx(0.0, abs=1e-25)
    drag = DragEnergy(6.0, np.array([2.0]), np.zeros((1, 2)))
    assert drag.evaluate(np.array([[3.0, 4.0]]), 0).value == pytest.approx(6.0 / 2 * 2 * 25)


def test_energy_is_independent_of_the_numbering(rng: np.random.Generator) -> None:
    points, cells, _ = bodies.distorted_square(rng)
    u = 0.02 * rng.standard_normal(points.shape)
    order = rng.permutation(len(points))
    place = np.argsort(order)
    one, other = (
        bodies.elastic(points, cells),
        bodies.elastic(points[order], place[np.roll(cells, 1, axis=1)]),
    )
    expected, found = one.evaluate(u, 1), other.evaluate(u[order], 1)
    assert found.value == pytest.approx(expected.value, rel=1e-13)
    assert found.gradient == pytest.approx(expected.gradient[order], abs=1e-13)


def test_inverted_cells_have_infinite_energy_and_steps_stop_before_them(rng: np.random.Generator) -> None:
    """The triangle (0,0) (1,0) (0,1): its corner at (0, 1) moves down by 2; it is flat at half of that."""
    points, cells = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), np.array([[0, 1, 2]])
    term = bodies.elastic(points, cells)
    u, du = np.zeros((3, 2)), np.array([[0.0, 0.0], [0.0, 0.0], [0.0, -2.0]])
    assert term.max_step(u, du) == pytest.approx(0.5, rel=1e-14)
    assert term.evaluate(0.6 * du, 0).value == np.inf
    assert term.evaluate(0.6 * du, 2).hessian is None
    assert np.isfinite(term.evaluate(0.49 * du, 0).value)
    # a mesh, random steps: the first flat cell among all, found by scanning the areas along the way
    points, cells, _ = bodies.distorted_square(rng)
    term = bodies.elastic(points, cells)
    rest = np.zeros_like(points)
    for _ in range(20):
        du = 0.5 * rng.standard_normal(points.shape)
        step = term.max_step(rest, du)
        assert 0.0 < step < 1.0
        lowest = [
            np.linalg.det(term.kinematics.deformation(s * step * du)).min() for s in np.linspace(0, 0.999, 50)
        ]
        assert min(lowest) > 0.0
        assert np.linalg.det(term.kinematics.deformation(1.0001 * step * du)).min() < 0.0


def test_contact_steps_stop_before_the_banks_meet() -> None:
    """The tip of a spike, 0.1 above an edge, moves down by 1: contact at 0.1, and 0.9 of that is allowed."""
    from gyrify.energy.contact import ContactEnergy, ContactSurface

    points = np.array([[-4, 0], [4, 0], [4, 3.1], [1, 3.1], [0, 0.1], [-1, 3.1], [-4, 3.1]], dtype=float)
    term = ContactEnergy(ContactSurface(points, np.arange(7), True), 0.05, 1.0)
    u, du = np.zeros_like(points), np.zeros_like(points)
    du[4, 1] = -1.0
    assert 0.05 < term.max_step(u, du) <= 0.9 * 0.1 + 1e-12
    assert term.max_step(u, -du) == 1.0
    assert not term.surface.is_path_collision_free(u, u + du)
    assert term.surface.is_path_collision_free(u, u + 0.05 * du)
    assert not term.surface.is_path_collision_free(u, u + 100 * du)
