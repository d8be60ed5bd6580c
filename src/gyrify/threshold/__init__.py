"""Critical values of one parameter: where the smooth state loses stability, or where folds are seen."""

from gyrify.threshold.critical import critical_growth
from gyrify.threshold.crossings import Crossing, Definition, Threshold
from gyrify.threshold.scanned_parameter import PARAMETERS

__all__ = ["PARAMETERS", "Crossing", "Definition", "Threshold", "critical_growth"]
