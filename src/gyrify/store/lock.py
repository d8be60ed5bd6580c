"""One process at a time on a run folder."""

from __future__ import annotations

import json
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout

from gyrify.errors import HistoryError


@contextmanager
def run_lock(folder: Path) -> Iterator[str]:
    """Hold the folder for this process; the operating system lets go when the process dies.

    Yields
    ------
    str
        A sentence about a previous owner that ended without letting go, or nothing.

    Raises
    ------
    HistoryError
        If another process holds the folder, or the folder cannot be written.
    """
    owner = folder / "run.owner.json"
    lock = FileLock(folder / "run.lock")
    try:
        lock.acquire(timeout=0)
    except Timeout as held:
        raise HistoryError(
            f"The run folder {folder} is in use by {_describe(owner)}.",
            "Wait for that process, stop it, or choose another folder with --out.",
        ) from held
    except OSError as error:
        raise HistoryError(
            f"The run folder {folder} cannot be written: {error.strerror}.", "Choose another with --out."
        ) from error
    try:
        stale = f"{_describe(owner)} ended without closing this run." if owner.exists() else ""
        owner.write_text(json.dumps({"pid": os.getpid(), "host": socket.gethostname()}), encoding="utf-8")
        yield stale[:1].upper() + stale[1:]
        owner.unlink(missing_ok=True)
    finally:
        lock.release()


def _describe(owner: Path) -> str:
    try:
        fields = json.loads(owner.read_text(encoding="utf-8"))
        return f"process {int(fields['pid'])} on {fields['host']}"
    except (OSError, ValueError, KeyError, TypeError):
        return "a process of unknown number"
