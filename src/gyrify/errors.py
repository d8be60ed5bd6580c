"""Every error gyrify raises on purpose; each message says what happened and what to try."""

from __future__ import annotations


class GyrifyError(Exception):
    """Base of all gyrify errors.

    Parameters
    ----------
    message : str
        What happened, in one sentence.
    advice : str, optional
        What to try, in one sentence.
    """

    def __init__(self, message: str, advice: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.advice = advice

    def __str__(self) -> str:
        return f"{self.message} {self.advice}".strip()


class ConfigError(GyrifyError):
    """A configuration that is malformed or out of bounds."""


class MeshError(GyrifyError):
    """A geometry that cannot be meshed well."""


class SolveError(GyrifyError):
    """A run that could not be brought to its final growth time."""


class InvertedCellError(SolveError):
    """A run that cannot go on because somewhere in a cell the volume would not stay positive."""


class LimitReachedError(GyrifyError):
    """A limit on wall time or memory that the user has set."""


class HistoryError(GyrifyError):
    """A stored run that cannot be read, resumed or overwritten."""
