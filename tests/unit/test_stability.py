"""Inertia and lowest eigenpair of the tangent, against dense linear algebra on a small mesh."""

from __future__ import annotations

import numpy as np
import pytest

from gyrify.config import Config
from gyrify.errors import SolveError
from gyrify.mesh.waves import dominant_wave, normal_displacement
from gyrify.model.slice import Slice
from gyrify.run.onset.smooth import grown
from gyrify.solve.branch import leave
from gyrify.solve.linear import linear_solver
from gyrify.solve.stability import Tangent

SMALL = {
    "geometry.shape": "circle",
    "mesh.n_around": 36,
    "mesh.n_layers": 5,
    "mesh.n_cortex_layers": 2,
    "mesh.node_jitter": 0.0,
    "dissipation.kind": "none",
    "material.stiffness_ratio": 3.0,
    "geometry.cortical_thickness": 5.0,
}
NO_PAIRS = np.empty((0, 2), dtype=np.int64)


def tangent_at(fraction: float, solver: str = "superlu") -> tuple[Slice, np.ndarray, Tangent]:
    """Smooth state of the small circle at a growth fraction."""
    config = Config.preset("reference-slice").with_overrides({**SMALL, "solver.linear_solver": solver})
    problem = Slice(config)
    system = problem.system(NO_PAIRS)
    u = grown(problem, system, fraction).u
    return problem, u, problem.tangent(fraction, u, u, system)


@pytest.fixture(scope="module", params=[0.2, 0.8])
def state(request: pytest.FixtureRequest) -> tuple[Slice, np.ndarray, Tangent]:
    """A stable and an unstable state."""
    return tangent_at(request.param)


def dense(tangent: Tangent) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues of K v = lambda M v, and K."""
    K = tangent.matrix().toarray()
    root = np.sqrt(tangent.mass)
    return np.linalg.eigvalsh(K / np.outer(root, root)), K


def test_matrix_is_symmetric(state: tuple[Slice, np.ndarray, Tangent]) -> None:
    K = state[2].matrix().toarray()
    np.testing.assert_array_equal(K, K.T)


def test_negative_pivots_are_negative_eigenvalues(state: tuple[Slice, np.ndarray, Tangent]) -> None:
    values, _ = dense(state[2])
    assert state[2].n_negative == np.count_nonzero(values < 0.0)


def test_states_are_stable_and_unstable() -> None:
    assert tangent_at(0.2)[2].is_stable
    assert tangent_at(0.8)[2].n_negative >= 2


def test_lowest_eigenpair(state: tuple[Slice, np.ndarray, Tangent]) -> None:
    problem, _, tangent = state
    values, K = dense(tangent)
    pair = tangent.lowest()
    assert pair.eigenvalue == pytest.approx(values[0], rel=1e-9)
    v = pair.vector.ravel()[problem.free]
    residual = np.linalg.norm(K @ v - pair.eigenvalue * tangent.mass * v)
    assert residual <= 1e-6 * np.linalg.norm(K, 2) * np.linalg.norm(v)
    assert pair.residual <= 1e-6
    assert v @ (tangent.mass * v) == pytest.approx(1.0)
    assert not pair.vector[problem.mesh.clamped].any()


def test_lowest_is_the_same_each_time(state: tuple[Slice, np.ndarray, Tangent]) -> None:
    first, second = state[2].lowest(), state[2].lowest(guess=-1.0)
    assert second.eigenvalue == pytest.approx(first.eigenvalue, rel=1e-9)
    np.testing.assert_array_equal(state[2].lowest().vector, first.vector)


def test_both_linear_solvers_agree() -> None:
    if linear_solver("auto").name == "superlu":
        pytest.skip("PARDISO is not installed")
    for fraction in (0.2, 0.8):
        one, two = tangent_at(fraction, "superlu")[2], tangent_at(fraction, "pardiso")[2]
        assert one.n_negative == two.n_negative
        assert one.lowest().eigenvalue == pytest.approx(two.lowest().eigenvalue, rel=1e-8)


def test_rigid_rotation_of_a_free_body_is_neutral() -> None:
    """Without the clamp an unloaded slice has three zero eigenvalues: two shifts and a rotation."""
    problem = Slice(Config.preset("reference-slice").with_overrides(SMALL))
    problem.__dict__["free"] = np.arange(2 * problem.mesh.n_points)
    u = np.zeros_like(problem.mesh.points)
    values, K = dense(problem.tangent(0.0, u, u, problem.system(NO_PAIRS)))
    assert np.abs(values[:3]).max() < 1e-9 * values[-1]
    assert values[3] > 1e-6 * values[-1]
    x = problem.mesh.points
    rotation = np.stack([-x[:, 1], x[:, 0]], axis=1).ravel()
    assert np.abs(K @ rotation).max() < 1e-9 * np.abs(K).max() * np.abs(rotation).max()


@pytest.mark.parametrize("number", [1, 5, 12])
def test_dominant_wave(number: int) -> None:
    mesh = Slice(Config.preset("reference-slice").with_overrides(SMALL)).mesh
    angle = np.arctan2(mesh.points[:, 1], mesh.points[:, 0])
    radial = mesh.points / np.linalg.norm(mesh.points, axis=1, keepdims=True)
    u = 0.5 * mesh.points
    found, wavelength = dominant_wave(mesh, u, np.cos(number * angle)[:, None] * radial)
    radius = 1.5 * np.sqrt(4069.0 / np.pi)
    perimeter = 36 * 2.0 * radius * np.sin(np.pi / 36)
    assert found == number
    assert wavelength == pytest.approx(perimeter / number)
    assert np.allclose(normal_displacement(mesh, u, radial), 1.0)


def test_waves_of_a_strip() -> None:
    config = Config.preset("reference-slice").with_overrides(
        {**SMALL, "geometry.shape": "strip", "mesh.n_around": 48}
    )
    mesh = Slice(config).mesh
    x = mesh.points[:, 0]
    up = np.stack([np.zeros_like(x), np.sin(2.0 * np.pi * 4 * x / config.geometry.length)], axis=1)
    found, wavelength = dominant_wave(mesh, np.zeros_like(up), up)
    assert (found, wavelength) == (4, pytest.approx(config.geometry.length / 4))
    height = normal_displacement(mesh, np.zeros_like(up), np.ones_like(up))
    assert np.allclose(height, 1.0)


def test_leaving_lowers_the_energy_on_both_sides() -> None:
    problem, u, tangent = tangent_at(0.8)
    total, mode = problem.tissue_energy(0.8, u), tangent.lowest().vector
    for sign in (1.0, -1.0):
        assert total.value(leave(total, u, sign * mode, 1.0)) < total.value(u)


def test_a_stable_state_cannot_be_left() -> None:
    problem, u, tangent = tangent_at(0.2)
    total = problem.tissue_energy(0.2, u)
    with pytest.raises(SolveError, match="no step along its lowest mode"):
        leave(total, u, tangent.lowest().vector, 1.0)
