"""Factorisation: solutions and inertia, against dense linear algebra."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from gyrify.errors import SolveError
from gyrify.model.slice import Slice
from gyrify.solve.linear import SuperLU, linear_solver


def available() -> list[str]:
    """Names of the solvers that are installed."""
    return list(dict.fromkeys(["superlu", linear_solver("auto").name]))


SOLVERS = pytest.mark.parametrize("name", available())


def factorised(name: str, matrix: np.ndarray):
    """Factor of a dense symmetric matrix, zeros outside the diagonal left out."""
    stored = (matrix != 0) | np.eye(len(matrix), dtype=bool)
    upper = sp.csr_array(np.triu(stored)).astype(float)
    upper.sort_indices()
    indptr, indices = upper.indptr.astype(np.int64), upper.indices.astype(np.int64)
    rows = np.repeat(np.arange(len(matrix)), np.diff(indptr))
    solver = linear_solver(name)
    solver.analyse(indptr, indices)
    return solver.factorise(matrix[rows, indices])


def stiffness(config, fraction: float, seed: int) -> np.ndarray:
    """Exact stiffness of the free points of a small slice in a random state."""
    from differences import dense_hessian

    problem = Slice(config)
    rng = np.random.default_rng(seed)
    u = 0.05 * rng.standard_normal(problem.mesh.points.shape)
    u[problem.mesh.clamped] = 0.0
    term = problem.elastic_energy(problem.kinematics(fraction * config.growth.duration))
    whole = dense_hessian(term.evaluate(u, 2).hessian, u.size)
    return whole[np.ix_(problem.free, problem.free)]


@SOLVERS
@pytest.mark.parametrize(("fraction", "definite"), [(0.02, True), (0.3, False), (0.6, False), (1.0, False)])
def test_inertia_is_the_number_of_negative_eigenvalues(
    tiny, name: str, fraction: float, definite: bool
) -> None:
    small = tiny.replace(**{"mesh.n_around": 24, "mesh.n_layers": 4})
    A = stiffness(small, fraction, seed=int(100 * fraction))
    values = np.linalg.eigvalsh(A)
    n_negative = int(np.count_nonzero(values < 0))
    assert abs(values).min() > 1e-9 * abs(values).max()  # the sign of every eigenvalue is certain
    assert (n_negative == 0) == definite
    assert factorised(name, A).n_negative == n_negative


@SOLVERS
@pytest.mark.parametrize("fraction", [0.02, 1.0])
def test_solution_is_that_of_the_dense_matrix(tiny, name: str, fraction: float) -> None:
    A = stiffness(tiny.replace(**{"mesh.n_around": 24, "mesh.n_layers": 4}), fraction, seed=1)
    right = np.random.default_rng(2).standard_normal(len(A))
    expected = np.linalg.solve(A, right)
    assert factorised(name, A).solve(right) == pytest.approx(expected, abs=1e-8 * abs(expected).max())


@SOLVERS
def test_random_sparse_indefinite_matrices(name: str, rng: np.random.Generator) -> None:
    """Half of the diagonal negative, dominant, so that pivots need no exchange."""
    for n in (1, 2, 17, 60):
        A = np.where(rng.random((n, n)) < 0.2, rng.standard_normal((n, n)), 0.0)
        A = A + A.T
        np.fill_diagonal(A, np.where(rng.random(n) < 0.5, -1.0, 1.0) * (1.0 + abs(A).sum(axis=1)))
        factor, right = factorised(name, A), rng.standard_normal((n, 3))
        assert factor.n_negative == np.count_nonzero(np.linalg.eigvalsh(A) < 0)
        for column in right.T:
            assert A @ factor.solve(np.ascontiguousarray(column)) == pytest.approx(column, abs=1e-12)


@SOLVERS
def test_new_values_on_an_analysed_pattern(name: str, rng: np.random.Generator) -> None:
    """Upper triangle of [[a, 1], [1, 2]]: definite for a = 3, one negative eigenvalue for a = -3."""
    solver = linear_solver(name)
    solver.analyse(np.array([0, 2, 3]), np.array([0, 1, 1]))
    for a, negative in ((3.0, 0), (-3.0, 1), (3.0, 0)):
        factor = solver.factorise(np.array([a, 1.0, 2.0]))
        right = rng.standard_normal(2)
        assert factor.n_negative == negative
        assert factor.solve(right) == pytest.approx(np.linalg.solve([[a, 1.0], [1.0, 2.0]], right))


@SOLVERS
@pytest.mark.parametrize(("a", "is_definite"), [(3.0, True), (0.6, True), (0.4, False), (-3.0, False)])
def test_a_definite_factor_is_given_where_the_matrix_is_and_none_elsewhere(
    name: str, a: float, is_definite: bool
) -> None:
    """[[a, 1], [1, 2]] is definite from a = 1/2 on; that it is not is no error."""
    solver = linear_solver(name)
    solver.analyse(np.array([0, 2, 3]), np.array([0, 1, 1]))
    factor = solver.factorise_definite(np.array([a, 1.0, 2.0]))
    assert (factor is not None) is is_definite
    if factor is not None:
        assert factor.solve(np.ones(2)) == pytest.approx(np.linalg.solve([[a, 1.0], [1.0, 2.0]], np.ones(2)))


@SOLVERS
@pytest.mark.parametrize("small", [1e-6, -1e-6])
def test_a_small_pivot_is_no_other_pivot(name: str, small: float) -> None:
    """[[1 + e, 1], [1, 1]] has the pivots 1 and e; a perturbed one would give another solution."""
    A = np.array([[1.0 + small, 1.0], [1.0, 1.0]])
    factor = factorised(name, A)
    assert factor.n_negative == (small < 0.0)
    assert factor.solve(A @ np.ones(2)) == pytest.approx([1.0, 1.0], rel=1e-6)


def test_superlu_gives_no_inertia_where_it_leaves_the_diagonal() -> None:
    with pytest.raises(SolveError, match="left the diagonal"):
        factorised("superlu", np.array([[0.0, 1.0], [1.0, 0.0]]))


@pytest.mark.skipif("pardiso" not in available(), reason="PARDISO is not installed")
def test_an_error_of_pardiso_is_never_passed_over() -> None:
    from gyrify.solve.pardiso import _Matrices

    matrices = _Matrices(-2, np.array([1, 2], dtype=np.int32), np.array([1], dtype=np.int32), {1: 0})
    with pytest.raises(SolveError, match="phase 99 with error"):
        matrices._call(99, np.empty(0))


def test_superlu_says_that_a_matrix_is_singular() -> None:
    solver = SuperLU()
    solver.analyse(np.array([0, 2, 3]), np.array([0, 1, 1]))
    with pytest.raises(SolveError):
        solver.factorise(np.array([1.0, 1.0, 1.0])).solve(np.ones(2))


@pytest.mark.skipif("pardiso" not in available(), reason="PARDISO is not installed")
def test_an_overwritten_pardiso_factor_refuses_to_solve() -> None:
    solver = linear_solver("pardiso")
    solver.analyse(np.array([0, 1]), np.array([0]))
    first = solver.factorise(np.array([2.0]))
    second = solver.factorise(np.array([4.0]))
    assert second.solve(np.array([8.0])) == pytest.approx([2.0])
    with pytest.raises(RuntimeError, match="overwritten"):
        first.solve(np.array([8.0]))


@pytest.mark.skipif(len(available()) < 2, reason="one solver is not installed")
def test_a_run_is_the_same_on_both_solvers_up_to_the_tolerance(tiny) -> None:
    from gyrify import simulate

    # short of folding, where a small difference stays small
    config = tiny.replace(**{"growth.duration": 150.0, "solver.increments": 3, "solver.tolerance": 1e-9})
    one, other = (simulate(config.replace(**{"solver.linear_solver": name})) for name in available())
    assert one.displacement() == pytest.approx(other.displacement(), abs=1e-7)
