"""What a body in space looks like before it is meshed: surfaces about each other, bent to a shape."""

from __future__ import annotations

from typing import ClassVar, Protocol, runtime_checkable

from gyrify.mesh.nested_surface import NestedSurface
from gyrify.mesh.shapes.shape import FloatArray


@runtime_checkable
class SolidShape(Protocol):
    """A body in space with a cortex under its outer surface.

    A place has parameters on a surface (of `NestedSurface`) and a depth: 0 on the hole, in the middle or on
    the clamped side, 1 on the interface, 2 on the outer surface.

    Attributes
    ----------
    n_dim : int
        Dimension of the space it lies in: 3.
    is_solid : bool
        Whether depth 0 is a point in the middle, not a surface.
    periods : (float, float) or None
        Periods in x and y [mm].
    wall : (float, float)
        Thickness of white matter, typical of the body, and of the cortex [mm].
    narrowest_wall : float
        Smallest distance from the outer surface to the other end of the wall [mm].
    """

    n_dim: ClassVar[int]

    @property
    def is_solid(self) -> bool: ...
    @property
    def periods(self) -> tuple[float, float] | None: ...
    @property
    def wall(self) -> tuple[float, float]: ...
    @property
    def narrowest_wall(self) -> float: ...

    def surface(self, edge: float, n_halvings: int) -> NestedSurface:
        """Triangles of the outer surface with mean edges near a length [mm], then halved some times."""
        ...

    def edge(self, surface: NestedSurface, depth: float) -> float:
        """Mean edge of the finest level at a depth [mm]."""
        ...

    def points(self, places: FloatArray, depth: FloatArray) -> FloatArray:
        """(n, 3) places [mm]."""
        ...

    def normals(self, points: FloatArray, depth: FloatArray) -> FloatArray:
        """(n, 3) unit directions across the layers, outwards."""
        ...

    def moved(self, places: FloatArray, depth: FloatArray, shift: FloatArray) -> FloatArray:
        """Parameters of places after a shift (n, 3) [mm] along the surfaces."""
        ...
