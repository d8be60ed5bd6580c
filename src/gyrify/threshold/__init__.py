"""Critical values of one parameter: where the smooth state loses stability, or where folds are seen."""

from gyrify.threshold.critical import critical_growth
from gyrify.threshold.parameters import PARAMETERS
from gyrify.threshold.result import Crossing, Definition, Threshold

__all__ = ["PARAMETERS", "Crossing", "Definition", "Threshold", "critical_growth"]
