"""Whether a journal is one: its tables are those that a run makes, and its rows hold what they must.

A digest tells of damage by accident. A journal made up on purpose has right digests too, and a database can
hold views that never end, numbers that are text, or arrays of no mesh: these are looked for here.
"""

from __future__ import annotations

import hashlib
import json
import math
import sqlite3
from functools import cache
from typing import Any, Final

import numpy as np

from gyrify.errors import HistoryError
from gyrify.solve.stability import StabilityChange

# Largest value that a database hands out: beyond the displacement of the largest mesh, in bytes.
MAX_VALUE: Final = 512 * 2**20
STATUSES: Final = ("running", "completed", "failed", "stopped", "interrupted")
_WORDS: Final = (
    "status",
    "reason",
    "advice",
    "stable",
    "relaxed",
    "smooth_until",
    "linear_solver",
    "contact_library",
    "config",
    "versions",
    "n_dim",
)
_LONGEST_TEXT: Final = 1_000_000
_ADVICE: Final = "Restore the journal from a copy, or run again with --overwrite."


def confine(connection: sqlite3.Connection) -> None:
    """Have a database of unknown origin run no functions of its own and hand out nothing huge."""
    connection.execute("PRAGMA trusted_schema = OFF")
    connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, MAX_VALUE)


def require_schema(connection: sqlite3.Connection, schemas: tuple[str, ...], name: str) -> None:
    """Refuse a database that has anything but the tables of a journal, of this version or an earlier one.

    Raises
    ------
    HistoryError
        If a table differs, is missing or is one too many, or there are views or triggers.
    """
    found = set(connection.execute("SELECT type, name, sql FROM sqlite_master"))
    if all(found != _tables(schema) for schema in schemas):
        raise HistoryError(f"The journal {name} is damaged: its tables are not those of a run.", _ADVICE)


@cache
def _tables(schema: str) -> frozenset[tuple[str, str, str]]:
    connection = sqlite3.connect(":memory:")
    try:
        connection.executescript(schema)
        return frozenset(connection.execute("SELECT type, name, sql FROM sqlite_master"))
    finally:
        connection.close()


def require_facts(meta: dict[Any, Any], name: str) -> None:
    """Refuse facts that are no text, a status that there is not, and versions that cannot be read.

    Raises
    ------
    HistoryError
        With the fact.
    """
    for key in _WORDS:
        text = meta.get(key, "")
        if not isinstance(text, str) or len(text) > _LONGEST_TEXT:
            raise HistoryError(f"The journal {name} is damaged: its {key} is not text.", _ADVICE)
    if "config" not in meta:
        raise HistoryError(f"The journal {name} is damaged: it has no configuration.", _ADVICE)
    if meta.get("n_dim", "2") not in ("2", "3"):
        raise HistoryError(f"The journal {name} is damaged: it has no dimension.", _ADVICE)
    if meta.get("status", "running") not in STATUSES:
        raise HistoryError(f"The journal {name} is damaged: its status is not known.", _ADVICE)
    try:
        versions = json.loads(meta.get("versions", "{}"))
    except (ValueError, RecursionError):
        versions = None
    if not isinstance(versions, dict) or not all(isinstance(text, str) for text in versions.values()):
        raise HistoryError(f"The journal {name} is damaged: its versions cannot be read.", _ADVICE)


def is_sound(
    whole: tuple[Any, ...],
    numbers: tuple[Any, ...],
    blobs: tuple[bytes, bytes],
    position_before: int,
    n_dim: int,
) -> bool:
    """Whether a row of increments holds what a run could have written after another position.

    Parameters
    ----------
    whole : tuple
        Number, position, span, next span, and what was counted.
    numbers : tuple
        Residual and time.
    blobs : (bytes, bytes)
        Displacement and couplings.
    position_before : int
        Position of the increment before it; -1 for the first.
    n_dim : int
        Dimension of the mesh.
    """
    (_, position, span, next_span, *_), (u, couplings), per_row = whole, blobs, 8 * n_dim
    if not all(type(value) is int and 0 <= value < 2**63 for value in whole):
        return False
    if not all(isinstance(value, float | int) and math.isfinite(value) for value in numbers):
        return False
    if position <= position_before or min(span, next_span) < 1:
        return False
    if len(u) % per_row or not u or len(couplings) % 8:
        return False
    pairs = np.frombuffer(couplings, dtype="<i4")
    return pairs.size == 0 or bool(pairs.min() >= 0 and pairs.max() < len(u) // per_row)


def is_sound_change(change: StabilityChange) -> bool:
    """Whether a change of stability holds numbers, and words that there are."""
    numbers = (change.growth_time, *change.bracket, change.wavelength)
    whole = (change.n_before, change.n_after, change.mode_number)
    return (
        all(isinstance(value, float | int) and math.isfinite(value) for value in numbers)
        and all(type(value) is int and value >= 0 for value in whole)
        and isinstance(change.kind, str)
        and change.kind.isascii()
        and change.kind.isalpha()
        and len(change.kind) <= 20
    )


def is_sound_onset(row: tuple[Any, ...], n_bytes: int, n_dim: int) -> bool:
    """Whether the onset holds numbers, and arrays of a state of ``n_bytes``."""
    per_row = 8 * n_dim
    numbers, whole, (displacement, vector) = (*row[1:5], row[6]), row[5], row[7:9]
    return (
        all(isinstance(value, float | int) for value in numbers)
        and type(whole) is int
        and all(isinstance(blob, bytes) and len(blob) % per_row == 0 for blob in (displacement, vector))
        and len(displacement) == len(vector)
        and n_bytes - per_row <= len(displacement) <= n_bytes
    )


def sealed(meta: dict[str, str]) -> dict[str, str]:
    """Facts with a checksum of the configuration, where it is one of them."""
    if "config" not in meta:
        return meta
    return {**meta, "seal": hashlib.blake2b(meta["config"].encode(), digest_size=16).hexdigest()}


def digest(numbers: tuple[Any, ...], u: bytes, couplings: bytes) -> bytes:
    """Checksum of a row of increments."""
    return hashlib.blake2b(repr(numbers).encode() + u + couplings, digest_size=16).digest()
