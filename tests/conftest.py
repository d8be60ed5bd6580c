"""Shared configurations, meshes and runs; a run is computed once per session."""

from __future__ import annotations

import importlib.util
import os
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
import pytest
from slices import FOLDING, LUMP, TINY

from gyrify.config import Config
from gyrify.run.simulation import simulate
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
def lump() -> History:
    """A run of a body in space."""
    return simulate(Config().with_overrides(LUMP))


@pytest.fixture(scope="session")
def overlapping(folding: Config) -> History:
    """The same run without contact."""
    return simulate(folding.replace(**{"contact.enabled": False}))


@pytest.fixture(scope="session")
def example() -> Callable[[str], ModuleType]:
    """An example by the name of its file; examples stand beside the package, not in it."""
    folder = Path(__file__).resolve().parents[1] / "examples"

    def load(name: str) -> ModuleType:
        spec = importlib.util.spec_from_file_location(f"example_{name}", folder / f"{name}.py")
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module

    return load


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--sample", type=int, default=1, help="run every n-th of the slow tests")


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out slow tests but every n-th, as CI does to stay short; `make slow` runs them all."""
    every = config.getoption("--sample")
    slow = [item for item in items if item.get_closest_marker("slow")]
    left_out = {item.nodeid for number, item in enumerate(slow) if number % every}
    if left_out:
        config.hook.pytest_deselected(items=[item for item in items if item.nodeid in left_out])
        items[:] = [item for item in items if item.nodeid not in left_out]
