"""Tetrahedra: derivatives, patch test, objectivity, steps to inversion, tolerance, and the growing sphere."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from differences import assert_derivatives
from solids import BALL, config

from gyrify.energy.batch import positive_until
from gyrify.energy.element import EDGES
from gyrify.mesh import Mesh
from gyrify.model.rigid import rigid_modes
from gyrify.model.slice import Slice
from gyrify.run.onset.smooth import grown
from gyrify.run.validity.exact_bodies import sphere_of
from gyrify.theory import sphere_state

ELEMENTS = ("linear", "mean_dilatation", "quadratic")
# Of random displacements: quadratic cells are inverted by larger ones [mm].
AMPLITUDE = {"linear": 0.3, "mean_dilatation": 0.3, "quadratic": 0.05}
SMALL = {"mesh.edge_length": 20.0, "mesh.n_layers": 3, "mesh.node_jitter": 0.05, "contact.enabled": False}


def ball(element: str, **overrides) -> Slice:
    return Slice(config(BALL, **{**SMALL, "mesh.element": element, **overrides}))


def energy(problem: Slice, fraction: float, u: np.ndarray):
    return problem.tissue_energy(fraction, u).terms[0]


@pytest.mark.parametrize("element", ELEMENTS)
def test_derivatives(element: str, rng: np.random.Generator) -> None:
    problem = ball(element, **{"growth.law": "area"})
    u = AMPLITUDE[element] * rng.standard_normal(problem.state_shape)
    term = energy(problem, 0.5, u)
    du = AMPLITUDE[element] / 0.3 * rng.standard_normal(u.shape)
    assert_derivatives(term, u, du, 10.0 ** -np.arange(1.0, 7.5, 0.5), lowest=1e-6)


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_homogeneous_deformation_leaves_inner_points_in_balance(
    element: str, rng: np.random.Generator
) -> None:
    """The patch test: every field of constant gradient is in equilibrium inside one tissue."""
    problem = ball(element, **{"growth.rate": 0.0})
    problem = Slice(problem.config, straight(problem.mesh))
    gradient = 0.1 * rng.standard_normal((3, 3))
    u = problem.mesh.points @ gradient.T
    forces = energy(problem, 0.0, u).evaluate(u, 1).gradient
    outer = np.abs(forces[problem.mesh.contour]).max()
    inner = np.setdiff1d(np.arange(problem.mesh.n_points), problem.mesh.contour)
    assert outer > 0.0
    assert np.abs(forces[inner]).max() < 1e-11 * outer


@pytest.mark.parametrize("element", ELEMENTS)
def test_energy_does_not_change_with_place_and_turn(element: str, rng: np.random.Generator) -> None:
    problem = ball(element)
    u = AMPLITUDE[element] * rng.standard_normal(problem.state_shape)
    turn, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    x = problem.mesh.points
    moved = (x + u) @ turn.T + np.array([1.0, 2.0, 3.0]) - x
    term = energy(problem, 0.4, u)
    assert term.evaluate(moved, 0).value == pytest.approx(term.evaluate(u, 0).value, rel=1e-10)
    assert term.evaluate(moved, 1).gradient == pytest.approx(
        term.evaluate(u, 1).gradient @ turn.T, abs=1e-9 * np.abs(term.evaluate(u, 1).gradient).max()
    )


def test_averaged_volume_does_not_lock(rng: np.random.Generator) -> None:
    """What changes volumes within prisms, not those of prisms, costs linear cells more than averaged ones."""
    stiff = {"material.poisson_ratio": 0.4999}
    locked, free = (ball(element, **stiff) for element in ELEMENTS[:2])
    u = 0.2 * rng.standard_normal(locked.state_shape)
    values = [energy(problem, 0.0, u).evaluate(u, 0).value for problem in (locked, free)]
    assert values[1] < 0.7 * values[0]


def test_determinant_is_positive_up_to_the_step(rng: np.random.Generator) -> None:
    for _ in range(2000):
        c = rng.standard_normal(4)
        c[0] = abs(c[0]) * 10.0 ** rng.uniform(-3.0, 0.0)
        roots = np.roots(c[::-1])
        real = [z.real for z in roots if abs(z.imag) < 1e-10 and 0.0 < z.real < 1.0]
        exact, step = min(real, default=1.0), positive_until(*c, 1.0)
        assert exact - 1e-4 < step <= exact + 1e-12


def test_a_step_through_a_flat_cell_and_out_again_is_seen() -> None:
    """Both ends of the step are positive; between them the determinant is negative."""
    # (1 - 3 s)(1 - 1.5 s)(1 + s / 10): negative between 1/3 and 2/3
    a, b, c = -3.0, -1.5, 0.1
    step = positive_until(1.0, a + b + c, a * b + b * c + a * c, a * b * c, 1.0)
    assert step == pytest.approx(1.0 / 3.0, abs=1e-5)


def test_steps_of_cells_end_before_inversion(rng: np.random.Generator) -> None:
    problem = ball("linear")
    u, du = np.zeros(problem.state_shape), 30.0 * rng.standard_normal(problem.state_shape)
    step = energy(problem, 0.0, u).max_step(u, du)
    assert 0.0 < step < 1.0
    for part in np.linspace(0.0, 1.0, 40):
        assert problem.simplices.volume_ratio(part * step * du).min() > -1e-12
    assert problem.simplices.volume_ratio(1.01 * step * du).min() < 0.0


def test_tolerance_is_a_force_of_a_surface() -> None:
    problem = ball("linear")
    corners = problem.mesh.cell_points[problem.mesh.region == 1]
    edges = [np.linalg.norm(corners[:, i] - corners[:, j], axis=1) for i in range(4) for j in range(i)]
    expected = 1e-6 * 9210.87 * np.mean(edges) ** 2
    assert problem.stepping.criterion.force == pytest.approx(expected)


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("law", ["isotropic", "area"])
def test_a_growing_ball_is_that_of_exact_theory(element: str, law: str) -> None:
    """Halving the edges divides the error by four (docs/space.md); coarse quadratic cells do better."""
    errors, is_quadratic = [], element == "quadratic"
    for refine in (0,) if is_quadratic else (0, 1):
        given = {"mesh.edge_length": 28.0 if is_quadratic else 14.0, "mesh.refine": refine}
        given |= {"mesh.element": element, "growth.law": law, "mesh.node_jitter": 0.0}
        given |= {"dissipation.kind": "none", "contact.enabled": False}
        problem = Slice(config(BALL, **given))
        state = grown(problem, problem.system(np.empty((0, 2), dtype=np.int64)), 0.3)
        errors.append(_error(problem, state.u, 150.0))
    assert errors[-1] < (0.0015 if is_quadratic else 0.006)
    assert is_quadratic or errors[0] > 2.2 * errors[1]


def straight(mesh: Mesh) -> Mesh:
    """The same mesh with straight edges: on curved ones forces are those of the order of the element."""
    if mesh.cells.shape[1] == 4:
        return mesh
    points = mesh.points.copy()
    for node, ends in enumerate(EDGES[3], 4):
        points[mesh.cells[:, node]] = points[mesh.cells[:, ends]].mean(axis=1)
    return replace(mesh, points=points)


def _error(problem: Slice, u: np.ndarray, time: float) -> float:
    """Root mean square of the error over that of the exact displacement, rigid motion taken out."""
    x, exact = problem.mesh.points, sphere_state(sphere_of(problem.config), time)
    radius = np.maximum(np.linalg.norm(x, axis=1), 1e-9)
    wanted = ((exact.radius(radius) - radius) / radius)[:, None] * x
    modes, mass = rigid_modes(x), np.repeat(problem.lumped_area, 3)
    rest = (u - wanted).ravel()
    rest -= modes @ np.linalg.solve(modes.T @ (mass[:, None] * modes), modes.T @ (mass * rest))
    return float(np.sqrt(mass @ rest**2 / (mass @ wanted.ravel() ** 2)))
