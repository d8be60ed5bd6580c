"""The explicit step integrates the same tissue, and its stable step is the one of its stiffness."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bench.body import Body, stable_step
from bench.peers.explicit import add_forces

from gyrify import simulate
from gyrify.model.slice import Slice


def test_forces_are_those_of_the_energy(problem: Slice, state: np.ndarray) -> None:
    time = 350.0
    energy = problem.elastic_energy(problem.kinematics(time)).evaluate(state, 1)
    cells, forces = problem.simplices, np.zeros_like(state)
    stretch = 1.0 + problem.growth.rate * time
    value = add_forces(
        state,
        cells.cells,
        cells.gradients,
        cells.volumes,
        stretch,
        problem.parameters[0],
        problem.bulk_modulus,
        forces,
    )
    assert value == pytest.approx(energy.value, rel=1e-12)
    np.testing.assert_allclose(-forces, energy.gradient, rtol=0, atol=1e-10 * np.abs(forces).max())


def test_step_is_stable_below_the_limit_and_not_above(problem: Slice) -> None:
    limit = stable_step(problem, np.zeros(problem.state_shape), 0.0, with_contact=False)
    body = replace(Body.of(problem), damping=0.0, duration=np.inf)
    rng, sizes = np.random.default_rng(0), []
    for dt in (0.98 * limit, 1.02 * limit):
        u, v = 1e-8 * rng.normal(size=problem.state_shape), np.zeros(problem.state_shape)
        u[problem.mesh.clamped] = 0.0
        body.advance(300, dt, 0.0, u, v)
        sizes.append(np.abs(u).max())
    assert sizes[0] < 1e-6
    assert not sizes[1] < 1e-6


def test_slow_loading_leads_where_the_quasi_static_run_leads(problem: Slice) -> None:
    grown, config = 0.3, problem.config
    body = Body.of(problem)
    dt = 0.8 * stable_step(problem, np.zeros(problem.state_shape), 0.0, with_contact=False)
    u, v = np.zeros(problem.state_shape), np.zeros(problem.state_shape)
    number = int(np.ceil(grown * body.duration / dt))
    elastic, kinetic = body.advance(number, grown * body.duration / number, 0.0, u, v)
    # the drag number counts by the duration, of which only a part passes
    part = {
        "growth.duration": grown * config.growth.duration,
        "dissipation.number": config.dissipation.number / grown,
        "solver.increments": 40,
    }
    slow = simulate(config.with_overrides(part)).state_vector(-1)
    assert kinetic < 0.01 * elastic
    assert np.abs(u - slow).max() < 0.02 * np.abs(slow).max()


def test_both_ways_to_take_steps_are_the_same_where_nothing_touches(problem: Slice) -> None:
    body, number = Body.of(problem), 400
    short = replace(body, duration=1e-3 * body.duration)
    u, v = np.zeros(problem.state_shape), np.zeros(problem.state_shape)
    short.advance(number, short.duration / number, 0.0, u, v)
    folded, _ = short.fold(number)
    assert np.abs(u).max() > 0.0
    np.testing.assert_allclose(folded, u, rtol=1e-9, atol=1e-14)


def test_an_unstable_step_is_reported(problem: Slice) -> None:
    with pytest.raises(RuntimeError, match="fails at step"):
        Body.of(problem).fold(60)
