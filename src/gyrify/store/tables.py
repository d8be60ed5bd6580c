"""The tables of a journal."""

from __future__ import annotations

from typing import Final

INCREMENTS: Final = """
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE increments (
    number INTEGER PRIMARY KEY,
    position INTEGER NOT NULL,
    span INTEGER NOT NULL,
    next_span INTEGER NOT NULL,
    residual REAL NOT NULL,
    newton_iterations INTEGER NOT NULL,
    factorizations INTEGER NOT NULL,
    analyses INTEGER NOT NULL,
    rejected INTEGER NOT NULL,
    wall_s REAL NOT NULL,
    displacement BLOB NOT NULL,
    couplings BLOB NOT NULL,
    digest BLOB NOT NULL
);
"""
STABILITY: Final = """
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
# Journals of earlier versions do not have this table.
CHANGES: Final = """
CREATE TABLE stability_changes (
    number INTEGER PRIMARY KEY,
    growth_time REAL NOT NULL,
    bracket_low REAL NOT NULL,
    bracket_high REAL NOT NULL,
    n_before INTEGER NOT NULL,
    n_after INTEGER NOT NULL,
    kind TEXT NOT NULL,
    mode_number INTEGER NOT NULL,
    wavelength REAL NOT NULL
);
"""

# Made where a run has internal variables: values that a state has besides the displacement.
INTERNAL: Final = """
CREATE TABLE internal (
    number INTEGER NOT NULL,
    name TEXT NOT NULL,
    shape TEXT NOT NULL,
    data BLOB NOT NULL,
    digest BLOB NOT NULL,
    PRIMARY KEY (number, name)
);
"""

TABLES: Final = INCREMENTS + STABILITY + CHANGES
TABLES_OF_ANY_VERSION: Final = (TABLES, INCREMENTS + STABILITY, TABLES + INTERNAL)
