"""Configurations of small bodies in space."""

from __future__ import annotations

from typing import Any

from gyrify.config import Config

BALL = {
    "geometry.shape": "sphere",
    "geometry.semi_axes": (36.0, 36.0, 36.0),
    "geometry.hole_fraction": 0.0,
    "geometry.cortical_thickness": 3.0,
    "mesh.edge_length": 10.0,
    "mesh.n_layers": 5,
    "mesh.n_cortex_layers": 2,
    "stability.detect": False,
}
# Folds within seconds, with walls of sulci in contact.
BRAIN = {
    "geometry.shape": "ellipsoid",
    "geometry.semi_axes": (24.0, 20.0, 18.0),
    "geometry.hole_fraction": 0.0,
    "geometry.cortical_thickness": 3.0,
    "mesh.edge_length": 3.3,
    "mesh.n_layers": 6,
    "mesh.n_cortex_layers": 2,
    "mesh.element": "mean_dilatation",
    "mesh.node_jitter": 0.02,
    "growth.law": "area",
    "growth.profile": "sigmoid",
    "growth.rate": 0.0036,
    "growth.ratio": 1e4,
    "material.stiffness_ratio": 3.0,
    "dissipation.number": 0.2,
    "solver.increments": 14,
    "stability.detect": False,
}
PATCH = {
    "geometry.shape": "patch",
    "geometry.length": 10.0,
    "geometry.width": 8.0,
    "geometry.depth": 12.0,
    "mesh.edge_length": 2.0,
    "mesh.n_layers": 5,
    "mesh.n_cortex_layers": 2,
    "stability.detect": False,
}


def config(base: dict[str, Any], **overrides: Any) -> Config:
    """A body with some values replaced."""
    return Config().with_overrides({**base, **overrides})
