"""The slices that the benchmarks fold: `reference-slice`, whole or coarsened for a quick look."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from time import process_time
from typing import Any

import numpy as np

from gyrify import Config, History, simulate
from gyrify.errors import ConfigError
from gyrify.model.slice import Slice
from gyrify.run.simulation import new_run
from gyrify.solve.linear import linear_solver

# A slice that folds into contact in a fraction of a second, to try the benchmarks out.
QUICK = {
    "mesh.n_around": 144,
    "mesh.n_layers": 8,
    "mesh.n_cortex_layers": 3,
    "solver.increments": 40,
    "growth.duration": 600.0,
}


def configuration(quick: bool, overrides: Mapping[str, Any] | None = None) -> Config:
    """`reference-slice` with other values where asked for."""
    chosen = {**(QUICK if quick else {}), **(overrides or {})}
    return Config.preset("reference-slice").with_overrides(chosen)


def solvers() -> list[str]:
    """Linear solvers of this machine, the fastest first."""
    try:
        return [linear_solver("pardiso").name, "superlu"]
    except ConfigError:
        return ["superlu"]


def grown(config: Config) -> tuple[History, float]:
    """A run in memory, and the processor time of its growth [s], which no other process lengthens."""
    with new_run(config) as run:
        run.problem.compile()
        begun = process_time()
        run.grow()
        return run.history, process_time() - begun


@cache
def folded(quick: bool) -> History:
    """A finished run, for the state it ends in."""
    return simulate(configuration(quick))


def folded_state(quick: bool) -> tuple[Slice, np.ndarray, float]:
    """Problem, displacement [mm] and growth time of the folded slice."""
    history = folded(quick)
    return history.slice, history.state_vector(-1), history.config.growth.duration
