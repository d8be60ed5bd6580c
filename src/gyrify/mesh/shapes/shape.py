"""What a body looks like before it is meshed: a wall with layers, bent to a shape."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from gyrify.mesh.symmetry import Mirror

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class Shape(Protocol):
    """A planar body between a clamped side and a free contour, with a cortex under the latter.

    A place has a position along the layers, 0 to 1 and round again, and a depth: 0 on the clamped side, 1 on
    the interface, 2 on the contour.

    Attributes
    ----------
    n_dim : int
        Dimension of the space it lies in: 2.
    is_closed : bool
        Whether the layers run around a hole; otherwise along one period towards +x.
    period : float or None
        That period [mm].
    n_mirrors : int
        Lines of symmetry: through the position 0, or there and at a quarter; 0 for none.
    wall : (float, float)
        Thickness of the white wall, typical of the body, and of the cortex [mm]: what a depth of 1 means for
        the grading of the layers.
    length : float
        Length of the layers [mm], typical of the body: what a position of 1 means for the width of columns.
    area : float
        Inside the contour, a hole included; of a strip, of one period [mm^2].
    narrowest_wall : float
        Smallest distance from the contour to the clamped side [mm].
    """

    n_dim: ClassVar[int]

    @property
    def is_closed(self) -> bool: ...
    @property
    def period(self) -> float | None: ...
    @property
    def n_mirrors(self) -> int: ...
    @property
    def wall(self) -> tuple[float, float]: ...
    @property
    def length(self) -> float: ...
    @property
    def area(self) -> float: ...
    @property
    def narrowest_wall(self) -> float: ...

    def points(self, along: FloatArray, depth: FloatArray) -> FloatArray:
        """(n, 2) places [mm]."""
        ...

    def normals(self, along: FloatArray, depth: FloatArray) -> FloatArray:
        """(n, 2) unit directions across the layers, outwards."""
        ...

    def mirrored(
        self, points: FloatArray, images: Sequence[IntArray]
    ) -> tuple[FloatArray, tuple[Mirror, ...]]:
        """Points that are exactly their own mirror image, by the images about each line; the lines."""
        ...
