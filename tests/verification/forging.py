"""What forgers do to a stored run, and what the recheck says of it."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable
from pathlib import Path

import numpy as np

from gyrify.run.summary import summarise, write_metrics, write_summary
from gyrify.store import History
from gyrify.store.integrity import digest
from gyrify.verify import Verification


def write_outputs(history: History, folder: Path) -> None:
    write_summary(summarise(history), folder / "summary.json")
    write_metrics(history, folder / "metrics.csv")


def failures(verification: Verification) -> set[str]:
    return {check.name for check in verification.checks if not check.passed}


def edit_row(folder: Path, number: int, change: Callable[[bytearray], None], *, fix_digest: bool) -> None:
    """Change a stored displacement; a careful forger mends the checksum of the row too."""
    with sqlite3.connect(folder / "journal.sqlite") as database:
        row = list(database.execute("SELECT * FROM increments WHERE number = ?", (number,)).fetchone())
        blob = bytearray(row[10])
        change(blob)
        checksum = digest(tuple(row[:9]), bytes(blob), row[11]) if fix_digest else row[12]
        database.execute(
            "UPDATE increments SET displacement = ?, digest = ? WHERE number = ?",
            (bytes(blob), checksum, number),
        )
    database.close()


def flip_a_bit(blob: bytearray) -> None:
    blob[len(blob) // 2] ^= 1


def nudge(blob: bytearray) -> None:
    u = np.frombuffer(blob, dtype="<f8").copy()
    u[-1] += 1e-3
    blob[:] = u.tobytes()
