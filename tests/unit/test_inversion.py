"""Volume ratios over whole cells: bounds against dense sampling, steps that stop, resistance to inversion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from slices import TINY

from gyrify.config import Config
from gyrify.energy.curved import RATIO_TOLERANCE, CurvedCells
from gyrify.energy.elastic import CellPattern, ElasticEnergy
from gyrify.energy.inversion import ACTIVATION, InversionBarrier, coefficients
from gyrify.energy.kinematics import ElasticKinematics, Simplices
from gyrify.energy.total import TotalEnergy
from gyrify.errors import InvertedCellError
from gyrify.model.slice import Slice
from gyrify.solve.linear import SuperLU
from gyrify.solve.newton import Criterion, minimise
from gyrify.solve.result import Result
from gyrify.solve.system import System

CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
STRAIGHT = np.concatenate([CORNERS, 0.5 * (CORNERS + np.roll(CORNERS, -1, axis=0))])
CELLS = np.arange(6)[None]
LATTICE = np.array([(i, j, 60 - i - j) for i in range(61) for j in range(61 - i)]) / 60.0
SLOPES = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])


def determinants(x: np.ndarray, places: np.ndarray = LATTICE) -> np.ndarray:
    """det(dx/dxi) of a quadratic triangle at area coordinates, from its shape functions."""
    corners = [(4 * places[:, a, None] - 1) * SLOPES[a] for a in range(3)]
    between = [
        4 * (places[:, a, None] * SLOPES[b] + places[:, b, None] * SLOPES[a])
        for a, b in ((0, 1), (1, 2), (2, 0))
    ]
    return np.linalg.det(np.einsum("ai,aqj->qij", x, np.array(corners + between)))


def nodes(seed: int, size: float) -> np.ndarray:
    return STRAIGHT + np.random.default_rng(seed).uniform(-size, size, (6, 2))


def term_of(points: np.ndarray) -> ElasticEnergy:
    """Neo-Hookean energy of one quadratic triangle without growth."""
    simplices = Simplices.of(points[None], CELLS, 6)
    n = simplices.volumes.size
    k = ElasticKinematics.of(simplices, np.tile(np.eye(2), (n, 1, 1)), np.ones(n))
    return ElasticEnergy(
        k, np.array([[3.0], [20.0]]) * np.ones(n), k.volumes, CellPattern(simplices.cells, 2)
    )


@settings(max_examples=200, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), bent=st.sampled_from([0.0, 0.06]), size=st.floats(0.0, 0.4))
def test_the_least_ratio_is_that_of_dense_sampling(seed: int, bent: float, size: float) -> None:
    """From below, and above it by less than the lattice can miss beside the tolerance."""
    X, x = nodes(seed, bent), nodes(seed + 1, size)
    curved = CurvedCells(CELLS, X[None])
    found = curved.least_ratio(x - X)[0]
    ratios = determinants(x) / determinants(X)
    assert found <= ratios.min() + 1e-12
    steps = np.abs(np.diff(np.sort(ratios))).max()
    assert ratios.min() - found <= RATIO_TOLERANCE * max(1.0, abs(found)) + max(steps, 5e-3)
    if abs(found) > 1e-4:
        assert (curved.first_inverted(x - X) is None) == (found > 0.0)


@settings(max_examples=100, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), bent=st.sampled_from([0.0, 0.06]))
def test_steps_stop_before_any_place_in_a_cell_is_inverted(seed: int, bent: float) -> None:
    X = nodes(seed, bent)
    du = np.random.default_rng(seed + 1).standard_normal((6, 2))
    term = term_of(X)
    step = term.max_step(np.zeros((6, 2)), du)
    assert 0.0 < step <= 1.0
    assert min(determinants(X + s * step * du).min() for s in np.linspace(0.0, 1.0, 30)) > 0.0
    if step < 1.0:  # it stops short by a tenth, or at the point of integration that is flat
        beyond = min(determinants(X + s * step * du).min() for s in np.linspace(1.0, 1.12, 200))
        assert beyond < 1e-2
    assert np.isfinite(term.evaluate(0.5 * step * du, 0).value)


def corner_turned() -> np.ndarray:
    """Displacement that inverts a corner alone: the node on a side comes too near to it."""
    u = np.zeros((6, 2))
    u[3, 0] = -0.27
    return u


def test_an_inverted_corner_has_infinite_energy_where_integration_points_see_nothing() -> None:
    u, term = corner_turned(), term_of(STRAIGHT)
    assert term.kinematics.curved is not None
    assert np.linalg.det(term.kinematics.deformation(u)).min() > 0.2
    assert determinants(STRAIGHT + u).min() < 0.0
    assert term.evaluate(u, 2).value == np.inf
    assert term.evaluate(u, 2).hessian is None
    step = term.max_step(np.zeros((6, 2)), u)
    assert step == pytest.approx(0.9 * 0.25 / 0.27, rel=2e-3)  # det at the corner is 1 - 4 |u|
    assert term.max_step(u, -u) == 0.0


def test_a_minimum_beyond_an_inversion_is_not_accepted() -> None:
    """A spring pulls the node on a side to where the corner is inverted; resistance holds it before that."""

    class Spring:
        is_barrier = False

        def evaluate(self, u, order, project_psd=False):  # noqa: ARG002
            from gyrify.energy.term import Evaluation, Hessian, Pattern

            gap, dofs = u[3] - [-0.27, 0.0], np.array([6, 7])
            gradient = np.zeros((6, 2))
            gradient[3] = 1e4 * gap
            return Evaluation(5e3 * float(gap @ gap), gradient, Hessian(Pattern(dofs, dofs), np.full(2, 1e4)))

        def max_step(self, u, du):  # noqa: ARG002
            return 1.0

    def solved(*more):
        term, free = term_of(STRAIGHT), np.array([6, 7])
        total = TotalEnergy([term, Spring(), *more])
        system = System(free, 12, 2, term.pattern.pattern, SuperLU(), np.empty((0, 2), dtype=np.int64))
        none = np.empty((0, 2), dtype=np.int64)
        return minimise(total, np.zeros((6, 2)), system, Criterion(1e-8, 100), lambda _: none)

    refused = solved()
    assert refused.result is Result.INVERTING
    assert refused.result.is_inversion
    assert determinants(STRAIGHT + refused.u).min() > 0.0
    curved = CurvedCells(CELLS, STRAIGHT[None])
    held = solved(InversionBarrier(curved, 10.0, CellPattern(CELLS, 2), np.zeros(1, dtype=np.int64)))
    assert held.result is Result.CONVERGED
    assert 0.0 < determinants(STRAIGHT + held.u).min() < ACTIVATION


def resistance_of(X: np.ndarray) -> InversionBarrier:
    curved = CurvedCells(CELLS, X[None])
    return InversionBarrier(curved, 3.0, CellPattern(CELLS, 2), np.zeros(1, dtype=np.int64))


def resisting(rng: np.random.Generator) -> tuple[InversionBarrier, np.ndarray]:
    """A random cell, and a state in which a part of it has nearly vanished."""
    while True:
        term = resistance_of(nodes(int(rng.integers(2**32)), 0.03))
        u = rng.uniform(-0.28, 0.28, (6, 2)) * rng.uniform(0.3, 1.0)
        least = coefficients(term.curved.points + u).min() / (2.0 * term.curved.areas[0])
        if 0.01 < least < 0.9 * ACTIVATION:
            return term, u


def dense(hessian) -> np.ndarray:
    H = np.zeros((12, 12))
    H[hessian.pattern.rows, hessian.pattern.cols] = hessian.values
    return H + np.triu(H, 1).T


def test_the_derivatives_of_the_resistance_are_those_of_its_energy(rng: np.random.Generator) -> None:
    for _ in range(10):
        term, u = resisting(rng)
        found, h = term.evaluate(u, 2), 1e-6
        assert found.value > 0.0
        H = dense(found.hessian)
        for k in range(12):
            d = h * np.eye(12)[k].reshape(6, 2)
            up, down = term.evaluate(u + d, 1), term.evaluate(u - d, 1)
            slope = (up.value - down.value) / (2 * h)
            assert found.gradient.ravel()[k] == pytest.approx(slope, rel=1e-4, abs=1e-5 * abs(H).max())
            column = (up.gradient - down.gradient).ravel() / (2 * h)
            assert H[k] == pytest.approx(column, abs=1e-4 * abs(H).max())
        P = dense(term.evaluate(u, 2, project_psd=True).hessian)
        assert np.linalg.eigvalsh(P).min() > -1e-8 * abs(P).max()


def test_the_resistance_has_no_kinks() -> None:
    """Of a flattened cell, the corner that is the least changes as the node on a side moves along it.

    A kink, as the least of several values has, is a jump of the force across any short way over it.
    """
    term, flat = resistance_of(STRAIGHT), STRAIGHT * [0.0, -0.9]
    way = np.zeros((6, 2))
    way[3] = 0.02, 0.001
    forces = np.array([term.evaluate(flat + t * way, 1).gradient for t in np.linspace(-1.0, 1.0, 401)])
    jumps = np.abs(np.diff(forces, axis=0)).max(axis=(1, 2))
    assert jumps.max() <= 0.02 * np.abs(forces).max()


def test_coefficients_are_bounds_of_the_determinant(rng: np.random.Generator) -> None:
    """And nearer ones than those of the whole cell; the corners and middles of the sides are among them."""
    for _ in range(50):
        x = nodes(int(rng.integers(2**32)), 0.3)
        found, values = coefficients(x[None])[0], determinants(x)
        assert found.min() <= values.min() + 1e-12
        assert found.max() >= values.max() - 1e-12
        places = np.concatenate([np.eye(3), 0.5 * (np.eye(3) + np.roll(np.eye(3), -1, axis=0))])
        assert found[:6] == pytest.approx(determinants(x, places))
        whole = CurvedCells(CELLS, x[None])._coefficients(np.zeros((6, 2)))[0, 0]
        assert found.min() >= whole - 1e-12


def test_resistance_is_nothing_at_rest_and_infinite_at_inversion() -> None:
    curved = CurvedCells(CELLS, STRAIGHT[None])
    term = InversionBarrier(curved, 3.0, CellPattern(CELLS, 2), np.zeros(1, dtype=np.int64))
    rest = term.evaluate(np.zeros((6, 2)), 2)
    assert (rest.value, rest.hessian.values.size) == (0.0, 0)
    assert term.evaluate(corner_turned(), 0).value == np.inf


@pytest.mark.parametrize("element", ["linear", "mean_dilatation"])
def test_cells_of_constant_strain_are_measured_as_before(element: str) -> None:
    problem = Slice(Config().with_overrides({**TINY, "mesh.element": element}))
    assert problem.simplices.curved is None
    u = 0.01 * np.sin(problem.mesh.points)
    J, J_e = problem.least_volume_ratios(u, 200.0)
    assert np.array_equal(J, problem.volume_ratio(u))
    assert np.array_equal(J_e, J / problem.volume_growth(200.0))


@pytest.mark.parametrize("element", ["linear", "quadratic"])
def test_a_given_mesh_with_an_inverted_cell_is_refused(element: str) -> None:
    config = Config().with_overrides({**TINY, "mesh.element": element})
    mesh = Slice(config).mesh
    points, cell = mesh.points.copy(), mesh.cells[100]
    if element == "linear":
        points[cell[0]] += 1.1 * (points[cell[1]] + points[cell[2]] - 2 * points[cell[0]])
    else:  # the node on a side, near to its end: an inversion that integration points do not see
        points[cell[3]] = 0.8 * points[cell[0]] + 0.2 * points[cell[1]]
        assert Simplices.of(points[mesh.cells], mesh.cells, mesh.n_points).volumes.min() > 0.0
    with pytest.raises(InvertedCellError, match=r"Cell \d+ of the mesh"):
        Slice(config, replace(mesh, points=points))


def test_resistance_changes_the_hash_only_where_it_is_set() -> None:
    config = Config.preset("reference-slice")
    assert config.config_hash.startswith("70e224fd81e3")
    assert config.replace(**{"mesh.inversion_resistance": 0.0}).config_hash == config.config_hash
    assert config.replace(**{"mesh.inversion_resistance": 0.1}).config_hash != config.config_hash
