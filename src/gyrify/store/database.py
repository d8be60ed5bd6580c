"""SQLite as the journal needs it: whole transactions, and faults in plain words."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from gyrify.config.words import shorten
from gyrify.errors import HistoryError

RERUN: Final = "Restore the file from a copy, or run again with --overwrite."


def connect(path: Path, read_only: bool) -> sqlite3.Connection:
    """Open a database; where its folder cannot be written, as an archive that nobody changes."""
    uri, log = path.resolve().as_uri(), Path(f"{path}-wal")
    connection = sqlite3.connect(f"{uri}?mode=rw", uri=True, isolation_level=None)
    try:
        connection.execute("PRAGMA query_only = ON" if read_only else "PRAGMA synchronous = NORMAL")
        connection.execute("SELECT count(*) FROM sqlite_master")
    except sqlite3.OperationalError:
        connection.close()
        if not read_only or (log.exists() and log.stat().st_size > 0):
            raise
        connection = sqlite3.connect(f"{uri}?immutable=1", uri=True, isolation_level=None)
    return connection


@contextmanager
def transaction(connection: sqlite3.Connection) -> Iterator[None]:
    """All or nothing, also where an interrupt or a full disk strikes in the commit itself."""
    try:
        if connection.in_transaction:  # an interrupt fell between the lines below
            connection.execute("ROLLBACK")
        connection.execute("BEGIN IMMEDIATE")
        yield
        connection.execute("COMMIT")
    except BaseException:
        if connection.in_transaction:
            connection.execute("ROLLBACK")
        raise


@contextmanager
def translated(name: str) -> Iterator[None]:
    """Turn database faults into one sentence with advice."""
    try:
        yield
    except (sqlite3.Error, sqlite3.Warning, UnicodeDecodeError) as error:
        text = shorten(" ".join(str(error).split()), 200)
        what = f"The journal {name} could not be used: {text}."
        if "full" in text:
            advice = "Free space on the disk, then continue with `gyrify resume`."
        elif "I/O" in text:
            what = f"The journal {name} could not be written: {text}."
            advice = "Look at the space, quota and health of the disk, then continue with `gyrify resume`."
        elif "readonly" in text or "unable to open" in text:
            advice = "Choose a folder that you may write to."
        elif "locked" in text:
            advice = "Another process is using this run; wait for it, or stop it."
        else:
            what, advice = f"The journal {name} is damaged: {text}.", RERUN
        raise HistoryError(what, advice) from error
