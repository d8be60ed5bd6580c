"""The code of the benchmarks is no part of the package: it is found beside it."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from gyrify import Config
from gyrify.model.slice import Slice

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

SMALL = {
    "mesh.n_around": 48,
    "mesh.n_layers": 6,
    "mesh.n_cortex_layers": 2,
    "material.stiffness_ratio": 0.7,
    "material.poisson_ratio_white": 0.4,
    "solver.increments": 8,
}


@pytest.fixture
def problem() -> Slice:
    """A small slice whose cells differ in growth and in both moduli."""
    return Slice(Config.preset("reference-slice").with_overrides(SMALL))


@pytest.fixture
def state(problem: Slice, rng: np.random.Generator) -> np.ndarray:
    """A displacement that inverts no cell and is nothing special."""
    x = problem.mesh.points
    return 0.1 * x + 0.01 * rng.normal(size=x.shape)
