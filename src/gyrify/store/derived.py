"""Reads the derived files of a run folder, which anybody may have written."""

from __future__ import annotations

import csv
import hashlib
from itertools import islice
from pathlib import Path
from typing import Any, Final

from gyrify.config.words import shorten
from gyrify.errors import HistoryError
from gyrify.store.files import read_facts

# A run has at most 100 000 planned increments; halved ones come on top.
_MOST_ROWS: Final = 2_000_000
_REBUILD: Final = "Delete it; it can be rebuilt."


def read_summary(folder: Path) -> dict[str, Any] | None:
    """What ``summary.json`` says; None where there is none.

    Raises
    ------
    HistoryError
        If it cannot be read.
    """
    path = folder / "summary.json"
    if not path.is_file():
        return None
    try:
        return read_facts(path)
    except (OSError, ValueError) as fault:
        raise HistoryError(f"{path} is damaged: {_short(fault)}.", _REBUILD) from fault


def read_metrics(path: Path) -> dict[str, dict[str, str]]:
    """Rows of ``metrics.csv`` by their number, each by its columns.

    Raises
    ------
    HistoryError
        If it cannot be read.
    """
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = enumerate(islice(csv.DictReader(file), _MOST_ROWS))
            return {str(n): {str(k): str(v) for k, v in row.items()} for n, row in rows}
    except (OSError, ValueError, csv.Error) as fault:
        raise HistoryError(f"{path} is damaged: {_short(fault)}.", _REBUILD) from fault


def _short(fault: Exception) -> str:
    return shorten(" ".join(str(fault).split()), 120)


def sha256_of(path: Path) -> str:
    """SHA-256 (hexadecimal) of a file."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def require_digest(path: Path, sha256: str) -> None:
    """Refuse a file that is not, byte for byte, the one that was written.

    To be called before a library opens a file of a folder from elsewhere: HDF5 is not made for hostile files.

    Raises
    ------
    HistoryError
        If the file cannot be read, or its SHA-256 (hexadecimal) differs.
    """
    try:
        found = sha256_of(path)
    except OSError as fault:
        raise HistoryError(f"{path} cannot be read: {fault.strerror}.", _REBUILD) from fault
    if found != sha256:
        raise HistoryError(f"{path} is not the file that was written: its checksum differs.", _REBUILD)
