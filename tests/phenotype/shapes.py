"""Rings whose folds are drawn by hand, with the phenotype a reader would give them."""

from __future__ import annotations

import numpy as np
import shapely

from gyrify.metrics import Measures, measure

RADIUS, THICKNESS = 60.0, 3.0


def ring(r: np.ndarray) -> np.ndarray:
    angle = np.arange(len(r)) * (2 * np.pi / len(r))
    return np.column_stack([r * np.cos(angle), r * np.sin(angle)])


def waves(k: int, depth: float, power: float = 1.0, *, uniform: bool = False, n: int = 1440) -> Measures:
    """Ring with k gyri of this depth [mm]; ``power`` flattens the crowns between ever narrower sulci.

    The interface follows the sulci by four fifths, so that the cortex is thicker at crowns, or lies at the
    same distance from the contour everywhere.
    """
    dip = (0.5 - 0.5 * np.cos(np.arange(n) * (2 * np.pi * k / n))) ** power
    outer = ring(RADIUS - depth * dip)
    inner = ring(RADIUS - THICKNESS - 0.8 * depth * dip)
    if uniform:
        inner = shapely.get_coordinates(shapely.Polygon(outer).buffer(-THICKNESS).exterior)[:-1]
    return measure(outer, inner)
