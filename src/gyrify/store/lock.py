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
from gyrify.store.faults import storage_faults
from gyrify.store.files import read_facts, refuse_link

OWNER: Final = "run.owner.json"


@contextmanager
def run_lock(folder: Path, what: str = "run") -> Iterator[str]:
    """Hold the folder for this process; the operating system lets go when the process dies.

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
    for path in (owner, folder / "run.lock"):
        refuse_link(path)
    lock = FileLock(folder / "run.lock")
    with storage_faults(folder):
        try:
            lock.acquire(timeout=0)
        except Timeout as held:
            raise HistoryError(
                f"The {what} folder {folder} is in use by {_describe(owner)}.",
                "Wait for that process, stop it, or choose another folder with --out.",
            ) from held
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
