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
# A hollow body in space that is cheap and shows every field.
LUMP = {
    "geometry.shape": "ellipsoid",
    "geometry.semi_axes": (24.0, 20.0, 18.0),
    "geometry.hole_fraction": 0.3,
    "geometry.cortical_thickness": 4.0,
    "mesh.edge_length": 8.0,
    "mesh.n_layers": 4,
    "mesh.n_cortex_layers": 2,
    "growth.law": "area",
    "growth.rate": 0.003,
    "material.stiffness_ratio": 3.0,
    "dissipation.number": 0.2,
    "metrics.closing_radius": 12.0,
    "solver.increments": 4,
    "stability.detect": False,
}
