"""The instruments see what they say they see, and leave nothing behind."""

from __future__ import annotations

import numpy as np
from bench import split
from bench.iteration import EVERY, METHODS, keeping
from bench.split import clocked

from gyrify import simulate
from gyrify.model.slice import Slice
from gyrify.solve.linear import SuperLU


def test_clocks_count_every_factorisation_and_come_off_again(problem: Slice) -> None:
    config = problem.config.with_overrides({"solver.linear_solver": "superlu", "stability.detect": False})
    before = dict(vars(SuperLU))
    with clocked() as clock:
        history = simulate(config)
    assert dict(vars(SuperLU)) == before
    # the last factorisation is that of the stability of the final state
    assert history.stats.factorizations <= clock.calls["factorisation"] <= history.stats.factorizations + 1
    assert clock.calls["symbolic analysis"] >= history.stats.analyses
    assert clock.calls["tissue energy"] > history.stats.newton_iterations
    assert set(clock.seconds) <= {*split.PARTS, *split.PHASES.values()}


def test_time_of_an_inner_part_is_not_counted_twice(monkeypatch) -> None:  # type: ignore[no-untyped-def]
    now = iter([0.0, 1.0, 4.0, 10.0])
    monkeypatch.setattr(split.time, "perf_counter", lambda: next(now))
    clock = split.Clock()
    inner = clock.wrap("inner", lambda: None)
    clock.wrap("outer", inner)()
    assert dict(clock.seconds) == {"inner": 3.0, "outer": 7.0}


def test_kept_matrices_are_those_that_were_factorised(problem: Slice) -> None:
    config = problem.config.with_overrides({"solver.linear_solver": "superlu"})
    with keeping("superlu") as kept:
        simulate(config)
    assert len(kept.matrices) == -(-kept.factorised // EVERY)
    number, data, method = kept.matrices[-1]
    assert method in METHODS
    indptr, indices = kept.patterns[number]
    assert indptr[-1] == indices.size == data.size
    solver, right = SuperLU(), np.ones(indptr.size - 1)
    solver.analyse(indptr, indices)
    assert np.isfinite(solver.factorise(data).solve(right)).all()
