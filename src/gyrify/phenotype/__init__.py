"""Phenotypes: a label for a folded slice by documented rules on dimensionless numbers."""

from gyrify.phenotype.classify import Phenotype, classify
from gyrify.phenotype.rules import LABELS, Condition, Rule, Rules, load_rules
from gyrify.phenotype.shape_numbers import grown_thickness, shape_numbers

__all__ = [
    "LABELS",
    "Condition",
    "Phenotype",
    "Rule",
    "Rules",
    "classify",
    "grown_thickness",
    "load_rules",
    "shape_numbers",
]
