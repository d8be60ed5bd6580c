"""The classifier: dimensionless numbers in, one label out, with the rule that gave it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from gyrify.metrics import Measures
from gyrify.phenotype.rules import Rules, load_rules
from gyrify.phenotype.shape_numbers import shape_numbers


@dataclass(frozen=True)
class Phenotype:
    """What a folded slice looks like, and why it is called so.

    Attributes
    ----------
    label : str
        One of `gyrify.phenotype.LABELS`.
    rule : str
        Name of the rule that fired.
    sentence : str
        What that rule says.
    because : str
        Its conditions with their values; where it has none, the numbers on which no other rule fired.
    numbers : dict
        All numbers the rules know [-].
    """

    label: str
    rule: str
    sentence: str
    because: str
    numbers: dict[str, float]


def classify(
    metrics: Measures | Mapping[str, Any], thickness: float, *, rules: Rules | None = None
) -> Phenotype:
    """Tell the phenotype of a folded slice.

    Parameters
    ----------
    metrics : Measures or mapping
        Metrics of a state, or a row with the names of ``metrics.csv`` (lengths in mm).
    thickness : float
        Cortical thickness at the end of growth if nothing held it back [mm], > 0; see `grown_thickness`.
    rules : Rules, optional
        Those of the package by default.

    Returns
    -------
    Phenotype
        Exactly one label for every admissible slice: rules are tried in order, and the last always fires.

    Raises
    ------
    ConfigError
        If a metric is missing, not finite or out of range; of a body in space, if a rule asks for a number
        that has no meaning there before one fires: only ``smooth``, and ``lissencephaly`` by depth, are left.
    """
    known = rules or load_rules()
    numbers = shape_numbers(metrics, thickness, known.normal_gyri)
    rule = known.first(numbers)
    because = ", ".join(condition.text(numbers) for condition in rule.when) or _plain(known, numbers)
    return Phenotype(rule.label, rule.name, rule.sentence, because, numbers)


def _plain(rules: Rules, numbers: Mapping[str, float]) -> str:
    """The numbers that rules look at."""
    looked_at = dict.fromkeys(condition.number for rule in rules.rules for condition in rule.when)
    return ", ".join(f"{name} = {numbers[name]:.3g}" for name in looked_at)
