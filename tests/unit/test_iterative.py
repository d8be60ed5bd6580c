"""Conjugate gradients: blocks, negative curvature, modes, against dense linear algebra."""

from __future__ import annotations

import numpy as np
import pytest

from gyrify.energy.symmetric_product import invert_positive
from gyrify.errors import SolveError
from gyrify.solve.iterative.blocks import BlockMatrix, Nodes
from gyrify.solve.iterative.conjugate import conjugate_gradients
from gyrify.solve.iterative.krylov import ConjugateGradients
from gyrify.solve.iterative.lowest import MOST_MODES, lowest_modes
from gyrify.solve.iterative.preconditioners import block_diagonal, multigrid, strongest

N_POINTS = 40
# Held in part: two directions of point 3, one of point 7; all of point 5.
HELD = np.array([9, 10, 15, 16, 17, 22])
MOVING = np.setdiff1d(np.arange(3 * N_POINTS), HELD)


def dense(lowest: tuple[float, ...] = ()) -> np.ndarray:
    """Symmetric matrix of neighbours' blocks, positive definite but for its lowest eigenvalues, if given."""
    random = np.random.default_rng(5)
    A = np.zeros((3 * N_POINTS, 3 * N_POINTS))
    for i in range(N_POINTS):
        for j in range(i + 1, min(i + 4, N_POINTS)):
            block = random.normal(size=(3, 3))
            A[3 * i : 3 * i + 3, 3 * j : 3 * j + 3] = block
            A[3 * j : 3 * j + 3, 3 * i : 3 * i + 3] = block.T
    A += np.diag(np.abs(A).sum(axis=0) + 1.0)
    A = A[np.ix_(MOVING, MOVING)]
    if lowest:
        A = A - (np.linalg.eigvalsh(A)[len(lowest)] - 1.0) * np.eye(MOVING.size)
        values, vectors = np.linalg.eigh(A)
        n = len(lowest)
        A += (vectors[:, :n] * (np.array(lowest) - values[:n])) @ vectors[:, :n].T
    return A


def solver_of(A: np.ndarray) -> tuple[ConjugateGradients, np.ndarray]:
    """Solver on the pattern of a matrix, and its values there."""
    modes = np.tile(np.eye(3), (N_POINTS, 1))
    solver = ConjugateGradients(Nodes.of(MOVING, modes))
    rows, cols = np.nonzero(np.triu((A != 0.0) | np.eye(A.shape[0], dtype=bool)))
    solver.analyse(np.searchsorted(rows, np.arange(A.shape[0] + 1)), cols)
    return solver, A[rows, cols]


def blocks_of(A: np.ndarray) -> BlockMatrix:
    solver, data = solver_of(A)
    return solver.matrix(data)


def test_a_product_is_that_of_the_matrix_whatever_is_held() -> None:
    A, x = dense(), np.random.default_rng(1).normal(size=MOVING.size)
    matrix = blocks_of(A)
    nodes = matrix.pattern.nodes
    full = nodes.expand(x)
    assert (matrix @ full)[nodes.place] == pytest.approx(A @ x, rel=1e-12)
    assert full.sum() == pytest.approx(x.sum())
    # point 5 is left out; what is held in part stays where it is
    assert nodes.n_nodes == N_POINTS - 1
    held = np.setdiff1d(np.arange(full.size), nodes.place)
    assert held.tolist() == [9, 10, 19]
    np.testing.assert_array_equal((matrix @ full)[held], 0.0)
    np.testing.assert_array_equal(matrix.whole() @ full, (matrix.whole().T @ full))
    assert matrix.whole() @ full == pytest.approx(matrix @ full, rel=1e-12)


def test_a_shift_is_added_to_the_diagonal() -> None:
    A, mass = dense(), np.random.default_rng(2).uniform(1.0, 2.0, MOVING.size)
    matrix = blocks_of(A)
    nodes, x = matrix.pattern.nodes, np.random.default_rng(1).normal(size=MOVING.size)
    shifted = matrix.shifted(3.0 * nodes.expand(mass))
    assert (shifted @ nodes.expand(x))[nodes.place] == pytest.approx(A @ x + 3.0 * mass * x, rel=1e-12)
    assert (matrix @ nodes.expand(x))[nodes.place] == pytest.approx(A @ x, rel=1e-12)


@pytest.mark.parametrize("preconditioner", [block_diagonal, multigrid])
@pytest.mark.parametrize("tolerance", [1e-3, 1e-10])
def test_conjugate_gradients_solve_to_their_tolerance(preconditioner: object, tolerance: float) -> None:
    if preconditioner is multigrid:
        pytest.importorskip("pyamg")
    A, b = dense(), np.random.default_rng(3).normal(size=MOVING.size)
    matrix = blocks_of(A)
    full = matrix.pattern.nodes.expand(b)
    found = conjugate_gradients(matrix.__matmul__, full, preconditioner(matrix), tolerance, 500)  # type: ignore[operator]
    assert found.negative is None
    assert found.residual <= tolerance
    x = found.x[matrix.pattern.nodes.place]
    assert np.linalg.norm(b - A @ x) <= 1.001 * tolerance * np.linalg.norm(b)


def test_negative_curvature_is_met_and_shown() -> None:
    A, b = dense((-2.0,)), np.random.default_rng(3).normal(size=MOVING.size)
    matrix = blocks_of(A)
    full = matrix.pattern.nodes.expand(b)
    found = conjugate_gradients(matrix.__matmul__, full, block_diagonal(matrix), 1e-12, 500)
    assert found.negative is not None
    assert found.negative @ (matrix @ found.negative) < 0.0
    # up to there every iterate has lowered x A x / 2 - b x
    assert found.x @ full > 0.5 * found.x @ (matrix @ found.x) > 0.0


def test_nothing_is_solved_for_nothing() -> None:
    matrix = blocks_of(dense())
    zero = np.zeros(3 * matrix.pattern.nodes.n_nodes)
    found = conjugate_gradients(matrix.__matmul__, zero, block_diagonal(matrix), 1e-3, 500)
    assert found.iterations == 0
    np.testing.assert_array_equal(found.x, zero)


@pytest.mark.parametrize("preconditioner", [block_diagonal, multigrid])
def test_preconditioners_of_an_indefinite_matrix_are_positive(preconditioner: object) -> None:
    """Else conjugate gradients would take it for negative curvature of the matrix, or break down."""
    if preconditioner is multigrid:
        pytest.importorskip("pyamg")
    matrix = blocks_of(dense((-50.0, -20.0, -1.0)))
    precondition = preconditioner(matrix)  # type: ignore[operator]
    place = matrix.pattern.nodes.place
    B = np.stack([precondition(matrix.pattern.nodes.expand(e))[place] for e in np.eye(place.size)])
    assert np.linalg.eigvalsh(0.5 * (B + B.T)).min() > 0.0


def test_a_point_without_stiffness_is_refused() -> None:
    A = dense()
    A[0] = A[:, 0] = 0.0
    with pytest.raises(SolveError, match="no stiffness"):
        block_diagonal(blocks_of(A))


def test_multigrid_gives_the_same_bytes_and_leaves_random_numbers_alone() -> None:
    pytest.importorskip("pyamg")
    A, results = dense(), []
    for seed in (1, 2):
        np.random.seed(seed)  # noqa: NPY002  # the state that a library might use
        matrix = blocks_of(A)
        before = np.random.get_state()[1].tobytes()  # type: ignore[union-attr]  # noqa: NPY002
        x = multigrid(matrix)(matrix.pattern.nodes.expand(np.ones(MOVING.size)))
        assert np.random.get_state()[1].tobytes() == before  # type: ignore[union-attr]  # noqa: NPY002
        results.append(x.tobytes())
    assert results[0] == results[1]


@pytest.mark.parametrize("n_negative", [0, 1, 7, 20])
@pytest.mark.parametrize("has_pyamg", [True, False])
def test_modes_are_those_of_dense_algebra(
    n_negative: int, has_pyamg: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    if has_pyamg:
        pytest.importorskip("pyamg")
    else:
        monkeypatch.setattr("gyrify.solve.iterative.preconditioners.has_multigrid", lambda: False)
    A = dense(tuple(np.linspace(-3.0 * n_negative, -1.0, n_negative)))
    mass = np.random.default_rng(2).uniform(1.0, 2.0, MOVING.size)
    matrix = blocks_of(A)
    found = lowest_modes(matrix, mass, strongest(matrix))
    root = np.sqrt(mass)
    expected = np.linalg.eigvalsh(A / np.outer(root, root))
    assert found.eigenvalues[:2] == pytest.approx(expected[:2], rel=1e-6)
    assert np.count_nonzero(found.eigenvalues < 0.0) == min(n_negative, MOST_MODES)
    assert found.eigenvalues.size == MOST_MODES or found.eigenvalues[-1] > 0.0
    v = found.vectors[:, 0]
    assert v @ (mass * v) == pytest.approx(1.0)
    assert np.linalg.norm(A @ v - found.eigenvalues[0] * mass * v) < 1e-5 * np.abs(A).max() * np.linalg.norm(
        v
    )


def test_an_indefinite_system_is_solved_and_its_negative_eigenvalues_counted() -> None:
    A, b = dense((-5.0, -2.0)), np.random.default_rng(3).normal(size=MOVING.size)
    solver, data = solver_of(A)
    factor = solver.factorise(data)
    assert np.linalg.norm(A @ factor.solve(b) - b) < 1e-4 * np.linalg.norm(b)
    assert factor.n_negative == 2
    assert solver.factorise_definite(data) is None
    solver, data = solver_of(dense())
    definite = solver.factorise_definite(data)
    assert definite is not None
    assert definite.n_negative == 0


def test_a_singular_system_is_told() -> None:
    A = dense((0.0,))
    null = np.linalg.eigh(A)[1][:, 0]
    solver, data = solver_of(A)
    with pytest.raises(SolveError, match="close to singular"):
        solver.factorise(data).solve(null)


def test_blocks_that_are_positive_are_inverted_and_the_others_left(rng: np.random.Generator) -> None:
    halves = rng.standard_normal((200, 3, 3))
    blocks = halves @ halves.transpose(0, 2, 1) + 0.1 * np.eye(3)
    blocks[::7] -= 2.0 * np.eye(3)
    blocks[1] = np.diag([1.0, 1.0, 0.0])
    inverse = np.full_like(blocks, np.nan)
    is_positive = invert_positive(blocks, inverse)
    assert np.array_equal(is_positive, np.linalg.eigvalsh(blocks).min(axis=1) > 0.0)
    assert inverse[is_positive] == pytest.approx(np.linalg.inv(blocks[is_positive]), rel=1e-9, abs=1e-9)
    assert np.isnan(inverse[~is_positive]).all()
