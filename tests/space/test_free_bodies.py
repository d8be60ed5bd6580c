"""Bodies that nothing holds: supports prevent rigid motions alone, and drag needs none."""

from __future__ import annotations

import numpy as np
import pytest
from solids import BALL, BRAIN, config

from gyrify.model.rigid import isostatic_supports, rigid_modes
from gyrify.model.slice import Slice
from gyrify.run.simulation import simulate

NONE = np.empty((0, 2), dtype=np.int64)


@pytest.mark.parametrize("n_dim", [2, 3])
def test_supports_prevent_every_rigid_motion_and_no_more(n_dim: int, rng: np.random.Generator) -> None:
    points = rng.standard_normal((40, n_dim)) * np.arange(1, n_dim + 1)
    modes = rigid_modes(points)
    supports = isostatic_supports(modes)
    assert supports.size == modes.shape[1] == n_dim * (n_dim + 1) // 2
    assert np.linalg.cond(modes[supports]) < 20.0


def test_rigid_modes_do_not_strain(rng: np.random.Generator) -> None:
    """The stiffness of the undeformed ball has exactly these six vectors of no curvature."""
    ball = Slice(config(BALL, **{"dissipation.kind": "none"}))
    u = np.zeros(ball.state_shape)
    hessian = ball.tissue_energy(0.0, u).evaluate(u, project_psd=False)[0].hessian
    modes = rigid_modes(ball.mesh.points)
    K = np.zeros((modes.shape[1],) * 2)
    rows, cols = hessian.pattern.rows, hessian.pattern.cols
    full = np.zeros_like(modes)
    np.add.at(full, rows, hessian.values[:, None] * modes[cols])
    off = rows != cols
    np.add.at(full, cols[off], hessian.values[off, None] * modes[rows[off]])
    K = modes.T @ full
    shear = rng.standard_normal(modes.shape[0])
    assert np.abs(K).max() < 1e-9 * np.abs(hessian.values).max() * modes.shape[0]
    assert np.abs(full).max() < 1e-9 * np.abs(hessian.values).max()
    assert shear.size == modes.shape[0]


def test_inertia_is_that_of_the_free_body() -> None:
    """At rest the supported stiffness is positive definite: six pivots are gone, no other is negative."""
    ball = Slice(config(BALL, **{"dissipation.kind": "none"}))
    assert ball.free.size - ball.supported.size == 6
    assert ball.is_stable(0.0, np.zeros(ball.state_shape))


def test_supports_carry_no_load() -> None:
    """Grown without dissipation, the forces on the supports vanish: they prevent motion and nothing else."""
    run = simulate(
        config(BALL, **{"dissipation.kind": "none", "solver.increments": 2, "growth.duration": 100.0})
    )
    ball, u = run.slice, run.state_vector(-1)
    _, gradient = ball.tissue_energy(1.0, u).slope(u)
    held = np.setdiff1d(ball.free, ball.supported)
    tolerance = ball.stepping.criterion.force
    assert np.abs(gradient.ravel()[held]).max() < 20.0 * tolerance
    assert np.abs(u).max() > 0.5


def test_drag_holds_a_free_body_where_it_is() -> None:
    run = simulate(config(BALL, **{"solver.increments": 3, "mesh.node_jitter": 0.05}))
    ball, u = run.slice, run.state_vector(-1)
    mean = ball.lumped_area @ u / ball.lumped_area.sum()
    assert np.abs(mean).max() < 1e-6
    assert np.abs(u).max() > 1.0


def test_a_clamped_hole_holds_and_a_free_one_moves() -> None:
    hollow = {**BALL, "geometry.hole_fraction": 0.5, "solver.increments": 2, "growth.duration": 100.0}
    held, free = (simulate(config(hollow, **{"boundary.clamp": clamp})) for clamp in ("hole", "none"))
    inside = held.mesh.clamped
    assert not held.state_vector(-1)[inside].any()
    assert np.linalg.norm(free.state_vector(-1)[inside], axis=1).min() > 0.05


def test_a_ring_in_the_plane_may_be_free_too() -> None:
    from slices import TINY

    from gyrify.config import Config

    free = Config().with_overrides(
        {**TINY, "boundary.clamp": "none", "dissipation.kind": "none", "growth.duration": 60.0}
    )
    run = simulate(free.replace(**{"stability.detect": False}))
    problem = run.slice
    assert problem.free.size - problem.supported.size == 3
    assert np.linalg.norm(run.state_vector(-1)[run.mesh.clamped], axis=1).max() > 0.05


def test_sigmoid_growth_is_that_of_its_formula() -> None:
    body = Slice(config(BRAIN, **{"growth.law": "area", "growth.ratio": 3.6}))
    growth, mesh = body.growth, body.mesh
    depth = mesh.depth[mesh.cells].mean(axis=1)
    below = np.where(
        depth >= 1.0, 3.0 * (2.0 - depth), 3.0 + (np.cbrt(24.0 * 20.0 * 18.0) - 3.0) * (1.0 - depth)
    )
    share = 1.0 / (1.0 + np.exp(np.minimum(10.0 * (below / 3.0 - 1.0), 700.0)))
    assert growth.rate == pytest.approx(0.001 + 0.0026 * share)
    tensor, N = growth.tensor(300.0), mesh.across
    along, across = 1.0 + 300.0 * growth.rate, 1.0 + 0.3 * (1.0 - share)
    expected = (
        along[:, None, None] * np.eye(3) + (across - along)[:, None, None] * N[:, :, None] * N[:, None, :]
    )
    assert tensor == pytest.approx(expected, abs=1e-12)
    assert growth.volume(300.0) == pytest.approx(np.linalg.det(tensor))
    assert growth.inverse(300.0) @ tensor == pytest.approx(
        np.broadcast_to(np.eye(3), tensor.shape), abs=1e-12
    )
    assert growth.out_of_plane(300.0) == pytest.approx(1.0)
