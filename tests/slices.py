"""Configurations of slices that many tests run, as values that differ from the reference slice."""

from __future__ import annotations

# A slice that is cheap and still folds until its sulci close; few iterations, so that increments are halved.
FOLDING = {
    "mesh.n_around": 168,
    "mesh.n_layers": 8,
    "mesh.n_cortex_layers": 4,
    "growth.duration": 650.0,
    "solver.increments": 20,
    "solver.max_newton": 12,
}
# A slice for runs that only have to run.
TINY = {
    "mesh.n_around": 48,
    "mesh.n_layers": 6,
    "mesh.n_cortex_layers": 2,
    "solver.increments": 8,
}
