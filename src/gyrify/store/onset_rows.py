"""What a run knows of stability, as rows of the journal."""

from __future__ import annotations

import sqlite3
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np

from gyrify.solve.stability import Onset, StabilityChange
from gyrify.store.tables import CHANGES

INSERT_CHANGE: Final = "INSERT INTO stability_changes VALUES (NULL, ?, ?, ?, ?, ?, ?, ?, ?)"
INSERT: Final = "INSERT OR REPLACE INTO onset VALUES (0, ?, ?, ?, ?, ?, ?, ?, ?)"


def to_row(onset: Onset) -> tuple[Any, ...]:
    """Values to insert."""
    numbers = (onset.growth_time, *onset.bracket, onset.eigenvalue, onset.mode_number, onset.wavelength)
    arrays = (np.ascontiguousarray(a, dtype="<f8").tobytes() for a in (onset.displacement, onset.vector))
    return (*numbers, *arrays)


def from_row(row: tuple[Any, ...], n_dim: int) -> Onset:
    """Onset of a row of the table, of a body in the plane (2) or in space (3)."""
    _, time, low, high, eigenvalue, mode_number, wavelength, displacement, vector = row
    state, mode = (
        np.frombuffer(blob, dtype="<f8").astype(np.float64).reshape(-1, n_dim)
        for blob in (displacement, vector)
    )
    return Onset(time, (low, high), eigenvalue, mode_number, wavelength, state, mode)


def add_changes(connection: sqlite3.Connection, changes: Sequence[StabilityChange]) -> None:
    """Insert changes of stability; call it inside a transaction."""
    if not changes:
        return
    if not has_changes(connection):
        connection.execute(CHANGES.strip().rstrip(";"))
    for change in changes:
        row = (
            change.growth_time,
            *change.bracket,
            change.n_before,
            change.n_after,
            change.kind,
            change.mode_number,
            change.wavelength,
        )
        connection.execute(INSERT_CHANGE, row)


def has_changes(connection: sqlite3.Connection) -> bool:
    """Whether the journal has the table of changes."""
    query = "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = 'stability_changes'"
    return bool(connection.execute(query).fetchone()[0])


def read_changes(connection: sqlite3.Connection) -> tuple[StabilityChange, ...]:
    """Every change of stability on record, in order."""
    if not has_changes(connection):
        return ()
    rows = connection.execute("SELECT * FROM stability_changes ORDER BY number").fetchall()
    return tuple(StabilityChange(time, (low, high), *rest) for _, time, low, high, *rest in rows)


def read_onset(connection: sqlite3.Connection, n_dim: int) -> Onset | None:
    """The onset on record; what its mode moves stands with the change of stability that it is."""
    row = connection.execute("SELECT * FROM onset").fetchone()
    if row is None:
        return None
    onset = from_row(row, n_dim)
    kinds = (change.kind for change in read_changes(connection) if change.growth_time == onset.growth_time)
    return replace(onset, kind=next(kinds, onset.kind))
