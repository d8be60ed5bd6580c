"""Equal configurations give equal bytes: again, in other processes, and after an interruption."""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

from gyrify import resume, simulate
from gyrify.config import Config
from gyrify.store import History


def run_hash(toml: str) -> str:
    """Result hash of a run; at module level, so that a worker process finds it."""
    return simulate(Config.from_toml(toml)).result_hash


def interrupt_after(number: int):
    """Observer that stops the run as Ctrl-C would, once an increment has been accepted."""

    def observe(progress) -> None:
        if progress.state.index == number:
            raise KeyboardInterrupt

    return observe


def test_two_runs_give_the_same_hash_and_another_seed_does_not(tiny: Config) -> None:
    first = simulate(tiny).result_hash
    assert simulate(tiny).result_hash == first
    assert simulate(tiny.replace(seed=1)).result_hash != first


def test_hash_depends_on_every_bit(tiny: Config) -> None:
    """Growth longer by one unit in the last place."""
    longer = np.nextafter(tiny.growth.duration, np.inf)
    assert simulate(tiny.replace(**{"growth.duration": longer})).result_hash != simulate(tiny).result_hash


def test_one_and_two_worker_processes_give_the_same_hashes(tiny: Config) -> None:
    choices = [(seed, solver) for solver in ("auto", "superlu") for seed in (0, 1)]
    configs = [tiny.replace(**{"seed": s, "solver.linear_solver": solver}).to_toml() for s, solver in choices]
    here = [run_hash(config) for config in configs]
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        there = list(pool.map(run_hash, configs))
    assert there == here
    assert here[0] != here[1]


def test_a_resumed_run_equals_one_that_never_stopped(
    folding: Config, folded: History, tmp_path: Path
) -> None:
    number = len(folded) - 4  # sulci are in contact, couplings are in the pattern, increments were halved
    assert len(folded.journal.state(number).couplings) > 0
    assert len(folded) > folding.solver.increments + 1
    with pytest.raises(KeyboardInterrupt):
        simulate(folding, tmp_path / "run", observers=[interrupt_after(number)])
    stopped = History.load(tmp_path / "run")
    assert len(stopped) == number + 1
    assert stopped.status == "interrupted"
    assert stopped.result_hash != folded.result_hash
    finished = resume(tmp_path / "run")
    assert finished.status == "completed"
    assert finished.result_hash == folded.result_hash
    assert np.array_equal(finished.residuals, folded.residuals)
    assert finished.stats.newton_iterations == folded.stats.newton_iterations


def test_an_increment_depends_on_stored_state_alone(folded: History) -> None:
    """The increment after a stored state, solved by a problem that has never seen another one."""
    from gyrify.model.slice import Slice
    from gyrify.solve.quasistatic import grow

    number = len(folded) - 2
    problem = Slice(folded.config)
    recall = folded.journal.state
    following = next(iter(grow(problem, problem.stepping, recall(number), recall=recall)))
    assert following.couplings.size > 0
    assert np.array_equal(following.u, folded.displacement(number + 1))
