"""What a verification says."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Check:
    """One thing that was checked.

    Attributes
    ----------
    name : str
        What was checked.
    passed : bool
        Whether it holds.
    sentence : str
        What was found.
    worst, bound : float or None
        The number closest to failing and where it would fail, if there is one.
    """

    name: str
    passed: bool
    sentence: str
    worst: float | None = None
    bound: float | None = None


@dataclass(frozen=True)
class Verification:
    """All checks of one run."""

    checks: tuple[Check, ...]

    @property
    def passed(self) -> bool:
        """Whether every check holds."""
        return all(check.passed for check in self.checks)

    def as_dict(self) -> dict[str, Any]:
        """Plain values, fit for JSON."""
        return {"passed": self.passed, "checks": [dict(vars(check)) for check in self.checks]}

    def __str__(self) -> str:
        lines = [
            f"{'ok    ' if check.passed else 'FAILED'} {check.name}: {check.sentence}"
            for check in self.checks
        ]
        return "\n".join(lines)
