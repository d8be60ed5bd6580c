"""Metrics of a folded contour: plain functions of arrays of positions in mm."""

from gyrify.metrics.calibration import growth_ratio_from_scaling, growth_ratio_from_volumes, length_increase
from gyrify.metrics.contour import self_intersecting
from gyrify.metrics.folds import (
    Folds,
    LowModeShape,
    find_folds,
    fold_wavelength,
    low_mode_shape,
    periodic_extrema,
)
from gyrify.metrics.gap import min_gap
from gyrify.metrics.gyri import GyrusShapes, gyrus_shapes
from gyrify.metrics.gyrification import gyrification_index
from gyrify.metrics.measure import measure
from gyrify.metrics.measures import Measures
from gyrify.metrics.sharpness import fold_sharpness
from gyrify.metrics.sulci import closing_outline, sulcal_depth
from gyrify.metrics.thickness import cortical_thickness

__all__ = [
    "Folds",
    "GyrusShapes",
    "LowModeShape",
    "Measures",
    "closing_outline",
    "cortical_thickness",
    "find_folds",
    "fold_sharpness",
    "fold_wavelength",
    "growth_ratio_from_scaling",
    "growth_ratio_from_volumes",
    "gyrification_index",
    "gyrus_shapes",
    "length_increase",
    "low_mode_shape",
    "measure",
    "min_gap",
    "periodic_extrema",
    "self_intersecting",
    "sulcal_depth",
]
