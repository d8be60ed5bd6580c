"""The paper's observations as data, each with its rule."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib import resources

from gyrify.paper import rules_first, rules_numbers, rules_patterns
from gyrify.paper.checks import Rows, Verdict

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
    first_rule : str
        The rule as it was frozen before the first search; the same where it was not corrected since.
    first_judge : callable
        That rule.
    reason : str
        Why it was corrected; empty where it was not.
    """

    id: str
    statement: str
    paper: str
    where: str
    rule: str
    judge: RuleFunction
    first_rule: str
    first_judge: RuleFunction
    reason: str


@cache
def observations() -> tuple[Observation, ...]:
    """All of them, in order."""
    text = resources.files("gyrify").joinpath("paper", "observations.toml").read_text("utf-8")
    return tuple(_observation(entry) for entry in tomllib.loads(text)["observation"])


def _observation(entry: dict[str, str]) -> Observation:
    name, first = entry["id"].lower(), entry["rule"]
    judge = _rule(name)
    return Observation(
        **{key: entry[key] for key in ("id", "statement", "paper", "where")},
        rule=entry.get("corrected", first),
        judge=judge,
        first_rule=first,
        first_judge=getattr(rules_first, name, judge),
        reason=entry.get("reason", ""),
    )


def _rule(name: str) -> RuleFunction:
    module = rules_numbers if hasattr(rules_numbers, name) else rules_patterns
    found: RuleFunction = getattr(module, name)
    return found
