"""SQLite as the journal needs it: whole transactions, on whatever disk, and faults in plain words.

On an ordinary disk the journal has a write-ahead log, so that others read while a run writes. That takes
locks and memory that processes share, which network disks lack or get wrong. There the one process that
writes, which the lock of the folder makes sure of, keeps the file to itself: SQLite then needs no shared
memory, and where there are no locks at all, none of them either. Others read a copy: `gyrify.store.snapshot`.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from gyrify.config.words import shorten
from gyrify.errors import HistoryError
from gyrify.store import disks
from gyrify.store.snapshot import must_be_copied, snapshot

RERUN: Final = "Restore the file from a copy, or run again with --overwrite."
APPLICATION_ID: Final = 0x67797269  # "gyri"
# What a disk without shared memory or with poor locks makes SQLite say.
_OF_THE_DISK: Final = {
    sqlite3.SQLITE_BUSY,
    sqlite3.SQLITE_IOERR,
    sqlite3.SQLITE_CANTOPEN,
    sqlite3.SQLITE_PROTOCOL,
    sqlite3.SQLITE_NOLFS,
}


@dataclass(frozen=True)
class _Way:
    """How a database is written.

    Attributes
    ----------
    vfs : str
        Layer of SQLite that knows the system; by default the usual one, which locks.
    is_exclusive : bool
        Whether the file is kept from others for as long as it is open.
    journal : str
        ``WAL``, or ``TRUNCATE`` for a rollback journal.
    """

    vfs: str
    is_exclusive: bool
    journal: str


_ORDINARY: Final = _Way("", False, "WAL")
_ALONE: Final = (_Way("", True, "WAL"), _Way("", True, "TRUNCATE"))
_UNLOCKED: Final = (_Way("unix-none", True, "WAL"), _Way("unix-none", True, "TRUNCATE"))


def open_for_writing(path: Path | None, *, is_new: bool = False) -> sqlite3.Connection:
    """Open a database that no other process writes, in the best way that its disk allows.

    Parameters
    ----------
    path : Path or None
        The file, in a folder that this process holds; None for one in memory.
    is_new : bool
        Whether to make it. A file that is there already is left as it is unless a run has written it.

    Raises
    ------
    sqlite3.Error
        If none works: what SQLite says of the best one.
    """
    if path is None:
        return sqlite3.connect(":memory:", isolation_level=None)
    ways = _ways(path.parent)
    first: sqlite3.Error | None = None
    for way in ways:
        try:
            return _opened(path, way, is_new)
        except sqlite3.OperationalError as fault:
            code = fault.sqlite_errorcode & 0xFF
            first = first or fault
            is_held = code == sqlite3.SQLITE_BUSY and not way.vfs  # locks work, and somebody has one
            if is_held or code not in _OF_THE_DISK:
                raise first from None
            Path(f"{path}-shm").unlink(missing_ok=True)  # of memory that could not be shared
    assert first is not None
    raise first


def _ways(folder: Path) -> tuple[_Way, ...]:
    """Ways to write in a folder, the best one first."""
    try:
        if not disks.has_record_locks(folder):
            return _UNLOCKED
    except OSError:  # the folder cannot be written: SQLite says so
        return (_ORDINARY,)
    return _ALONE if disks.is_shared(folder) else (_ORDINARY, *_ALONE)


def _opened(path: Path, way: _Way, is_new: bool) -> sqlite3.Connection:
    options = [f"mode={'rwc' if is_new else 'rw'}", *([f"vfs={way.vfs}"] if way.vfs else [])]
    connection = sqlite3.connect(
        f"{path.resolve().as_uri()}?{'&'.join(options)}", uri=True, isolation_level=None
    )
    try:
        if way.is_exclusive:  # before the first look at the file, or shared memory is asked for
            connection.execute("PRAGMA locking_mode = EXCLUSIVE")
        (application,) = connection.execute("PRAGMA application_id").fetchone()
        if is_new or application == APPLICATION_ID:
            connection.execute(f"PRAGMA journal_mode = {way.journal}")
            connection.execute(f"PRAGMA synchronous = {'NORMAL' if way.journal == 'WAL' else 'FULL'}")
            connection.execute("BEGIN IMMEDIATE")  # whether it works is seen here at the latest
            connection.execute("ROLLBACK")
    except BaseException:
        connection.close()
        raise
    return connection


def open_for_reading(path: Path) -> sqlite3.Connection:
    """Open a database that a run may be writing; where it cannot be shared, a copy of it as it is now.

    Raises
    ------
    sqlite3.Error
        If neither can be read.
    """
    if must_be_copied(path):
        return snapshot(path)
    uri, log = path.resolve().as_uri(), Path(f"{path}-wal")
    connection = sqlite3.connect(f"{uri}?mode=rw", uri=True, isolation_level=None)
    try:
        connection.execute("PRAGMA query_only = ON")
        connection.execute("SELECT count(*) FROM sqlite_master")
    except sqlite3.OperationalError:
        connection.close()
        if log.exists() and log.stat().st_size > 0:
            return snapshot(path)
        # An archive that nobody changes, in a folder that cannot be written, perhaps.
        connection = sqlite3.connect(f"{uri}?immutable=1", uri=True, isolation_level=None)
    return connection


def settle(connection: sqlite3.Connection) -> None:
    """Fold the log into the one file, and let others have it.

    Raises
    ------
    sqlite3.Error
        If somebody is reading, or the disk is full.
    """
    (locking,) = connection.execute("PRAGMA locking_mode").fetchone()
    if locking == "exclusive":
        connection.execute("PRAGMA journal_mode = DELETE")  # with a log it could not be let go
        connection.execute("PRAGMA locking_mode = NORMAL")
        connection.execute("SELECT count(*) FROM sqlite_master")
    else:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")


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
        elif "I/O" in text or "locking protocol" in text:
            what = f"The journal {name} could not be written: {text}.{disks.described(Path(name))}"
            advice = (
                "Look at the space, quota and health of the disk, then continue with `gyrify resume`; "
                "or choose a folder on another disk with --out."
            )
        elif "readonly" in text or "unable to open" in text:
            advice = "Choose a folder that you may write to."
        elif "locked" in text:
            what += disks.described(Path(name))
            advice = "Another process has locked this file; wait for it, or stop it."
        else:
            what, advice = f"The journal {name} is damaged: {text}.", RERUN
        raise HistoryError(what, advice) from error
