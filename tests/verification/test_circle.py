"""The growing circle against the exact one-dimensional state, which takes no mesh and no code of the solver.

Two measures of the error, both over the largest displacement. `mean`: the mean radial displacement of every
circle of points, which is what a one-dimensional state describes. `point`: the worst single point, which also
sees that points of four and of eight triangles move differently on a mesh of alternating diagonals.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from gyrify import simulate
from gyrify.config import Config
from gyrify.store import History
from gyrify.theory import Annulus, BaseState, base_state

CIRCLE = {
    "geometry.shape": "circle",
    "mesh.node_jitter": 0.0,
    "dissipation.kind": "none",
    "stability.detect": False,  # the circular branch, even where it has become unstable
    "contact.enabled": False,
    "solver.increments": 2,  # without dissipation and folds, the end does not depend on the path
}
COARSE = {"mesh.n_around": 216, "mesh.n_layers": 17, "mesh.n_cortex_layers": 6}
FINE = {"mesh.n_around": 432, "mesh.n_layers": 34, "mesh.n_cortex_layers": 12}


def exact(config: Config) -> BaseState:
    """The state at the end of growth; pi R^2 = area, moduli and rates as the configuration says."""
    R = np.sqrt(config.geometry.area / np.pi)
    growth, material = config.growth, config.material
    return base_state(
        Annulus(
            inner_radius=R * config.geometry.hole_fraction,
            outer_radius=R,
            cortical_thickness=config.geometry.cortical_thickness,
            young_modulus=material.young_modulus,
            stiffness_ratio=material.stiffness_ratio,
            poisson_ratio=material.poisson_ratio,
            poisson_ratio_white=material.poisson_ratio_white,
            growth_rate=growth.rate,
            growth_ratio=growth.ratio,
            duration=growth.duration,
            out_of_plane=growth.out_of_plane,
            stretch=growth.stretch,
            energy_per=growth.energy_per,
            law=growth.law,
        )
    )


def errors(history: History) -> tuple[float, float]:
    """Error of the circles' means, and of the worst point."""
    X = history.mesh.points
    R = np.linalg.norm(X, axis=1, keepdims=True)
    R_exact = np.clip(R, np.sqrt(history.config.geometry.area / np.pi) / 2, None)
    expected = (exact(history.config).radius(R_exact) / R_exact - 1) * X
    difference = history.displacement() - expected
    largest = np.linalg.norm(expected, axis=1).max()
    radial = (difference * X / R).sum(axis=1).reshape(-1, history.config.mesh.n_around)
    return abs(radial.mean(axis=1)).max() / largest, np.linalg.norm(difference, axis=1).max() / largest


@cache
def circle_errors(fine: bool, ratio: float, duration: float) -> tuple[float, float]:
    overrides = {**CIRCLE, **(FINE if fine else COARSE), "growth.ratio": ratio, "growth.duration": duration}
    return errors(simulate(Config.preset("reference-slice").with_overrides(overrides)))


# (growth ratio, duration): scaled time 0.4 is 200 of 500
@pytest.mark.parametrize(
    ("ratio", "duration", "largest_mean", "largest_point", "fall"),
    [(3.6, 200.0, 0.0035, 0.0050, 3.4), (1.0, 500.0, 0.035, 0.035, 2.4)],
)
def test_error_is_small_and_falls_when_the_mesh_is_halved(
    ratio: float, duration: float, largest_mean: float, largest_point: float, fall: float
) -> None:
    coarse_mean, coarse_point = circle_errors(False, ratio, duration)
    fine_mean, fine_point = circle_errors(True, ratio, duration)
    assert coarse_mean <= largest_mean
    assert coarse_point <= largest_point
    assert coarse_mean / fine_mean >= fall
    assert coarse_point / fine_point >= fall


@pytest.mark.parametrize(
    "reading",
    [
        {"material.stiffness_ratio": 2.0},
        {
            "material.stiffness_ratio": 0.5,
            "material.poisson_ratio": 0.3,
            "material.poisson_ratio_white": 0.45,
        },
        {"growth.ratio": 0.5},
        {"growth.out_of_plane": "none"},
        {"growth.stretch": "exponential"},
        {"growth.energy_per": "reference"},
        {"growth.law": "tangential"},
        {"growth.law": "tangential", "growth.out_of_plane": "none", "growth.ratio": 1.2},
        {"geometry.cortical_thickness": 6.0, "geometry.hole_fraction": 0.5},
    ],
    ids=lambda reading: ",".join(f"{key.partition('.')[2]}={value}" for key, value in reading.items()),
)
def test_every_reading_agrees_with_the_exact_state(reading: dict) -> None:
    """Scaled time 0.4, a third of the points around: the wrong reading is off by more than 5 %."""
    overrides = {
        **CIRCLE,
        **COARSE,
        "mesh.n_around": 144,
        "mesh.grading": "uniform",
        "growth.duration": 200.0,
    }
    mean, point = errors(simulate(Config.preset("reference-slice").with_overrides({**overrides, **reading})))
    assert mean <= 0.005
    assert point <= 0.01


def test_drag_slows_growth_down_and_vanishes_with_its_number() -> None:
    """The same circle with drag lags behind the exact state, the more the larger the number."""
    overrides = {**CIRCLE, **COARSE, "mesh.n_around": 96, "mesh.grading": "uniform", "growth.duration": 200.0}
    base = Config.preset("reference-slice").with_overrides(overrides)
    lags = []
    for number in (1e-4, 1.0, 100.0):
        history = simulate(base.replace(**{"dissipation.kind": "drag", "dissipation.number": number}))
        X = history.mesh.points[history.mesh.contour]
        R = np.linalg.norm(X, axis=1)
        moved = (history.contour() * X).sum(axis=1) / R - R
        lags.append(1 - moved.mean() / (float(exact(history.config).radius(R.mean())) - R.mean()))
    assert abs(lags[0]) < 0.005
    assert lags[0] < lags[1] < lags[2]
    assert lags[2] > 0.1
