"""Shared configurations, meshes and runs; a run is computed once per session."""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
import pytest
from slices import FOLDING, TINY

from gyrify.config import Config
from gyrify.simulation import simulate
from gyrify.store import History


@pytest.fixture
def rng() -> np.random.Generator:
    """Random numbers, the same in every run of a test."""
    return np.random.default_rng(20190918)


@pytest.fixture(scope="session")
def folding() -> Config:
    """Configuration of the folding run."""
    return Config.preset("reference-slice").with_overrides(FOLDING)


@pytest.fixture(scope="session")
def tiny() -> Config:
    """Configuration of the smallest run."""
    return Config.preset("reference-slice").with_overrides(TINY)


@pytest.fixture(scope="session")
def folded(folding: Config) -> History:
    """A run whose sulci are in contact."""
    return simulate(folding)


@pytest.fixture(scope="session")
def overlapping(folding: Config) -> History:
    """The same run without contact."""
    return simulate(folding.replace(**{"contact.enabled": False}))
