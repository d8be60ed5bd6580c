"""All simulations of one reading, and what they come to."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from gyrify.config import Config
from gyrify.errors import GyrifyError
from gyrify.paper.cases import BOTH, EQUAL, SOFT, Case, all_cases
from gyrify.paper.loss_of_stability import HIGHEST, stability_thresholds
from gyrify.paper.reading import Reading, point_of
from gyrify.paper.row import Row
from gyrify.paper.scoreboard import Scoreboard, score
from gyrify.paper.simulations import Simulations
from gyrify.paper.visible_folds import (
    higher_levels,
    next_higher,
    next_states,
    next_thresholds,
    visible_bracket,
)

# Rows of thresholds, and the stiffness ratio of each.
_ROWS: Final = {"P12": EQUAL, "P13": SOFT}


@dataclass(frozen=True, eq=False)
class Reproduction:
    """The paper in one reading.

    Attributes
    ----------
    reading : Reading
        The reading.
    rows : dict
        Results by case.
    scoreboard : Scoreboard
        How they compare.
    seed : int
        Seed of the node jitter.
    """

    reading: Reading
    rows: dict[Case, Row]
    scoreboard: Scoreboard
    seed: int = 0


def reproduce(
    simulations: Simulations, base: Config, reading: Reading, *, seed: int = 0, stability: bool = True
) -> Reproduction:
    """Run whatever of the paper's simulations is not known yet, and compare.

    Parameters
    ----------
    simulations : Simulations
        Who computes.
    base : Config
        Everything that no reading changes.
    reading : Reading
        The reading.
    seed : int
        Seed of the node jitter.
    stability : bool
        Whether the loss of stability of the smooth slice is located too, to stand beside the thresholds.

    Returns
    -------
    Reproduction

    Raises
    ------
    GyrifyError
        If nothing can compute.
    """
    rows = known_rows(simulations, base, reading, all_cases(), seed)
    todo: list[Case] = list(all_cases())
    while todo:
        simulations.run([point_of(base, reading.mechanics, case, seed) for case in todo])
        rows |= known_rows(simulations, base, reading, todo, seed)
        searches = (next_thresholds, next_higher, next_states)
        found = dict.fromkeys(case for e in BOTH for search in searches for case in search(rows, e))
        todo = [case for case in found if case not in rows]
    remarks = {name: higher_levels(rows, e) for name, e in _ROWS.items()}
    if stability:
        lost = _stability(simulations, base, reading, seed, rows)
        remarks = {name: ". ".join(filter(None, (remarks[name], lost[name]))) for name in _ROWS}
    return Reproduction(reading, rows, score(rows, str(reading), remarks), seed)


def known_rows(
    simulations: Simulations, base: Config, reading: Reading, cases: Iterable[Case], seed: int
) -> dict[Case, Row]:
    """Results that are known of some cases.

    Parameters
    ----------
    simulations : Simulations
        Who remembers.
    base, reading, seed
        As of `reproduce`.
    cases : iterable of Case
        Which ones.

    Returns
    -------
    dict
    """
    found = {}
    for case in cases:
        point = point_of(base, reading.mechanics, case, seed)
        row = simulations.row(point, reading.gi)
        if row is not None:
            found[case] = row
    return found


def _stability(
    simulations: Simulations, base: Config, reading: Reading, seed: int, rows: dict[Case, Row]
) -> dict[str, str]:
    """Remarks on the rows of thresholds; stability is lost before folds are seen."""
    configs = [point_of(base, reading.mechanics, Case(e), seed).config for e in _ROWS.values()]
    seen = [visible_bracket(rows, e) for e in _ROWS.values()]
    ends = [HIGHEST if bracket is None else min(1.1 * bracket.high, HIGHEST) for bracket in seen]
    try:
        found = stability_thresholds(simulations, configs, ends)
    except GyrifyError as failure:
        found = [f"not found ({failure.message})"] * 2
    told = "The smooth slice loses stability (no jitter, no dissipation): growth ratio"
    return {name: f"{told} {value}" for name, value in zip(_ROWS, found, strict=True)}
