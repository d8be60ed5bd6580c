"""One process at a time on a run folder."""

from __future__ import annotations

import json
import os
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from filelock import FileLock, Timeout

from gyrify.config.words import shorten
from gyrify.errors import HistoryError
from gyrify.store import disks
from gyrify.store.disk_faults import storage_faults
from gyrify.store.files import read_facts, refuse_link
from gyrify.store.soft_lock import SoftLock, is_stale

OWNER: Final = "run.owner.json"
LOCK: Final = "run.lock"
# Where the system's locks do not work.
SOFT_LOCK: Final = "run.lock.json"


@contextmanager
def run_lock(folder: Path, what: str = "run") -> Iterator[str]:
    """Hold the folder for this process; the operating system lets go when the process dies.

    On a disk without locks, a file stands for it, and the next process takes it over once this one has died.

    Parameters
    ----------
    folder : Path
        Folder of a run or of a study.
    what : str
        Which of them, for messages.

    Yields
    ------
    str
        A sentence about a previous owner that ended without letting go, or nothing.

    Raises
    ------
    HistoryError
        If another process holds the folder, or the folder cannot be written.
    """
    owner = folder / OWNER
    for path in (owner, folder / LOCK, folder / SOFT_LOCK):
        refuse_link(path)
    with storage_faults(folder):
        lock = _acquired(folder)
    if lock is None:
        raise HistoryError(
            f"The {what} folder {folder} is in use by {_describe(owner)}.", _advice(folder / SOFT_LOCK)
        )
    try:
        stale = (
            f"{_describe(owner)} ended without closing this {what}; this process uses the folder now."
            if owner.exists()
            else ""
        )
        with storage_faults(folder):
            owner.write_text(json.dumps({"pid": os.getpid(), "host": socket.gethostname()}), encoding="utf-8")
        yield stale[:1].upper() + stale[1:]
    finally:
        owner.unlink(missing_ok=True)
        lock.release()


def _acquired(folder: Path) -> FileLock | SoftLock | None:
    """Lock of the best kind that the disk has; None where another process holds it.

    A lock by a file counts on every disk: another machine may see the same folder without the system's locks.
    """
    soft = folder / SOFT_LOCK
    if not disks.has_file_locks(folder):
        lock = SoftLock(soft)
        return lock if lock.acquire() else None
    if soft.exists() and not is_stale(soft):
        return None
    hard = FileLock(folder / LOCK)
    try:
        hard.acquire(timeout=0)
    except Timeout:
        return None
    soft.unlink(missing_ok=True)
    return hard


def _advice(soft: Path) -> str:
    """What to do about a folder in use."""
    advice = "Wait for that process, stop it, or choose another folder with --out."
    if not soft.exists():
        return advice
    kind, _ = disks.file_system(soft)
    disk = f"a disk of type {shorten(kind, 40)}" if kind else "a disk"
    return (
        f"{advice} The folder is on {disk} without locks: if that process has ended on another machine, "
        f"the folder is free five minutes later, or as soon as you remove {soft}."
    )


def has_owner(folder: Path) -> bool:
    """Whether a process holds the folder, as far as can be told without disturbing it.

    Parameters
    ----------
    folder : Path
        Run folder.

    Returns
    -------
    bool
        False once the process that claimed the folder is known to have ended.
    """
    try:
        fields = read_facts(folder / OWNER)
        pid, host = int(fields["pid"]), fields["host"]
    except (OSError, ValueError, KeyError, TypeError, OverflowError):
        return False
    if host != socket.gethostname() or sys.platform == "win32":
        return True
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        return True
    return True


def _describe(owner: Path) -> str:
    try:
        fields = read_facts(owner)
        return f"process {int(fields['pid'])} on {shorten(str(fields['host']))}"
    except (OSError, ValueError, KeyError, TypeError, OverflowError):
        return "an unknown process"
