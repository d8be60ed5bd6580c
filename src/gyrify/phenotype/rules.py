"""The rules as data: read from ``rules.toml``, checked, and applied in their order."""

from __future__ import annotations

import operator
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any, Final

from gyrify.errors import ConfigError

LABELS: Final = ("smooth", "lissencephaly", "pachygyria", "polymicrogyria", "normal", "sinusoidal")
_COMPARISONS: Final[dict[str, tuple[Callable[[float, float], bool], str]]] = {
    "below": (operator.lt, "<"),
    "at_most": (operator.le, "≤"),
    "above": (operator.gt, ">"),
    "at_least": (operator.ge, "≥"),
}


@dataclass(frozen=True)
class Condition:
    """A comparison of one number with a limit.

    Attributes
    ----------
    number : str
        Name of the number.
    comparison : str
        ``below``, ``at_most``, ``above`` or ``at_least``.
    limit : float
        What it is compared with [-].
    """

    number: str
    comparison: str
    limit: float

    def holds(self, numbers: Mapping[str, float]) -> bool:
        """Whether it is true of these numbers."""
        compare, _ = _COMPARISONS[self.comparison]
        return compare(numbers[self.number], self.limit)

    def text(self, numbers: Mapping[str, float]) -> str:
        """The comparison with its value, such as ``hull = 1.002 ≤ 1.005``."""
        return f"{self.number} = {numbers[self.number]:.4g} {_COMPARISONS[self.comparison][1]} {self.limit:g}"


@dataclass(frozen=True)
class Rule:
    """A label for all shapes of which some conditions hold.

    Attributes
    ----------
    name, label : str
        Its name, and the phenotype it gives.
    when : tuple of Condition
        All must hold; none: always.
    sentence, source : str
        What it says, and where it is from.
    """

    name: str
    label: str
    when: tuple[Condition, ...]
    sentence: str
    source: str

    def fires(self, numbers: Mapping[str, float]) -> bool:
        """Whether all its conditions hold."""
        return all(condition.holds(numbers) for condition in self.when)


@dataclass(frozen=True)
class Rules:
    """Rules in order, and what they compare with.

    Attributes
    ----------
    version : int
        Raised with every change.
    normal_gyri : int
        Number of gyri of the normal slice.
    numbers : dict
        What each number means, by name.
    rules : tuple of Rule
        The last one always fires.
    """

    version: int
    normal_gyri: int
    numbers: dict[str, str]
    rules: tuple[Rule, ...]

    def first(self, numbers: Mapping[str, float]) -> Rule:
        """The rule that fires first.

        Raises
        ------
        ConfigError
            If a rule that comes before it asks for a number that the body does not have.
        """
        for rule in self.rules:
            missing = [c.number for c in rule.when if c.number not in numbers]
            if missing:
                raise ConfigError(
                    f"The body has no phenotype: the rule {rule.name!r} asks for {missing[0]} "
                    f"({self.numbers[missing[0]]}), which has no meaning in space.",
                    "In space a body is smooth, has lissencephaly by the depth of sulci, or has no label.",
                )
            if rule.fires(numbers):
                return rule
        raise ConfigError("No rule fires: the last one has conditions.", "Give it none.")


@cache
def load_rules() -> Rules:
    """Rules of the package."""
    return parse_rules(resources.files("gyrify").joinpath("phenotype", "rules.toml").read_text("utf-8"))


def parse_rules(text: str) -> Rules:
    """Read rules from TOML.

    Parameters
    ----------
    text : str
        As in ``rules.toml``.

    Returns
    -------
    Rules

    Raises
    ------
    ConfigError
        If a rule names an unknown label, number or comparison, or if some shape would be left without one.
    """
    data = tomllib.loads(text)
    numbers = dict(data["numbers"])
    rules = tuple(_rule(table, numbers) for table in data["rule"])
    if not rules or rules[-1].when:
        raise ConfigError("The last rule has conditions: some shapes would get no label.", "Give it none.")
    return Rules(data["version"], data["normal"]["n_gyri"], numbers, rules)


def _rule(table: Mapping[str, Any], numbers: Mapping[str, str]) -> Rule:
    if table["label"] not in LABELS:
        raise ConfigError(f"label = {table['label']!r} is unknown.", f"Choose one of {', '.join(LABELS)}.")
    when = tuple(_condition(entry, table["name"], numbers) for entry in table["when"])
    return Rule(table["name"], table["label"], when, table["sentence"], table["source"])


def _condition(entry: Mapping[str, Any], rule: str, numbers: Mapping[str, str]) -> Condition:
    comparisons = [key for key in entry if key != "number"]
    if entry.get("number") not in numbers or len(comparisons) != 1 or comparisons[0] not in _COMPARISONS:
        raise ConfigError(
            f"A condition of the rule {rule!r} is malformed: {dict(entry)}.",
            f"Give one of {', '.join(numbers)} and one of {', '.join(_COMPARISONS)}.",
        )
    return Condition(entry["number"], comparisons[0], float(entry[comparisons[0]]))
