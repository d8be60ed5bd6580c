"""The onset of folding as a row of the journal."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from gyrify.solve.stability import Onset
from gyrify.solve.types import FloatArray

SCHEMA: Final = """
CREATE TABLE stability (number INTEGER PRIMARY KEY, n_negative INTEGER NOT NULL);
CREATE TABLE onset (
    number INTEGER PRIMARY KEY CHECK (number = 0),
    growth_time REAL NOT NULL,
    bracket_low REAL NOT NULL,
    bracket_high REAL NOT NULL,
    eigenvalue REAL NOT NULL,
    mode_number INTEGER NOT NULL,
    wavelength REAL NOT NULL,
    displacement BLOB NOT NULL,
    vector BLOB NOT NULL
);
"""
INSERT: Final = "INSERT OR REPLACE INTO onset VALUES (0, ?, ?, ?, ?, ?, ?, ?, ?)"


def to_row(onset: Onset) -> tuple[Any, ...]:
    """Values to insert."""
    numbers = (onset.growth_time, *onset.bracket, onset.eigenvalue, onset.mode_number, onset.wavelength)
    arrays = (np.ascontiguousarray(a, dtype="<f8").tobytes() for a in (onset.displacement, onset.vector))
    return (*numbers, *arrays)


def from_row(row: tuple[Any, ...]) -> Onset:
    """Onset of a row of the table."""
    _, time, low, high, eigenvalue, mode_number, wavelength, displacement, vector = row
    return Onset(
        time, (low, high), eigenvalue, mode_number, wavelength, _points(displacement), _points(vector)
    )


def _points(blob: bytes) -> FloatArray:
    return np.frombuffer(blob, dtype="<f8").astype(np.float64).reshape(-1, 2)
