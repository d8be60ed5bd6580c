"""Hollow ellipse: the paper's brain slice, grey on the outside, white inside, a hole in the middle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gyrify.mesh.shapes.shape import FloatArray, IntArray, require_white_matter
from gyrify.mesh.symmetry import Mirror, symmetric_field


@dataclass(frozen=True)
class Ellipse:
    """Wall between the ellipses (h a, h b) and (a, b), with the interface on (a - T, b - T).

    Attributes
    ----------
    semi_axes : (float, float)
        Outer semi-axes a, b [mm].
    hole_fraction : float
        Semi-axes of the clamped hole over those of the contour, h.
    cortical_thickness : float
        Thickness T of the grey layer [mm].

    Raises
    ------
    MeshError
        If no white matter is left.
    """

    semi_axes: tuple[float, float]
    hole_fraction: float
    cortical_thickness: float
    n_dim: ClassVar[int] = 2
    is_closed: ClassVar[bool] = True
    period: ClassVar[None] = None
    n_mirrors: ClassVar[int] = 2

    def __post_init__(self) -> None:
        require_white_matter(self.cortical_thickness, self.narrowest_wall)

    @property
    def narrowest_wall(self) -> float:
        """See `Shape`."""
        return min(self.semi_axes) * (1.0 - self.hole_fraction)

    @property
    def _radius(self) -> float:
        a, b = self.semi_axes
        return float(np.sqrt(a * b))

    @property
    def wall(self) -> tuple[float, float]:
        """See `Shape`: that of the circle of equal area."""
        T = self.cortical_thickness
        return self._radius * (1.0 - self.hole_fraction) - T, T

    @property
    def length(self) -> float:
        """See `Shape`: that of the circle of equal area."""
        return 2.0 * np.pi * self._radius

    @property
    def area(self) -> float:
        """See `Shape`."""
        return float(np.pi * self.semi_axes[0] * self.semi_axes[1])

    def points(self, along: FloatArray, depth: FloatArray) -> FloatArray:
        """See `Shape`; the position along the layers is an eccentric angle."""
        angle = 2.0 * np.pi * along
        along_a, along_b = self._axes(depth)
        return np.stack([along_a * np.cos(angle), along_b * np.sin(angle)], axis=1)

    def normals(self, along: FloatArray, depth: FloatArray) -> FloatArray:
        """See `Shape`: those of the ellipses through the places."""
        angle = 2.0 * np.pi * along
        along_a, along_b = self._axes(depth)
        normal = np.stack([np.cos(angle) / along_a, np.sin(angle) / along_b], axis=1)
        return np.asarray(normal / np.linalg.norm(normal, axis=1, keepdims=True))

    def mirrored(
        self, points: FloatArray, images: Sequence[IntArray]
    ) -> tuple[FloatArray, tuple[Mirror, ...]]:
        """See `Shape`."""
        mirrors = tuple(Mirror(axis, image) for axis, image in zip((1, 0), images, strict=False))
        return symmetric_field(mirrors, points), mirrors

    def _axes(self, depth: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Semi-axes [mm] of the ellipse at a depth."""
        T, white, grey = self.cortical_thickness, np.minimum(depth, 1.0), np.maximum(depth - 1.0, 0.0)
        a, b = (
            h + white * (axis - T - h) + grey * T
            for axis in self.semi_axes
            for h in [self.hole_fraction * axis]
        )
        return a, b
