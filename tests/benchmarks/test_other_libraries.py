"""What is timed beside gyrify computes the same: no ratio of different things."""

from __future__ import annotations

import numpy as np
import pytest
from bench.peers.cells import GrownCells, disagreement
from bench.peers.solid import GrownSolid

from gyrify import Config, simulate
from gyrify.model.slice import Slice

TIME = 400.0
LIBRARIES = [
    ("skfem", "scikit_fem", "VectorForms"),
    ("skfem", "scikit_fem", "ScalarBlocks"),
    ("felupe", "felupe", "PlaneStrain"),
    ("felupe", "felupe", "InPlane"),
]


@pytest.mark.parametrize(("library", "module", "name"), LIBRARIES, ids=lambda word: word)
def test_energy_gradient_and_hessian_agree(
    problem: Slice, state: np.ndarray, library: str, module: str, name: str
) -> None:
    pytest.importorskip(library)
    peers = pytest.importorskip(f"bench.peers.{module}")
    assembler = getattr(peers, name)(GrownCells.of(problem, TIME))
    ours = problem.elastic_energy(problem.kinematics(TIME)).evaluate(state, 2)
    assert disagreement(ours, assembler.all(state)) < 1e-10
    assert assembler.energy(state) == pytest.approx(ours.value, rel=1e-12)


def test_disagreement_sees_a_wrong_entry_of_each_kind(problem: Slice, state: np.ndarray) -> None:
    import scipy.sparse as sp

    ours = problem.elastic_energy(problem.kinematics(TIME)).evaluate(state, 2)
    pattern, size = ours.hessian.pattern, state.size
    upper = sp.csr_matrix((ours.hessian.values, (pattern.rows, pattern.cols)), shape=(size, size))
    whole, gradient = (upper + sp.triu(upper, 1).T).tocsr(), ours.gradient.ravel()
    assert disagreement(ours, (ours.value, gradient, whole)) == 0.0
    assert disagreement(ours, (1.01 * ours.value, gradient, whole)) > 1e-3
    assert disagreement(ours, (ours.value, gradient + np.abs(gradient).max(), whole)) > 1e-3
    assert disagreement(ours, (ours.value, gradient, upper)) > 1e-3


def test_closed_form_of_the_plane_is_the_derivative_of_its_density(
    problem: Slice, rng: np.random.Generator
) -> None:
    solid = GrownSolid(GrownCells.of(problem, TIME))
    grad_u = 0.1 * rng.normal(size=(2, 2, problem.mesh.n_cells))
    _, stress, tangent = solid.all(grad_u)
    tangent, step = solid.full(tangent), 1e-6
    for i in range(2):
        for j in range(2):
            moved = np.zeros((2, 2, 1))
            moved[i, j] = step
            slope = (solid.density(grad_u + moved) - solid.density(grad_u - moved)) / (2 * step)
            np.testing.assert_allclose(slope, stress[i, j], rtol=1e-5, atol=1e-3)
            change = (solid.all(grad_u + moved)[1] - solid.all(grad_u - moved)[1]) / (2 * step)
            np.testing.assert_allclose(change, tangent[:, :, i, j], rtol=1e-5, atol=1e-2)


def test_exchanged_assembly_and_solver_lead_along_the_same_path(problem: Slice) -> None:
    pytest.importorskip("skfem")
    from bench.peers.increments import ScikitFemEnergy, replaced

    config: Config = problem.config.with_overrides({"solver.linear_solver": "superlu"})
    own, before = simulate(config), ScikitFemEnergy.evaluated
    with replaced():
        exchanged = simulate(config)
    assert ScikitFemEnergy.evaluated > before + exchanged.stats.newton_iterations
    assert exchanged.stats.newton_iterations == own.stats.newton_iterations
    np.testing.assert_allclose(exchanged.displacement(), own.displacement(), atol=1e-7)
    again = simulate(config)
    np.testing.assert_array_equal(again.displacement(), own.displacement())
