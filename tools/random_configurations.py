"""Random valid configurations, each a function of a space, a seed and a number.

``wide`` spans what the configuration allows and the solver should bear; ``box`` is where a study would be:
stiffness ratio 1/3 to 3, growth ratio 1 to 360, cortex 0.75 to 8 mm. All else is drawn alike in both. A draw
that the configuration refuses (two fields do not go together) or that cannot be meshed (slivers) is drawn
again.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from gyrify import Config
from gyrify.errors import ConfigError, MeshError
from gyrify.model.meshing import build_mesh

Values = dict[str, Any]
RANGES: Final[dict[str, dict[str, tuple[float, float]]]] = {
    "wide": {
        "material.stiffness_ratio": (0.1, 20.0),
        "growth.ratio": (0.5, 1000.0),
        "geometry.cortical_thickness": (0.3, 12.0),
    },
    "box": {
        "material.stiffness_ratio": (1 / 3, 3.0),
        "growth.ratio": (1.0, 360.0),
        "geometry.cortical_thickness": (0.75, 8.0),
    },
}
SPACES: Final = tuple(RANGES)
N_AROUND: Final = (48, 60, 72, 96, 144)
N_AROUND_SHARES: Final = (0.45, 0.25, 0.17, 0.1, 0.03)
DRAG: Final = (1e-3, 13.0)


def configuration(space: str, seed: int, number: int) -> Config:
    """The configuration of this number: valid, and meshed without slivers."""
    rng = np.random.default_rng([SPACES.index(space), seed, number])
    while True:
        values = draw(space, rng)
        try:
            config = Config.preset("reference-slice").with_overrides(values)
            build_mesh(config)
        except (ConfigError, MeshError):
            continue
        return config


def draw(space: str, rng: np.random.Generator) -> Values:
    """Values by dotted key, which need not go together."""
    parts = (_numbers(space, rng), _reading(rng), _shape(rng), _mesh(rng), _dissipation(rng), _rest(rng))
    return {key: value for part in parts for key, value in part.items()}


def _numbers(space: str, rng: np.random.Generator) -> Values:
    """What the spaces differ in, by its logarithm; Poisson ratios, two in half of all."""
    values: Values = {key: _log_uniform(rng, *bounds) for key, bounds in RANGES[space].items()}
    values["material.poisson_ratio"] = float(rng.uniform(0.2, 0.495))
    if rng.random() < 0.5:
        values["material.poisson_ratio_white"] = float(rng.uniform(0.2, 0.495))
    return values


def _reading(rng: np.random.Generator) -> Values:
    return {
        "growth.out_of_plane": _one_of(rng, "blocked", "none", "generalised"),
        "growth.stretch": _one_of(rng, "linear", "exponential"),
        "growth.energy_per": _one_of(rng, "grown", "reference"),
        "growth.law": _one_of(rng, "isotropic", "tangential"),
    }


def _shape(rng: np.random.Generator) -> Values:
    shape = _one_of(rng, "ellipse", "ellipse", "circle", "strip")
    if shape == "strip":
        return {"geometry.shape": shape, "geometry.length": float(rng.uniform(20.0, 80.0))}
    return {
        "geometry.shape": shape,
        "geometry.aspect_ratio": float(rng.uniform(1.0, 2.0)),
        "geometry.hole_fraction": float(rng.uniform(0.2, 0.6)),
    }


def _mesh(rng: np.random.Generator) -> Values:
    cortex = int(rng.integers(2, 7))
    values: Values = {
        "mesh.n_around": int(rng.choice(N_AROUND, p=N_AROUND_SHARES)),
        "mesh.n_cortex_layers": cortex,
        "mesh.n_layers": cortex + int(rng.integers(3, 9)),
        "mesh.grading": _one_of(rng, "geometric", "uniform"),
        "mesh.split": _one_of(rng, "alternating", "one", "random"),
        "mesh.node_jitter": _one_of(rng, 0.0, 1e-3, 1e-3, 1e-2),
        "mesh.element": _one_of(rng, "linear", "linear", "quadratic", "mean_dilatation"),
        "mesh.refine_cortex": int(rng.random() < 0.1),
    }
    if values["mesh.element"] == "quadratic":  # four times the points of linear cells
        values["mesh.n_around"] = min(60, values["mesh.n_around"])
        values["mesh.inversion_resistance"] = 0.1
    return values


def _dissipation(rng: np.random.Generator) -> Values:
    """Numbers by their logarithm, and none in one of sixteen, of which half follow a branch."""
    if rng.random() < 1 / 16:
        kind = _one_of(rng, "none", "drag")
        return {
            "dissipation.kind": kind,
            "dissipation.number": 0.0,
            "stability.follow_branch": bool(rng.random() < 0.5),
            "stability.sign": _one_of(rng, 1, -1),
        }
    return {
        "dissipation.kind": _one_of(rng, "drag", "drag", "kelvin_voigt"),
        "dissipation.number": _log_uniform(rng, *DRAG),
    }


def _rest(rng: np.random.Generator) -> Values:
    return {
        "seed": int(rng.integers(2**32)),
        "contact.enabled": bool(rng.random() < 0.95),
        "contact.activation_fraction": _log_uniform(rng, 0.02, 0.3),
        "solver.increments": int(rng.choice((20, 20, 30, 40))),
        "solver.regularisation": _one_of(rng, "shift", "shift", "shift", "projection"),
        "stability.detect": True,
    }


def _log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def _one_of(rng: np.random.Generator, *values: Any) -> Any:
    return values[int(rng.integers(len(values)))]
