"""Verdicts of rules, true, false or still open, put together from checks of few runs each."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from gyrify.paper.cases import Case
from gyrify.paper.row import Row

Rows = Mapping[Case, Row]


@dataclass(frozen=True)
class Check:
    """One thing that must hold.

    Attributes
    ----------
    passed : bool or None
        None where runs are missing that would decide it.
    sentence : str
        What was found.
    missing : tuple of Case
        Runs that would decide it, where it is open.
    """

    passed: bool | None
    sentence: str
    missing: tuple[Case, ...] = ()


@dataclass(frozen=True)
class Verdict:
    """How an observation of the paper compares.

    Attributes
    ----------
    ours : str
        Our value, in words where it is none.
    checks : tuple of Check
        All must pass.
    """

    ours: str
    checks: tuple[Check, ...]

    @property
    def passed(self) -> bool | None:
        """False where one check fails, None where one is open, else True."""
        found = [check.passed for check in self.checks]
        return False if False in found else None if None in found else True

    @property
    def missing(self) -> tuple[Case, ...]:
        """Runs that would tell more; none once it is decided."""
        if self.passed is not None:
            return ()
        return tuple(dict.fromkeys(case for check in self.checks for case in check.missing))

    @property
    def note(self) -> str:
        """What failed, or is open; empty where all passes."""
        wrong = [check.sentence for check in self.checks if check.passed is False]
        return "; ".join(wrong or [check.sentence for check in self.checks if check.passed is None])


def check(
    rows: Rows, cases: Sequence[Case], test: Callable[..., bool], sentence: Callable[..., str]
) -> Check:
    """Check the rows of some cases.

    Parameters
    ----------
    rows : mapping
        What is known.
    cases : sequence of Case
        What the check needs.
    test, sentence : callable
        Called with the rows of the cases, in order.

    Returns
    -------
    Check
        Open while a row is missing; false where a run did not come to its end.
    """
    found = [(case, rows[case]) for case in cases if case in rows]
    for case, row in found:
        if not row.is_complete:
            return Check(False, f"the run at {case} {row.status}: {row.reason}")
    missing = tuple(case for case in cases if case not in rows)
    if missing:
        return Check(None, f"not run: {missing[0]}", missing)
    values = [row for _, row in found]
    return Check(test(*values), sentence(*values))


def shown(rows: Rows, cases: Sequence[Case], text: Callable[[Row], str]) -> str:
    """Values of some cases, for people."""
    return ", ".join(
        (text(rows[case]) if rows[case].is_complete else "failed") if case in rows else "–" for case in cases
    )
