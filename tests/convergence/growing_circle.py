"""The growing circle of a configuration, its exact state, and the distance between them."""

from __future__ import annotations

import numpy as np
from panels import Panel

from gyrify import simulate
from gyrify.config import Config
from gyrify.theory import Annulus, BaseState, base_state

CIRCLE = {
    "geometry.shape": "circle",
    "mesh.node_jitter": 0.0,
    "mesh.grading": "uniform",
    "dissipation.kind": "none",
    "stability.detect": False,  # the circular branch, even where it has become unstable
    "contact.enabled": False,
    "solver.increments": 2,  # without dissipation and folds, the end does not depend on the path
}


def configured(level: int, element: str, **overrides: object) -> Config:
    """48 x 5 quadrilaterals times the level, two fifths of them in the cortex."""
    mesh = {
        "mesh.n_around": 48 * level,
        "mesh.n_layers": 5 * level,
        "mesh.n_cortex_layers": 2 * level,
        "mesh.element": element,
    }
    return Config.preset("reference-slice").with_overrides({**CIRCLE, **mesh, **overrides})


def exact_state(config: Config) -> BaseState:
    """Axisymmetric state at the end of growth."""
    geometry, growth, material = config.geometry, config.growth, config.material
    R = float(np.sqrt(geometry.area / np.pi))
    return base_state(
        Annulus(
            inner_radius=R * geometry.hole_fraction,
            outer_radius=R,
            cortical_thickness=geometry.cortical_thickness,
            young_modulus=material.young_modulus,
            stiffness_ratio=material.stiffness_ratio,
            poisson_ratio=material.poisson_ratio,
            growth_rate=growth.rate,
            growth_ratio=growth.ratio,
            duration=growth.duration,
            out_of_plane=growth.out_of_plane,
        )
    )


def circle_errors(config: Config) -> tuple[float, float, float]:
    """Relative errors of the displacement in L2 and the H1 seminorm, and of the axial strain F33 - 1.

    The last is zero in plane strain.
    """
    history, state = simulate(config), exact_state(config)
    mesh, bounds = history.mesh, (state.annulus.inner_radius, state.annulus.outer_radius)

    def displacement(X: np.ndarray) -> np.ndarray:
        R = np.linalg.norm(X, axis=-1)
        return (state.radius(np.clip(R, *bounds)) / np.clip(R, *bounds) - 1.0)[..., None] * X

    def slope(X: np.ndarray) -> np.ndarray:
        R = np.linalg.norm(X, axis=-1)
        stretch = state.stretches(np.clip(R, *bounds).ravel()).reshape(*R.shape, 3)[..., None, None]
        normal = (X / R[..., None])[..., :, None]
        across = normal * np.swapaxes(normal, -1, -2)
        eye = np.eye(2)
        return (stretch[..., 0, :, :] - 1.0) * across + (stretch[..., 1, :, :] - 1.0) * (eye - across)

    panel = Panel(mesh.points, mesh.cells, mesh.patch, mesh.clamped, config.mesh.element)
    in_L2, in_H1 = panel.errors(history.displacement(), displacement, slope)
    axial = state.axial_stretch - 1.0
    off = abs(history.axial_stretch() - state.axial_stretch)
    return in_L2, in_H1, off / abs(axial) if axial else off
