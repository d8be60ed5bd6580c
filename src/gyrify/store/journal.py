"""The journal of a run: an SQLite database with one committed transaction per accepted increment.

It holds the full float64 state and all that the next increment depends on, so that a run killed at any
moment continues from its last accepted increment to the same bytes. Write-ahead logging with
``synchronous = NORMAL`` survives the death of the process at any instruction; after a loss of power the
last increments may be gone, never damaged. See `gyrify.store.database` for disks that cannot do that.
"""

from __future__ import annotations

import hashlib
import sqlite3
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from gyrify.errors import HistoryError
from gyrify.solve.problem import State
from gyrify.solve.stability import Onset, StabilityChange
from gyrify.solve.types import FloatArray
from gyrify.store import onset_rows
from gyrify.store.database import (
    APPLICATION_ID,
    RERUN,
    open_for_reading,
    open_for_writing,
    settle,
    transaction,
    translated,
)
from gyrify.store.increment_rows import QUERY, IncrementRow, add_internal, internal_bytes, read_internal
from gyrify.store.integrity import (
    confine,
    is_sound_change,
    is_sound_onset,
    require_facts,
    require_schema,
    sealed,
)
from gyrify.store.tables import TABLES, TABLES_OF_ANY_VERSION

FORMAT: Final = 1
_IMPOSSIBLE: Final = "it holds values that no run can have"


class Journal:
    """Accepted increments of one run.

    Parameters
    ----------
    connection : sqlite3.Connection
        Open database of the right format; use `create` or `open`.
    path : Path or None
        Its file; None where it is in memory.
    """

    def __init__(self, connection: sqlite3.Connection, path: Path | None) -> None:
        self._connection = connection
        self.path = path
        self.name = "in memory" if path is None else str(path)

    @staticmethod
    def create(path: Path | None, meta: dict[str, str]) -> Journal:
        """New journal in a file that does not exist yet, or in memory.

        Raises
        ------
        HistoryError
            If the file cannot be written.
        """
        try:
            with translated("in memory" if path is None else str(path)):
                connection = open_for_writing(path, is_new=True)
                with transaction(connection):
                    for statement in filter(str.strip, TABLES.split(";")):
                        connection.execute(statement)
                    connection.executemany("INSERT INTO meta VALUES (?, ?)", sealed(meta).items())
                    connection.execute(f"PRAGMA application_id = {APPLICATION_ID}")
                    connection.execute(f"PRAGMA user_version = {FORMAT}")
        except HistoryError as fault:
            if path is not None:  # half a journal is no run: nothing was accepted yet
                for suffix in ("", "-wal", "-shm", "-journal"):
                    Path(f"{path}{suffix}").unlink(missing_ok=True)
            advice = fault.advice.replace("continue with `gyrify resume`", "run again")
            raise HistoryError(fault.message, advice) from fault
        return Journal(connection, path)

    @staticmethod
    def open(path: Path, *, read_only: bool = False) -> Journal:
        """Existing journal.

        Raises
        ------
        HistoryError
            If there is none, it is damaged, or of another format.
        """
        if not path.is_file():
            raise HistoryError(
                f"There is no journal at {path}.", "Name a folder that `gyrify run` has written."
            )
        if path.stat().st_size == 0:
            raise _nothing_stored(path)
        with translated(str(path)):
            connection = open_for_reading(path) if read_only else open_for_writing(path)
            confine(connection)
            (application,) = connection.execute("PRAGMA application_id").fetchone()
            (version,) = connection.execute("PRAGMA user_version").fetchone()
            (n_tables,) = connection.execute("SELECT count(*) FROM sqlite_master").fetchone()
        if not (application or n_tables):  # killed between the making of the file and of its tables
            raise _nothing_stored(path)
        if application != APPLICATION_ID:
            raise HistoryError(
                f"{path} is not a gyrify journal.", "Name a folder that `gyrify run` has written."
            )
        if version != FORMAT:
            raise HistoryError(
                f"{path} has journal format {version}; this version of gyrify reads format {FORMAT}.",
                "Use the version of gyrify that wrote it (see `versions` in summary.json), or run again.",
            )
        with translated(str(path)):
            require_schema(connection, TABLES_OF_ANY_VERSION, str(path))
        journal = Journal(connection, path)
        journal.check()
        return journal

    def close(self) -> None:
        """Close the database; its write-ahead log is folded in."""
        self._connection.close()

    def settle(self) -> None:
        """Fold the write-ahead log into the one file, where nobody else is reading and the disk has room."""
        with suppress(sqlite3.Error):
            settle(self._connection)

    def check(self) -> None:
        """Recompute every checksum.

        Raises
        ------
        HistoryError
            If anything that a run wrote is not what it wrote, or an increment is missing.
        """
        with translated(self.name):
            meta = dict(self._connection.execute("SELECT key, value FROM meta"))
            onset = self._connection.execute("SELECT * FROM onset").fetchone()
            pivots = self._connection.execute("SELECT number, n_negative FROM stability").fetchall()
            changes = onset_rows.read_changes(self._connection)
        require_facts(meta, self.name)
        if "seal" in meta and sealed({"config": str(meta.get("config"))})["seal"] != meta["seal"]:
            raise HistoryError(f"The configuration in {self.name} is damaged: its checksum differs.", RERUN)
        position, n_bytes, n_dim = -1, 0, self.n_dim
        variables = self._internal(0).keys()
        for number in range(len(self)):
            row = self._row(number)
            is_complete = self._internal(number).keys() == variables
            is_as_long = number == 0 or len(row.displacement) == n_bytes
            if not (row.is_possible(position, n_dim) and is_complete and is_as_long):
                raise HistoryError(
                    f"Increment {number} in {self.name} is damaged: {_IMPOSSIBLE}.",
                    RERUN,
                )
            position, n_bytes = row.position, len(row.displacement)
        if not (
            all(type(value) is int for pair in pivots for value in pair)
            and (onset is None or is_sound_onset(onset, n_bytes, n_dim))
            and all(map(is_sound_change, changes))
        ):
            raise HistoryError(f"The record of stability in {self.name} is damaged: {_IMPOSSIBLE}.", RERUN)

    def meta(self, key: str, default: str = "") -> str:
        """A recorded fact, such as the configuration or the status."""
        with translated(self.name):
            row = self._connection.execute("SELECT value FROM meta WHERE key = ?", (key,)).fetchone()
        return default if row is None else str(row[0])

    def set_meta(self, **values: str) -> None:
        """Record facts in one transaction."""
        with translated(self.name), transaction(self._connection):
            self._connection.executemany("INSERT OR REPLACE INTO meta VALUES (?, ?)", sealed(values).items())

    def append(
        self,
        state: State,
        wall_s: float,
        n_negative: int | None = None,
        onset: Onset | None = None,
        changes: Sequence[StabilityChange] = (),
    ) -> None:
        """Record an accepted increment, and what was found of its stability, in one transaction."""
        row = IncrementRow.of(state, wall_s)
        with translated(self.name), transaction(self._connection):
            self._connection.execute(f"INSERT INTO increments VALUES ({','.join('?' * len(row))})", row)
            add_internal(self._connection, state.index, state.internal)
            if n_negative is not None:
                self._connection.execute("INSERT INTO stability VALUES (?, ?)", (state.index, n_negative))
            if onset is not None:
                self._connection.execute(onset_rows.INSERT, onset_rows.to_row(onset))
            onset_rows.add_changes(self._connection, changes)

    def set_onset(self, onset: Onset, changes: Sequence[StabilityChange]) -> None:
        """Record the onset in a transaction of its own, where its increment is not accepted."""
        with translated(self.name), transaction(self._connection):
            self._connection.execute(onset_rows.INSERT, onset_rows.to_row(onset))
            onset_rows.add_changes(self._connection, changes)

    @property
    def onset(self) -> Onset | None:
        """Where the path first lost stability, if it is known to have."""
        with translated(self.name):
            return onset_rows.read_onset(self._connection, self.n_dim)

    @property
    def stability_changes(self) -> tuple[StabilityChange, ...]:
        """Every change of stability of the smooth equilibrium that growth has passed, in order."""
        with translated(self.name):
            return onset_rows.read_changes(self._connection)

    @property
    def negative_pivots(self) -> dict[int, int]:
        """Number of negative pivots of the tissue's stiffness, by the increments that were looked at."""
        with translated(self.name):
            return dict(self._connection.execute("SELECT number, n_negative FROM stability ORDER BY number"))

    def __len__(self) -> int:
        with translated(self.name):
            return int(self._connection.execute("SELECT count(*) FROM increments").fetchone()[0])

    def column(self, name: str) -> list[Any]:
        """One number of every increment, in order."""
        with translated(self.name):
            return [
                row[0] for row in self._connection.execute(f"SELECT {name} FROM increments ORDER BY number")
            ]

    @property
    def n_dim(self) -> int:
        """Dimension of the mesh; 2 where it is not on record."""
        return int(self.meta("n_dim", "2"))

    def displacement(self, number: int) -> FloatArray:
        """(n_rows, n_dim) displacement of an increment [mm]."""
        return self._row(number).u(self.n_dim)

    def state(self, number: int) -> State:
        """Everything that the increment after ``number`` depends on."""
        before = self.displacement(number - 1) if number > 0 else None
        return self._row(number).state(self.n_dim, before, self._internal(number))

    @property
    def result_hash(self) -> str:
        """SHA-256 (hexadecimal) of growth times and states of all increments, in order."""
        digest = hashlib.sha256()
        query = "SELECT position, displacement FROM increments ORDER BY number"
        with translated(self.name):
            for position, displacement in self._connection.execute(query):
                digest.update(int(position).to_bytes(8, "little"))
                digest.update(displacement)
            for part in internal_bytes(self._connection):
                digest.update(part)
        return digest.hexdigest()

    def _row(self, number: int) -> IncrementRow:
        with translated(self.name):
            found = self._connection.execute(QUERY, (int(number),)).fetchone()
        if found is None:
            raise HistoryError(
                f"The journal {self.name} has no increment {number}.", f"It holds {len(self)}."
            )
        row = IncrementRow(*found)
        if not row.is_undamaged:
            raise HistoryError(f"Increment {number} in {self.name} is damaged: its checksum differs.", RERUN)
        return row

    def _internal(self, number: int) -> dict[str, FloatArray]:
        with translated(self.name):
            try:
                return read_internal(self._connection, number)
            except ValueError as fault:
                raise HistoryError(
                    f"Increment {number} in {self.name} is damaged: {fault}.", RERUN
                ) from fault


def _nothing_stored(path: Path) -> HistoryError:
    return HistoryError(
        f"The journal {path} is empty: the run ended before its first state was stored.", RERUN
    )
