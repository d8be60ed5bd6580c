"""A copy in memory of a database that another process keeps to itself.

The copy is of one moment: the log is copied after the database, and fits to it unless the log was begun
anew, with another header, or the database was written to in between. Then both are copied again.
"""

from __future__ import annotations

import os
import shutil
import sqlite3
import tempfile
import time
from pathlib import Path
from typing import Final

_HEADER, _LOG_HEADER = 100, 32
_LOG_VERSION: Final = 2  # in byte 18 of a database that has a write-ahead log
_ATTEMPTS: Final = 40
_PAUSE: Final = 0.05


def must_be_copied(path: Path) -> bool:
    """Whether a database is, or was until its process was killed, kept by one process.

    To open it as usual would be to clear its log away, or to roll its transaction back: where locks do not
    work, under the hands of the process that writes. On an ordinary disk a log always has an index.
    """
    log, index = Path(f"{path}-wal"), Path(f"{path}-shm")
    try:
        header = _read(path, _HEADER)
    except OSError:
        return False
    if len(header) < _HEADER:
        return False
    return not index.exists() and log.exists() if header[18] == _LOG_VERSION else True


def snapshot(path: Path) -> sqlite3.Connection:
    """Copy a database to memory, where it can only be read.

    Raises
    ------
    sqlite3.Error
        If it is damaged, or changes all the time.
    """
    with tempfile.TemporaryDirectory(prefix="gyrify-") as folder:
        copy = Path(folder) / path.name
        try:
            _copy(path, copy)
        except OSError as fault:
            raise sqlite3.OperationalError(f"unable to open database file: {fault.strerror}") from fault
        vfs = "&vfs=unix-none" if os.name == "posix" else ""  # the copy is ours alone: it needs no locks
        source = sqlite3.connect(f"{copy.as_uri()}?mode=rw{vfs}", uri=True, isolation_level=None)
        try:
            source.execute("PRAGMA locking_mode = EXCLUSIVE")
            source.execute("PRAGMA journal_mode = DELETE")
            memory = sqlite3.connect(":memory:", isolation_level=None)
            source.backup(memory)
        finally:
            source.close()
    memory.execute("PRAGMA query_only = ON")
    return memory


def _copy(path: Path, copy: Path) -> None:
    log, rollback = Path(f"{path}-wal"), Path(f"{path}-journal")
    for _ in range(_ATTEMPTS):
        before = _state(path)
        if not _is_full(rollback):  # no transaction is on its way into the database
            shutil.copyfile(path, copy)
            Path(f"{copy}-wal").write_bytes(_read(log))
            if _state(path) == before and not _is_full(rollback):
                return
        time.sleep(_PAUSE)
    if not _is_full(rollback):
        raise sqlite3.OperationalError("database is locked")
    shutil.copyfile(path, copy)  # killed in a transaction, which is rolled back in the copy
    shutil.copyfile(rollback, f"{copy}-journal")


def _state(path: Path) -> tuple[int, int, bytes, bytes]:
    """What differs once the database was written to, or its log was begun anew."""
    found = path.stat()
    return found.st_mtime_ns, found.st_size, _read(path, _HEADER), _read(Path(f"{path}-wal"), _LOG_HEADER)


def _read(path: Path, size: int = -1) -> bytes:
    """First bytes of a file, or all; none where there is no file."""
    try:
        with path.open("rb") as file:
            return file.read(size)
    except FileNotFoundError:
        return b""


def _is_full(path: Path) -> bool:
    return path.exists() and path.stat().st_size > 0
