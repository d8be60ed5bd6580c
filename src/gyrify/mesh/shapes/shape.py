"""What a body looks like before it is meshed: a wall with layers, bent to a shape."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from gyrify.errors import MeshError
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


def require_white_matter(thickness: float, wall: float, *, is_flat: bool = False) -> None:
    """Refuse a cortex that takes all of a wall.

    Parameters
    ----------
    thickness : float
        Of the cortex [mm].
    wall : float
        Narrowest place between the outer contour or surface and the other end of the wall [mm].
    is_flat : bool
        Whether the wall is the depth of a strip or a patch.

    Raises
    ------
    MeshError
        If no white matter is left.
    """
    if 0.0 < thickness < wall:
        return
    place = f" in {wall:.4g} mm" if is_flat else f": the wall is {wall:.4g} mm"
    deeper = ", or a larger geometry.depth" if is_flat else ""
    raise MeshError(
        f"geometry.cortical_thickness = {thickness:g} mm leaves no white matter{place}.",
        f"Choose a thickness between 0 and {0.95 * wall:.4g} mm{deeper}.",
    )
