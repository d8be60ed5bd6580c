"""The paper's observations as data, each with its rule."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib import resources

from gyrify.paper import rules_numbers, rules_patterns
from gyrify.paper.verdict import Rows, Verdict

RuleFunction = Callable[[Rows], Verdict]


@dataclass(frozen=True)
class Observation:
    """What the paper reports, and how ours is compared.

    Attributes
    ----------
    id : str
        ``P1`` to ``P18``.
    statement : str
        What the paper says.
    paper : str
        Its value.
    where : str
        Where it says so.
    rule : str
        The rule in words.
    judge : callable
        The rule: rows of results to a `Verdict`.
    """

    id: str
    statement: str
    paper: str
    where: str
    rule: str
    judge: RuleFunction


@cache
def observations() -> tuple[Observation, ...]:
    """All of them, in order."""
    text = resources.files("gyrify").joinpath("paper", "observations.toml").read_text("utf-8")
    return tuple(
        Observation(**entry, judge=_rule(entry["id"])) for entry in tomllib.loads(text)["observation"]
    )


def _rule(name: str) -> RuleFunction:
    module = rules_numbers if hasattr(rules_numbers, name.lower()) else rules_patterns
    found: RuleFunction = getattr(module, name.lower())
    return found
