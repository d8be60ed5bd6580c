r"""A shape of one's own: a slice with the outline of a superellipse, squarer than an ellipse.

.. math:: |x / a|^n + |y / b|^n = 1, \quad n = 3

Run it: ``python examples/own_shape.py``
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import gyrify
from gyrify.mesh.shapes import SHAPES, Ellipse

EXPONENT = 3.0


class Superellipse(Ellipse):
    """Wall between two superellipses; what is not said here is as of the ellipse with the same axes."""

    n_mirrors = 0

    @property
    def area(self) -> float:
        """Inside the contour [mm^2]."""
        factor = math.gamma(1.0 + 1.0 / EXPONENT) ** 2 / math.gamma(1.0 + 2.0 / EXPONENT)
        return 4.0 * self.semi_axes[0] * self.semi_axes[1] * factor

    def points(self, along: np.ndarray, depth: np.ndarray) -> np.ndarray:
        """(n, 2) places [mm]: those of the ellipse, moved outwards along their direction."""
        x = super().points(along, depth)
        axes = np.stack(self._axes(depth), axis=1)
        return x / np.sum(np.abs(x / axes) ** EXPONENT, axis=1, keepdims=True) ** (1.0 / EXPONENT)

    def normals(self, along: np.ndarray, depth: np.ndarray) -> np.ndarray:
        """(n, 2) gradients of the equation of the superellipse through each place."""
        axes = np.stack(self._axes(depth), axis=1)
        scaled = self.points(along, depth) / axes
        normal = np.sign(scaled) * np.abs(scaled) ** (EXPONENT - 1.0) / axes
        return normal / np.linalg.norm(normal, axis=1, keepdims=True)


def superellipse(geometry: Any) -> Superellipse:
    """The shape of the section ``geometry`` of a configuration."""
    return Superellipse(geometry.outer_axes, geometry.hole_fraction, geometry.cortical_thickness)


if __name__ == "__main__":
    SHAPES["superellipse"] = superellipse
    coarse = {"mesh.n_around": 108, "mesh.n_layers": 9, "mesh.n_cortex_layers": 3}
    config = gyrify.Config().with_overrides({"geometry.shape": "superellipse", **coarse})
    print(gyrify.measure_state(gyrify.simulate(config)))
