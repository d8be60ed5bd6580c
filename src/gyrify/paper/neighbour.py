"""Readings next to a good one: a few axes drawn anew, and numbers moved a little."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final

import numpy as np

from gyrify.paper.reading import Mechanics
from gyrify.paper.space import EXPONENT, IMPERFECTION, NUMBER, rounded

# Chance that an axis is drawn anew, or that a number moves.
_DRAWN: Final = 0.12
_MOVED: Final = 0.5
# Standard deviations of a move: of the exponent, and of the logarithms of the other numbers.
_EXPONENT_STEP: Final = 0.06
_LOG_STEP: Final = 0.5
_WORDS: Final = ("out_of_plane", "stretch", "energy_per", "element", "grading", "split", "course")


def neighbour(parent: Mechanics, drawn: Mechanics, rng: np.random.Generator) -> Mechanics:
    """A mechanics that differs from another one in little.

    Parameters
    ----------
    parent : Mechanics
        The good one.
    drawn : Mechanics
        Where axes that are drawn anew take their values from.
    rng : Generator
        Which axes, and how far.

    Returns
    -------
    Mechanics
        Never the parent itself.
    """
    while True:
        changes: dict[str, Any] = {name: getattr(drawn, name) for name in _WORDS if rng.random() < _DRAWN}
        if rng.random() < _DRAWN:
            changes |= {"dissipation": drawn.dissipation, "number": drawn.number}
        if rng.random() < _DRAWN:
            changes["imperfection"] = drawn.imperfection
        found = _consistent(_moved(replace(parent, **changes), rng))
        if found != parent:
            return found


def _moved(one: Mechanics, rng: np.random.Generator) -> Mechanics:
    """Each number moved, or not."""
    moves = rng.random(3) < _MOVED
    steps = rng.normal(size=3)
    changes: dict[str, Any] = {}
    if moves[0]:
        changes["exponent"] = round(float(np.clip(one.exponent + _EXPONENT_STEP * steps[0], *EXPONENT)), 2)
    if moves[1] and one.number:
        changes["number"] = rounded(float(np.clip(one.number * np.exp(_LOG_STEP * steps[1]), *NUMBER)))
    if moves[2] and one.imperfection:
        moved = one.imperfection * np.exp(_LOG_STEP * steps[2])
        changes["imperfection"] = rounded(float(np.clip(moved, *IMPERFECTION)))
    return replace(one, **changes)


def _consistent(one: Mechanics) -> Mechanics:
    """Without what has no meaning."""
    if one.out_of_plane == "none":
        one = replace(one, exponent=1.0)
    return replace(one, number=0.0, course="constant") if one.dissipation == "none" else one
