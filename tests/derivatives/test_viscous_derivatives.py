"""Drag and Kelvin-Voigt forces and stiffness."""

from __future__ import annotations

import bodies
import numpy as np
import pytest
from bodies import elliptic_ring
from differences import assert_derivatives, dense_hessian
from oracle import area, complex_step, deformation

from gyrify.energy.elastic import CellPattern
from gyrify.energy.kinematics import ElasticKinematics, Simplices
from gyrify.energy.viscous import DragEnergy, KelvinVoigtEnergy
from gyrify.mesh.layered_grid import Layers

STEPS = 10.0 ** -np.arange(1.0, 9.5, 0.5)


def drag(rng: np.random.Generator) -> tuple[DragEnergy, np.ndarray, np.ndarray, np.ndarray]:
    lumped, previous, u = rng.uniform(0.5, 1.0, 7), *rng.standard_normal((2, 7, 2))
    return DragEnergy(3.0, lumped, previous), lumped, previous, u


def test_drag_by_hand() -> None:
    """c/dt = 3, m = 2, moved by (1, 2): energy 3/2 x 2 x 5 = 15, force 6 (1, 2), stiffness 6."""
    term = DragEnergy(3.0, np.array([2.0]), np.array([[4.0, 4.0]]))
    found = term.evaluate(np.array([[5.0, 6.0]]), 2)
    assert found.value == pytest.approx(15.0, rel=1e-15)
    assert found.gradient == pytest.approx(np.array([[6.0, 12.0]]), rel=1e-15)
    assert dense_hessian(found.hessian, 2) == pytest.approx(6.0 * np.eye(2), rel=1e-15)


def test_one_sided_difference_of_drag_falls_as_h_then_rises(rng: np.random.Generator) -> None:
    """A quadratic energy: central differences are exact, one-sided ones err by c/2 m |du|^2 h."""
    term, lumped, _, u = drag(rng)
    du = rng.standard_normal(u.shape)
    found = term.evaluate(u, 2)
    slope = np.sum(found.gradient * du)
    steps = 10.0 ** -np.arange(1.0, 13.0)
    errors = [(term.evaluate(u + h * du, 0).value - found.value) / h - slope for h in steps]
    assert np.array(errors[:4]) == pytest.approx(1.5 * np.sum(lumped[:, None] * du**2) * steps[:4], rel=1e-3)
    bottom = int(np.argmin(np.abs(errors)))
    assert 4 < bottom < len(steps) - 1
    central = (term.evaluate(u + du, 0).value - term.evaluate(u - du, 0).value) / 2
    assert central == pytest.approx(slope, rel=1e-13)
    force = (term.evaluate(u + du, 1).gradient - term.evaluate(u - du, 1).gradient).ravel() / 2
    curvature = dense_hessian(found.hessian, u.size) @ du.ravel()
    assert curvature == pytest.approx(force, abs=1e-13 * abs(force).max())


@pytest.mark.parametrize("grown", [False, True])
def test_error_of_kelvin_voigt_differences_is_a_v(rng: np.random.Generator, grown: bool) -> None:
    points, cells, _ = bodies.distorted_square(rng)
    growth = bodies.random_growth(rng, len(cells)) if grown else (None, None)
    before = 0.1 * rng.standard_normal((len(cells), 2, 2))
    term = bodies.kelvin_voigt(points, cells, before + np.swapaxes(before, 1, 2), *growth)
    u, du = 0.02 * rng.standard_normal((2, *points.shape))
    assert_derivatives(term, u, du, STEPS)


@pytest.mark.parametrize("kind", ["quadratic", "space"])
def test_error_of_kelvin_voigt_differences_is_a_v_in_other_cells(rng: np.random.Generator, kind: str) -> None:
    """Quadratic triangles, and tetrahedra: more than one batch of points each."""
    if kind == "quadratic":
        mesh = elliptic_ring((4.0, 3.0), 0.5, 0.5, Layers(12, 4, 2, element="quadratic"))
        points, cells = mesh.points, mesh.cells
        simplices = Simplices.of(mesh.cell_points, cells, mesh.n_points)
    else:
        corners = np.concatenate([np.zeros((1, 3)), np.eye(3)])
        points = (corners + rng.uniform(-0.1, 0.1, (70, 4, 3))).reshape(-1, 3)
        cells = np.arange(280).reshape(70, 4)
        simplices = Simplices.of(points[cells], cells, 280)
    n, d = simplices.gradients.shape[0], points.shape[1]
    stretch = rng.uniform(1.0, 1.5, n)
    k = ElasticKinematics.of(simplices, stretch[:, None, None] * np.eye(d), np.ones(n))
    before = 0.1 * rng.standard_normal((n, d, d))
    before += np.swapaxes(before, 1, 2)
    term = KelvinVoigtEnergy(k, 5.0, k.volumes * k.J_g, before, CellPattern(simplices.cells, d))
    u, du = 0.02 * rng.standard_normal((2, *points.shape))
    assert_derivatives(term, u, du, STEPS)


def test_kelvin_voigt_equals_the_complex_step_of_its_energy(rng: np.random.Generator) -> None:
    """eta/dt / 2 x grown volume x |E - E_n|^2 with E = (F_e^T F_e - I) / 2."""
    n = 25
    points, cells = bodies.separate_triangles(rng, n)
    F_g, F_g33 = bodies.random_growth(rng, n)
    half = 0.1 * rng.standard_normal((n, 2, 2))
    before = half + np.swapaxes(half, 1, 2)
    term = bodies.kelvin_voigt(points, cells, before, F_g, F_g33, coefficient=5.0)
    X, u = points[cells], 0.1 * rng.standard_normal(points.shape)
    volume = area(X) * np.linalg.det(F_g) * F_g33

    def energies(flat: np.ndarray) -> np.ndarray:
        F = deformation(X, flat.reshape(n, 3, 2)) @ np.linalg.inv(F_g)
        rate = (np.swapaxes(F, 1, 2) @ F - np.eye(2)) / 2 - before
        return 5.0 / 2 * volume * (rate**2).sum(axis=(1, 2))

    found = term.evaluate(u, 2)
    flat = u.reshape(n, 6)
    forces = complex_step(energies, flat)
    assert found.value == pytest.approx(energies(flat).sum(), rel=1e-13)
    assert found.gradient.reshape(n, 6) == pytest.approx(forces, abs=1e-12 * abs(forces).max())


def test_projected_kelvin_voigt_stiffness(rng: np.random.Generator) -> None:
    """Semi-definite always; the exact one where the strain only grows (its stress stiffens)."""
    points, cells = bodies.separate_triangles(rng, 20)
    u = 0.1 * rng.standard_normal(points.shape)
    strain = bodies.kinematics(points, cells).deformation(u)
    strain = (np.swapaxes(strain, 1, 2) @ strain - np.eye(2)) / 2
    for shift, equal in ((-0.5, True), (0.5, False)):
        term = bodies.kelvin_voigt(points, cells, strain + shift * np.eye(2))
        exact, projected = (dense_hessian(term.evaluate(u, 2, p).hessian, u.size) for p in (False, True))
        scale = abs(exact).max()
        assert np.linalg.eigvalsh(projected).min() > -1e-12 * scale
        assert (abs(projected - exact).max() < 1e-12 * scale) == equal
        assert (np.linalg.eigvalsh(exact).min() > -1e-12 * scale) == equal
