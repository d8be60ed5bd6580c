"""Growth against closed forms: free, blocked along z, and fully constrained."""

from __future__ import annotations

import bodies
import numpy as np
import pytest
from oracle import embedded, moduli, neo_hookean
from scipy.optimize import minimize_scalar

from gyrify.model.slice import Slice
from gyrify.physics.growth import growth_stretch, growth_tensor, out_of_plane_growth
from gyrify.solve.linear import linear_solver
from gyrify.solve.newton import Criterion, minimise
from gyrify.solve.result import Result
from gyrify.solve.system import System

MU, KAPPA = moduli(9210.87, 0.458)


def solved(points: np.ndarray, term, free: np.ndarray, u: np.ndarray, force: float = 1e-6):
    """Minimise one elastic term over some degrees of freedom."""
    from gyrify.energy.total import TotalEnergy

    none = np.empty((0, 2), dtype=np.int64)
    system = System(free, points.size, 2, term.pattern.pattern, linear_solver(), none)
    solution = minimise(TotalEnergy([term]), u, system, Criterion(force, 50), lambda _: none)
    assert solution.result is Result.CONVERGED
    return solution


@pytest.mark.parametrize("law", ["isotropic", "tangential"])
def test_free_growth_in_the_plane_costs_nothing(rng: np.random.Generator, law: str) -> None:
    """F = Q F_g with a rotation Q, so F_e = Q; every triangle has its own growth."""
    n = 20
    points, cells = bodies.separate_triangles(rng, n)
    stretch, angle = rng.uniform(1.0, 2.5, n), rng.uniform(0, 2 * np.pi, n)
    across = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    F_g = growth_tensor(stretch, np.full(n, law == "tangential"), across)
    F_g33 = out_of_plane_growth(stretch, "none")
    term = bodies.elastic(points, cells, F_g, F_g33, MU, KAPPA)
    F = bodies.rotation(0.7) @ F_g
    u = np.einsum("cij,caj->cai", F, points[cells]).reshape(-1, 2) - points
    found = term.evaluate(u, 1)
    assert found.value == pytest.approx(0.0, abs=1e-13 * MU)
    assert found.gradient == pytest.approx(np.zeros_like(u), abs=1e-12 * KAPPA)
    assert term.evaluate(0.9 * u, 0).value > 1e-3 * MU


def test_free_growth_of_a_slice_in_the_plane_costs_nothing(tiny) -> None:
    """Equal growth of both tissues, 1 + 0.002 x 500 = 2: the slice doubles, u = X."""
    problem = Slice(tiny.replace(**{"growth.ratio": 1.0, "growth.out_of_plane": "none"}))
    term = problem.elastic_energy(problem.kinematics(500.0))
    u = problem.mesh.points
    assert term.evaluate(u, 0).value < 1e-12 * term.evaluate(np.zeros_like(u), 0).value


@pytest.mark.parametrize("stretch", [1.1, 1.5, 2.0])
def test_free_growth_blocked_along_z_takes_the_best_stretch_in_the_plane(
    rng: np.random.Generator, stretch: float
) -> None:
    """F_e = diag(l / lambda, l / lambda, 1 / lambda): minimise lambda^3 W over l, once in one dimension."""
    points, cells, _ = bodies.distorted_square(rng)
    n = len(cells)
    lambda_g = np.full(n, stretch)
    F_g = growth_tensor(lambda_g, np.zeros(n, dtype=bool), np.tile([1.0, 0.0], (n, 1)))
    term = bodies.elastic(points, cells, F_g, out_of_plane_growth(lambda_g, "blocked"), MU, KAPPA)

    def energy(log_l: float) -> float:
        diagonal = np.diag([np.exp(log_l) / stretch] * 2 + [1 / stretch])[None]
        return stretch**3 * neo_hookean(diagonal, MU, KAPPA)[0]

    best = minimize_scalar(energy, bracket=(0.0, 1.4 * np.log(stretch), 3.0 * np.log(stretch)), tol=1e-12)
    # only the rigid motions are held: a corner, and the height of the next one
    corner, beside = 0, int(np.flatnonzero(np.all(points == [1.0, 0.0], axis=1))[0])
    free = np.setdiff1d(np.arange(points.size), [2 * corner, 2 * corner + 1, 2 * beside + 1])
    start = (stretch - 1) * points
    start[corner], start[beside, 1] = 0.0, 0.0
    solution = solved(points, term, free, start)
    assert term.evaluate(solution.u, 0).value == pytest.approx(best.fun, rel=1e-10)
    # the energy is flat in l, so that brent knows l to half the digits only
    assert solution.u[beside, 0] == pytest.approx(np.exp(best.x) - 1, abs=1e-6)


@pytest.mark.parametrize("per", ["grown", "reference"])
@pytest.mark.parametrize("stretch", ["linear", "exponential"])
def test_fully_constrained_growth_has_its_closed_form(tiny, per: str, stretch: str) -> None:
    """u = 0: F_e = I / lambda, so W = kappa/2 (lambda^-3 - 1)^2; times J_g = lambda^3 when per grown."""
    config = tiny.replace(
        **{
            "growth.energy_per": per,
            "growth.stretch": stretch,
            "growth.ratio": 2.0,
            "material.stiffness_ratio": 4.0,
            "material.poisson_ratio_white": 0.3,
        }
    )
    problem = Slice(config)
    energy = (
        problem.elastic_energy(problem.kinematics(400.0))
        .evaluate(np.zeros_like(problem.mesh.points), 0)
        .value
    )
    expected = 0.0
    # G_G t = 0.8, G_W t = 0.4; E_W = E_G / 4
    for region, strain, E, nu in ((1, 0.8, 9210.87, 0.458), (0, 0.4, 9210.87 / 4, 0.3)):
        lambda_g = 1 + strain if stretch == "linear" else np.exp(strain)
        area = problem.simplices.volumes[problem.mesh.region == region].sum()
        J_g = lambda_g**3 if per == "grown" else 1.0
        expected += area * J_g * E / 3 / (1 - 2 * nu) / 2 * (lambda_g**-3 - 1) ** 2
    assert energy == pytest.approx(expected, rel=1e-13)


def test_growth_tensors_by_hand() -> None:
    """lambda = 1 + 0.002 x 300 = 1.6 or e^0.6; N = (0.6, 0.8): I - N N = [[0.64, -0.48], [-0.48, 0.36]]."""
    assert growth_stretch(0.002, 300.0, "linear") == pytest.approx(1.6, rel=1e-15)
    assert growth_stretch(0.002, 300.0, "exponential") == pytest.approx(np.exp(0.6), rel=1e-15)
    stretch, across = np.array([1.6, 1.6]), np.array([[0.6, 0.8], [0.6, 0.8]])
    isotropic, tangential = growth_tensor(stretch, np.array([False, True]), across)
    assert isotropic == pytest.approx(1.6 * np.eye(2))
    expected = 1.6 * np.array([[0.64, -0.48], [-0.48, 0.36]]) + np.outer([0.6, 0.8], [0.6, 0.8])
    assert tangential == pytest.approx(expected, rel=1e-14)
    assert tangential @ [0.6, 0.8] == pytest.approx([0.6, 0.8])  # nothing grows across
    assert tangential @ [-0.8, 0.6] == pytest.approx(1.6 * np.array([-0.8, 0.6]))
    assert out_of_plane_growth(stretch, "blocked") == pytest.approx([1.6, 1.6])
    assert out_of_plane_growth(stretch, "none") == pytest.approx([1.0, 1.0])


def test_patch_of_distorted_cells_carries_a_constant_stress(rng: np.random.Generator) -> None:
    """Affine displacement of the boundary, equal growth: the inside follows, every stress is the same."""
    from gyrify.physics.materials import NEO_HOOKEAN
    from gyrify.physics.stress import first_piola

    points, cells, boundary = bodies.distorted_square(rng, 8)
    n = len(cells)
    F_g, F_g33 = np.tile(np.diag([1.3, 1.1]), (n, 1, 1)), np.full(n, 1.2)
    term = bodies.elastic(points, cells, F_g, F_g33, MU, KAPPA)
    gradient = np.array([[0.25, 0.1], [-0.05, 0.12]])
    affine = points @ gradient.T
    inside = np.setdiff1d(np.arange(len(points)), boundary)
    start = affine.copy()
    start[inside] += 0.01 * rng.standard_normal((inside.size, 2))
    free = (2 * inside[:, None] + [0, 1]).ravel()
    solution = solved(points, term, free, start, force=1e-8)
    assert abs(start - affine).max() > 1e-3
    assert solution.u == pytest.approx(affine, abs=1e-11)
    F = term.kinematics.deformation(solution.u)
    P, P33 = first_piola(NEO_HOOKEAN, F, term.kinematics.f33, term.parameters)
    F_e = embedded((np.eye(2) + gradient)[None] @ np.linalg.inv(F_g[:1]), 1 / 1.2)
    h = 1e-30
    for i, j, found in [(i, j, P[:, i, j]) for i in (0, 1) for j in (0, 1)] + [(2, 2, P33)]:
        shifted = F_e.astype(complex)
        shifted[:, i, j] += 1j * h
        assert found == pytest.approx(np.full(n, neo_hookean(shifted, MU, KAPPA)[0].imag / h), abs=1e-7)
