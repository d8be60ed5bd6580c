"""What quantities are measured of: a deformed contour with its interface, and what several of them share."""

from __future__ import annotations

from typing import Protocol

from gyrify.metrics.contour import FloatArray
from gyrify.metrics.folds import Folds
from gyrify.metrics.gyri import GyrusShapes


class Deformed(Protocol):
    """One deformed state, closed or one period of a strip; each part is computed when it is first read.

    Attributes
    ----------
    contour, interface : (n, 2) float array
        Outer contour and grey-white interface in order [mm].
    is_closed : bool
        Whether the contour is closed; otherwise it is one period towards +x.
    closing_radius : float
        Radius of the morphological closing [mm].
    crosses_itself : bool
        Whether the contour does.
    length : float
        Length of the contour [mm].
    hull_length, closed_length, exposed_length : float
        Lengths of the convex hull, of the closing's outline, and of what of the contour lies on that [mm].
    folds : Folds
        Gyri and sulci.
    depth : (n_gyri,) float array
        Depth of each fundus below the outline of the closing [mm]; one zero without folds.
    thickness : (float, float)
        Mean cortical thickness at crowns and at fundi [mm].
    gyri : GyrusShapes
        Width and flatness of the gyri.
    gap : float
        Smallest distance between pieces of the contour that are no neighbours [mm]; 0 if it crosses itself.
    """

    @property
    def closing_radius(self) -> float: ...
    @property
    def contour(self) -> FloatArray: ...
    @property
    def interface(self) -> FloatArray: ...
    @property
    def is_closed(self) -> bool: ...
    @property
    def crosses_itself(self) -> bool: ...
    @property
    def length(self) -> float: ...
    @property
    def hull_length(self) -> float: ...
    @property
    def closed_length(self) -> float: ...
    @property
    def exposed_length(self) -> float: ...
    @property
    def folds(self) -> Folds: ...
    @property
    def depth(self) -> FloatArray: ...
    @property
    def thickness(self) -> tuple[float, float]: ...
    @property
    def gyri(self) -> GyrusShapes: ...
    @property
    def gap(self) -> float: ...
