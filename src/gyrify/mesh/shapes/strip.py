"""Strip: a grey film on a deep white substrate, periodic along x, clamped below and free above."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gyrify.mesh.shapes.shape import FloatArray, IntArray, require_white_matter
from gyrify.mesh.symmetry import Mirror


@dataclass(frozen=True)
class PeriodicStrip:
    """Rectangle 0 <= x < length, 0 <= y <= height, with the interface at y = height - T.

    The contour and the interface run towards +x; the outward direction is +y.

    Attributes
    ----------
    length : float
        Period in x [mm].
    height : float
        Of the contour above the clamped line [mm], cortex included.
    cortical_thickness : float
        Thickness T of the grey layer [mm].

    Raises
    ------
    MeshError
        If no white matter is left.
    """

    length: float
    height: float
    cortical_thickness: float
    n_dim: ClassVar[int] = 2
    is_closed: ClassVar[bool] = False
    n_mirrors: ClassVar[int] = 1

    def __post_init__(self) -> None:
        require_white_matter(self.cortical_thickness, self.height, is_flat=True)

    @property
    def period(self) -> float:
        """See `Shape`."""
        return self.length

    @property
    def wall(self) -> tuple[float, float]:
        """See `Shape`."""
        return self.height - self.cortical_thickness, self.cortical_thickness

    @property
    def area(self) -> float:
        """See `Shape`."""
        return self.length * self.height

    @property
    def narrowest_wall(self) -> float:
        """See `Shape`."""
        return self.height

    def points(self, along: FloatArray, depth: FloatArray) -> FloatArray:
        """See `Shape`."""
        white, T = self.wall
        height = np.minimum(depth, 1.0) * white + np.maximum(depth - 1.0, 0.0) * T
        return np.stack([self.length * along, height], axis=1)

    def normals(self, along: FloatArray, depth: FloatArray) -> FloatArray:  # noqa: ARG002
        """See `Shape`."""
        return np.tile([0.0, 1.0], (along.size, 1))

    def mirrored(
        self, points: FloatArray, images: Sequence[IntArray]
    ) -> tuple[FloatArray, tuple[Mirror, ...]]:
        """See `Shape`: each point is at x = length less that of its image, exactly, and as high."""
        image, length = images[0], self.length
        own, unit = np.arange(image.size), np.spacing(length)
        # on this grid the difference to the length has no rounding
        x, y = np.round(points[:, 0] / unit) * unit, points[:, 1]
        x = np.where(own < image, x, length - x[image])
        middle = np.where(points[:, 0] < 0.25 * length, 0.0, 0.5 * length)
        exact = np.stack([np.where(own == image, middle, x), np.where(own < image, y, y[image])], axis=1)
        return exact, tuple(Mirror(0, image) for image in images)
