"""Compiled kernels are kept across processes."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

EVALUATE = """
import numpy as np
from gyrify import Config
from gyrify.model.slice import Slice
size = {"mesh.n_around": 24, "mesh.n_layers": 4, "mesh.n_cortex_layers": 2}
problem = Slice(Config.preset("reference-slice").with_overrides(size))
u = np.zeros_like(problem.mesh.points)
term = problem.elastic_energy(problem.kinematics(1.0))
term.evaluate(u, 2, project_psd=True)
term.max_step(u, u)
"""


def compiled_files(cache: Path) -> set[str]:
    """Evaluate an energy in a process of its own; names of what the cache then holds."""
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(cache), "OMP_NUM_THREADS": "1"}
    subprocess.run([sys.executable, "-c", EVALUATE], env=environment, check=True, capture_output=True)
    return {file.name for file in cache.rglob("*.nbc")}


@pytest.mark.slow
def test_a_second_process_compiles_nothing(tmp_path: Path) -> None:
    first = compiled_files(tmp_path)
    assert first
    assert compiled_files(tmp_path) == first
