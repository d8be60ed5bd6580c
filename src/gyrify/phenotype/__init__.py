"""Phenotypes: a label for a folded slice by documented rules on dimensionless numbers."""

from gyrify.phenotype.classify import Phenotype, classify
from gyrify.phenotype.numbers import grown_thickness, shape_numbers
from gyrify.phenotype.rules import LABELS, Condition, Rule, Rules, load_rules

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
