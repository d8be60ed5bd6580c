"""The scoreboard: the paper's observations, ours, and whether they agree by the stated rules."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from gyrify.paper.cases import Case
from gyrify.paper.observations import observations
from gyrify.paper.verdict import Rows


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
    def open(self) -> int:
        """Rows that are undecided."""
        return sum(row.passed is None for row in self.rows)

    @property
    def marks(self) -> str:
        """One letter per row: ``+`` passed, ``-`` failed, ``.`` open."""
        return "".join({True: "+", False: "-", None: "."}[row.passed] for row in self.rows)

    def as_dict(self, wall_s: float) -> dict[str, Any]:
        """Fields as in ``gyrify paper --json``."""
        names = ("id", "paper", "ours", "rule", "passed", "note")
        rows = [{name: getattr(row, name) for name in names} for row in self.rows]
        return {
            "reading": self.reading,
            "rows": rows,
            "passed": self.passed,
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
        remark = (remarks or {}).get(observation.id, "")
        note = ". ".join(part for part in (_sentence(verdict.note), remark) if part)
        names = {name: getattr(observation, name) for name in ("id", "statement", "where", "paper", "rule")}
        found.append(
            ScoreRow(ours=verdict.ours, passed=verdict.passed, note=note, missing=verdict.missing, **names)
        )
    return Scoreboard(reading, tuple(found))


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:]
