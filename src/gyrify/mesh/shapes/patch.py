"""Patch: a flat grey film on a deep white substrate, periodic along x and y, clamped below."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gyrify.mesh.nested_surface import NestedSurface, periodic_sheet
from gyrify.mesh.shapes.shape import FloatArray, require_white_matter

# Squares along the shorter period of the coarsest level: with two, a cell and its image would be one.
_FEWEST = 4


@dataclass(frozen=True)
class Patch:
    """Box 0 <= x < length, 0 <= y < width, 0 <= z <= height, with the interface at z = height - T.

    Attributes
    ----------
    length, width : float
        Periods in x and y [mm].
    height : float
        Of the outer surface above the clamped plane [mm], cortex included.
    cortical_thickness : float
        Thickness T of the grey layer [mm].

    Raises
    ------
    MeshError
        If no white matter is left.
    """

    length: float
    width: float
    height: float
    cortical_thickness: float
    n_dim: ClassVar[int] = 3
    is_solid: ClassVar[bool] = False

    def __post_init__(self) -> None:
        require_white_matter(self.cortical_thickness, self.height, is_flat=True)

    @property
    def periods(self) -> tuple[float, float]:
        """See `SolidShape`."""
        return self.length, self.width

    @property
    def wall(self) -> tuple[float, float]:
        """See `SolidShape`."""
        return self.height - self.cortical_thickness, self.cortical_thickness

    @property
    def narrowest_wall(self) -> float:
        """See `SolidShape`."""
        return self.height

    def surface(self, edge: float, n_halvings: int) -> NestedSurface:
        """See `SolidShape`: squares of side ``edge``, as nearly as an even number of them allows."""
        finest = [max(period / edge, _FEWEST) for period in self.periods]
        # How often halving leads from a coarse sheet to this one.
        own = max(int(np.floor(np.log2(min(finest) / _FEWEST))), 0)
        n_x, n_y = (max(2 * round(n / 2**own / 2), _FEWEST) for n in finest)
        return periodic_sheet(n_x, n_y, own + n_halvings)

    def edge(self, surface: NestedSurface, depth: float) -> float:  # noqa: ARG002
        """See `SolidShape`: of equilateral triangles of the same area."""
        n = surface.triangles[-1].shape[0]
        return float(np.sqrt(4.0 * self.length * self.width / (np.sqrt(3.0) * n)))

    def points(self, places: FloatArray, depth: FloatArray) -> FloatArray:
        """See `SolidShape`; parameters are positions along the periods."""
        white, T = self.wall
        height = np.minimum(depth, 1.0) * white + np.maximum(depth - 1.0, 0.0) * T
        return np.stack([self.length * places[:, 0], self.width * places[:, 1], height], axis=1)

    def normals(self, points: FloatArray, depth: FloatArray) -> FloatArray:  # noqa: ARG002
        """See `SolidShape`."""
        return np.tile([0.0, 0.0, 1.0], (points.shape[0], 1))

    def moved(self, places: FloatArray, depth: FloatArray, shift: FloatArray) -> FloatArray:  # noqa: ARG002
        """See `SolidShape`."""
        return np.asarray(places + shift[:, :2] / np.array(self.periods))
