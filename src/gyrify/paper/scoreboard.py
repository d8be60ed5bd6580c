"""The scoreboard: the paper's observations, ours, and whether they agree by the stated rules."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from gyrify.paper.cases import Case
from gyrify.paper.checks import Rows, Verdict
from gyrify.paper.observations import observations


@dataclass(frozen=True)
class ScoreRow:
    """One observation, compared.

    Attributes
    ----------
    id, statement, where : str
        Which one, what the paper says, and where.
    paper, ours : str
        The paper's value and ours.
    rule : str
        How they are compared.
    passed : bool or None
        None where runs are missing.
    first_passed : bool or None
        The same by the rule that was frozen first.
    share : float
        Part of the rule's checks that pass; half counts for one that is open [-].
    note : str
        Why it fails, or what else is to be known.
    missing : tuple of Case
        Runs that would tell more, where it is open.
    """

    id: str
    statement: str
    where: str
    paper: str
    ours: str
    rule: str
    passed: bool | None
    first_passed: bool | None
    share: float
    note: str
    missing: tuple[Case, ...] = ()


@dataclass(frozen=True)
class Scoreboard:
    """All observations, compared.

    Attributes
    ----------
    reading : str
        The reading in words.
    rows : tuple of ScoreRow
        In the order of the paper.
    """

    reading: str
    rows: tuple[ScoreRow, ...]

    @property
    def passed(self) -> int:
        """Rows that pass."""
        return sum(row.passed is True for row in self.rows)

    @property
    def first_passed(self) -> int:
        """Rows that pass by the rules that were frozen first."""
        return sum(row.first_passed is True for row in self.rows)

    @property
    def open(self) -> int:
        """Rows that are undecided."""
        return sum(row.passed is None for row in self.rows)

    @property
    def marks(self) -> str:
        """One letter per row: ``+`` passed, ``-`` failed, ``.`` open."""
        return "".join({True: "+", False: "-", None: "."}[row.passed] for row in self.rows)

    def as_dict(self, wall_s: float) -> dict[str, Any]:
        """Fields as in ``gyrify paper --json``."""
        names = ("id", "paper", "ours", "rule", "passed", "first_passed", "note")
        rows = [{name: getattr(row, name) for name in names} for row in self.rows]
        return {
            "reading": self.reading,
            "rows": rows,
            "passed": self.passed,
            "first_passed": self.first_passed,
            "total": len(self.rows),
            "wall_s": wall_s,
        }


def score(rows: Rows, reading: str, remarks: dict[str, str] | None = None) -> Scoreboard:
    """Judge every observation.

    Parameters
    ----------
    rows : mapping
        Results by case.
    reading : str
        The reading in words.
    remarks : dict, optional
        What else is to be said, by the id of an observation.

    Returns
    -------
    Scoreboard
    """
    found = []
    for observation in observations():
        verdict = observation.judge(rows)
        first = verdict if not observation.reason else observation.first_judge(rows)
        remark = (remarks or {}).get(observation.id, "")
        names = {name: getattr(observation, name) for name in ("id", "statement", "where", "paper", "rule")}
        found.append(
            ScoreRow(
                ours=verdict.ours,
                passed=verdict.passed,
                first_passed=first.passed,
                share=_share(verdict),
                note=". ".join(part for part in (_sentence(verdict.note), remark) if part),
                missing=verdict.missing,
                **names,
            )
        )
    return Scoreboard(reading, tuple(found))


def _share(verdict: Verdict) -> float:
    worth = {True: 1.0, None: 0.5, False: 0.0}
    return sum(worth[check.passed] for check in verdict.checks) / len(verdict.checks)


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:]
