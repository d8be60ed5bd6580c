"""Configurations of public questions and papers that end smooth, locked or crushed on the default mesh."""

from __future__ import annotations

from typing import Any

from gyrify.config import Config

# Grey matter softer by 1/1.691, growth of the cortex alone along the layers.
PUBLISHED: dict[str, Any] = {
    "geometry.cortical_thickness": 1.48,
    "material.stiffness_ratio": 1 / 1.691,
    "material.poisson_ratio": 0.406,
    "growth.rate": 1.829 / 500,
    "growth.ratio": 1e4,
    "growth.law": "tangential",
}
THIN: dict[str, Any] = {"geometry.cortical_thickness": 0.5, "mesh.n_around": 72}
COARSE: dict[str, Any] = {"mesh.n_around": 48, "mesh.n_layers": 6, "mesh.n_cortex_layers": 2}


def case(*parts: dict[str, Any], **more: Any) -> Config:
    """The standard slice with some values replaced."""
    merged: dict[str, Any] = {}
    for part in (*parts, more):
        merged |= part
    return Config().replace(**merged)
