"""Readers of stored runs and studies: databases, tables and arrays, damaged or made up on purpose."""

from __future__ import annotations

import ast
import contextlib
import io
import sqlite3
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from stored import journal_bytes, tiny_config
from target import Target

from gyrify.store import History, Journal
from gyrify.store.integrity import digest, sealed
from gyrify.study import final_state, read_results
from gyrify.study.archive import FinalState, Record, sha256, write_record

KEY = "a1b2c3d4e5f6"


def _journal(folder: Path) -> Callable[[bytes], object]:
    """Bytes of the database: each line changes some, as ``place: bytes``; other input is the file itself."""
    file, whole = folder / "journal.sqlite", journal_bytes()

    def read(data: bytes) -> None:
        for name in ("", "-wal", "-shm"):
            Path(f"{file}{name}").unlink(missing_ok=True)
        file.write_bytes(_patched(whole, data))
        _read_history(folder, deep=False)

    return read


def _patched(whole: bytes, data: bytes) -> bytes:
    found = bytearray(whole)
    for line in data.split(b"\n"):
        place, colon, change = line.partition(b":")
        if not (colon and place.strip().isdigit() and len(place) < 12):
            return data
        at = int(place) % len(found)
        found[at : at + len(change)] = change
    return bytes(found)


def _history(folder: Path) -> Callable[[bytes], object]:
    """A made-up database with right digests: each line is a statement of SQL, then rows are sealed anew."""
    file, whole = folder / "journal.sqlite", journal_bytes()

    def read(data: bytes) -> None:
        for name in ("", "-wal", "-shm"):
            Path(f"{file}{name}").unlink(missing_ok=True)
        file.write_bytes(whole)
        _forge(file, data.decode("utf-8", "replace"))
        _read_history(folder, deep=True)

    return read


def _forge(file: Path, script: str) -> None:
    """What somebody may do who wants to deceive; statements that fail are left out, loops are cut short."""
    steps = 0

    def stop() -> bool:
        nonlocal steps
        steps += 1
        return steps > 50

    with contextlib.closing(sqlite3.connect(file, isolation_level=None)) as connection:
        connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, 4_000_000)
        connection.setlimit(sqlite3.SQLITE_LIMIT_ATTACHED, 0)
        connection.set_progress_handler(stop, 10_000)
        for statement in script.split("\n"):
            with contextlib.suppress(sqlite3.Error, sqlite3.Warning, ValueError):
                connection.execute(statement.replace("\0", "")).fetchone()
        with contextlib.suppress(sqlite3.Error, TypeError, AttributeError, IndexError, UnicodeError):
            _seal(connection)


def _seal(connection: sqlite3.Connection) -> None:
    for row in connection.execute("SELECT * FROM increments").fetchmany(20):
        mended = digest(row[:9], row[10], row[11])
        connection.execute("UPDATE increments SET digest = ? WHERE number = ?", (mended, row[0]))
    (config,) = connection.execute("SELECT value FROM meta WHERE key = 'config'").fetchone()
    connection.executemany("INSERT OR REPLACE INTO meta VALUES (?, ?)", sealed({"config": config}).items())


def _read_history(folder: Path, *, deep: bool) -> None:
    with contextlib.closing(Journal.open(folder / "journal.sqlite")):
        pass
    history = History.load(folder)
    with contextlib.closing(history.journal):
        told = (history.status, history.reason, history.advice, history.linear_solver, history.stable)
        assert all(isinstance(text, str) for text in told[:4])
        assert len(history.growth_times) == len(history) == len(history.residuals)
        assert history.wall_s >= 0.0 or history.wall_s < 0.0
        _ = (history.versions, history.stats, history.onset, history.negative_pivots, history.result_hash)
        cells = history.config.mesh.n_around * history.config.mesh.n_layers * 4**history.config.mesh.refine
        if deep and cells < 400:  # a mesh of the largest size allowed takes minutes
            for number in range(min(len(history), 5)):
                assert history.points(number).shape == history.mesh.points.shape


def _results(folder: Path) -> Callable[[bytes], object]:
    """``results.parquet`` of a table described as a Python dict, or the bytes of a file changed."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    from gyrify.study.query import query_results

    sink = io.BytesIO()
    pq.write_table(pa.table({name: [KEY] for name in ("key", "status", "reason", "advice")}), sink)

    def read(data: bytes) -> None:
        file = folder / "results.parquet"
        try:
            described = ast.literal_eval(data.decode("utf-8"))
            pq.write_table(pa.table(described), file)
        except Exception:  # no table: bytes
            file.write_bytes(_patched(sink.getvalue(), data))
        table = read_results(folder)
        rows = table.to_pylist()
        assert all(len(row["key"]) == 12 for row in rows)
        assert query_results(folder, sort="key", limit=2).num_rows <= 2

    return read


def _final(folder: Path) -> Callable[[bytes], object]:
    """``final.npz`` with a right checksum: lines ``name|header|number of bytes``, or bytes as they are."""
    summary: dict[str, Any] = {"n_gyri": 3, "onset": None}
    target = folder / "runs" / KEY

    def read(data: bytes) -> None:
        final = _archive(data)
        config = tiny_config().to_dict()
        record = Record("00", "11", "completed", "", "", config, summary, sha256(final), 1.0)
        write_record(target, record, final)
        point = final_state(folder, KEY)
        assert isinstance(point.final, FinalState)
        assert point.points.shape == point.mesh.points.shape

    return read


def _archive(data: bytes) -> bytes:
    lines = [line.split(b"|") for line in data.split(b"\n") if line.count(b"|") == 2]
    if not lines:
        return data
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, header, n_bytes in lines:
            size = int(n_bytes) % 100_000 if n_bytes.strip().isdigit() and len(n_bytes) < 12 else 0
            head = header[:5000] + b"\n"
            start = b"\x93NUMPY\x01\x00" + len(head).to_bytes(2, "little")
            entry = name.decode("utf-8", "replace")[:200].replace("\0", "") or "x"
            with contextlib.suppress(UserWarning):
                archive.writestr(entry, start + head + bytes(size))
    return buffer.getvalue()


TARGETS = (
    Target("journal", "`journal.sqlite`, damaged", _journal),
    Target("history", "`journal.sqlite`, forged with right digests", _history),
    Target("results", "`results.parquet`", _results),
    Target("final", "`final.npz`, forged with a right checksum", _final),
)
