"""A tiny run to damage: its configuration, and the bytes of its journal."""

from __future__ import annotations

import functools
import tempfile
from pathlib import Path

from gyrify.config import Config
from gyrify.run.simulation import simulate

TINY = {
    "mesh.n_around": 24,
    "mesh.n_layers": 4,
    "mesh.n_cortex_layers": 2,
    "geometry.cortical_thickness": 6.0,
    "growth.duration": 20.0,
    "solver.increments": 2,
    "solver.linear_solver": "superlu",
    "output.fields": ["displacement", "region"],
}


@functools.cache
def tiny_config() -> Config:
    """Its configuration."""
    return Config.preset("reference-slice").with_overrides(TINY)


@functools.cache
def journal_bytes() -> bytes:
    """Its journal: three states of 120 points."""
    with tempfile.TemporaryDirectory() as folder:
        simulate(tiny_config(), folder)
        return (Path(folder) / "journal.sqlite").read_bytes()
