"""All simulations of one reading, and what they come to."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from gyrify.config import Config
from gyrify.errors import GyrifyError
from gyrify.paper.bench import Bench
from gyrify.paper.cases import BOTH, EQUAL, SOFT, Case, all_cases
from gyrify.paper.reading import Reading, point_of
from gyrify.paper.row import Row, row_of
from gyrify.paper.scoreboard import Scoreboard, score
from gyrify.paper.stability import HIGHEST, stability_thresholds
from gyrify.paper.threshold import next_states, next_thresholds, visible_bracket


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
    """

    reading: Reading
    rows: dict[Case, Row]
    scoreboard: Scoreboard


def reproduce(
    bench: Bench, base: Config, reading: Reading, *, seed: int = 0, stability: bool = True
) -> Reproduction:
    """Run whatever of the paper's simulations is not known yet, and compare.

    Parameters
    ----------
    bench : Bench
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
    rows = known_rows(bench, base, reading, all_cases(), seed)
    todo: list[Case] = list(all_cases())
    while todo:
        bench.run([point_of(base, reading.mechanics, case, seed) for case in todo])
        rows |= known_rows(bench, base, reading, todo, seed)
        searches = (next_thresholds, next_states)
        todo = [case for e in BOTH for search in searches for case in search(rows, e) if case not in rows]
    remarks = _stability(bench, base, reading, seed, rows) if stability else {}
    return Reproduction(reading, rows, score(rows, str(reading), remarks))


def known_rows(
    bench: Bench, base: Config, reading: Reading, cases: Iterable[Case], seed: int
) -> dict[Case, Row]:
    """Results that are known of some cases.

    Parameters
    ----------
    bench : Bench
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
        record = bench.record(point)
        if record is not None:
            reason = f"{record.reason} {record.advice}".strip()
            found[case] = row_of(point.config, point.key, record.status, reason, record.summary, reading.gi)
    return found


def _stability(
    bench: Bench, base: Config, reading: Reading, seed: int, rows: dict[Case, Row]
) -> dict[str, str]:
    """Remarks on the rows of thresholds; stability is lost before folds are seen."""
    order = (EQUAL, SOFT)
    configs = [point_of(base, reading.mechanics, Case(e), seed).config for e in order]
    seen = [visible_bracket(rows, e) for e in order]
    ends = [HIGHEST if bracket is None else min(1.1 * bracket.high, HIGHEST) for bracket in seen]
    try:
        found = stability_thresholds(bench, configs, ends)
    except GyrifyError as failure:
        found = [f"not found ({failure.message})"] * 2
    told = "The smooth slice loses stability (no jitter, no dissipation): growth ratio"
    return {name: f"{told} {value}" for name, value in zip(("P12", "P13"), found, strict=True)}
