"""A body of given tetrahedra."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from gyrify.mesh.shapes.shape import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class VolumeBody:
    """Tetrahedra, of which the outside is the surface of the cortex, and every inner boundary a hole.

    Attributes
    ----------
    points : (n_points, 3) float array
        [mm].
    cells : (n_cells, 4) int array
        Positive.
    grey : (n_cells,) bool array or None
        Which cells are grey matter; None where their depth tells.
    cortical_thickness : float
        Thickness T of the grey layer [mm].
    mean_radius : float
        Of the ball of equal volume, holes included [mm].
    plane : ((3,) float array, (3,) float array) or None
        A point on a plane of symmetry [mm] and its unit normal, which points out of the body.
    """

    points: FloatArray
    cells: IntArray
    grey: NDArray[np.bool_] | None
    cortical_thickness: float
    mean_radius: float
    plane: tuple[FloatArray, FloatArray] | None = None
    n_dim: ClassVar[int] = 3
    periods: ClassVar[None] = None

    @property
    def wall(self) -> tuple[float, float]:
        """Lengths of a depth of 1 below the interface and above it, both T [mm].

        The depth falls by the distance alone, so that the mean of a cell that lies on both sides is right.
        """
        return self.cortical_thickness, self.cortical_thickness

    @property
    def narrowest_wall(self) -> float:
        """No wall is wider than half the smallest extent [mm]."""
        return float(0.5 * np.ptp(self.points, axis=0).min())
