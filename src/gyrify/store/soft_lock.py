"""A lock that is a file, for disks on which the system's locks do not work.

The file says who holds it, and the holder touches it every so often: where that has ceased, or its process
has ended, the lock is stale and may be taken over.
"""

from __future__ import annotations

import json
import os
import socket
import tempfile
import threading
import uuid
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from gyrify.store.files import read_facts

# Seconds between two touches, and after the last one until the lock counts as stale.
BEAT: Final = 20.0
STALE: Final = 300.0


class SoftLock:
    """A lock by a file that is made where there is none.

    Parameters
    ----------
    path : Path
        The file.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._over = threading.Event()
        self._text = json.dumps({**_this_process(), "token": uuid.uuid4().hex})

    def acquire(self) -> bool:
        """Take the lock; whether it could be had.

        Raises
        ------
        OSError
            If the folder cannot be written.
        """
        if not self._make() and not (self._remove_stale() and self._make()):
            return False
        threading.Thread(target=self._touch, daemon=True).start()
        return True

    def release(self) -> None:
        """Let go, unless somebody else has taken the lock over."""
        self._over.set()
        with suppress(OSError):
            if self._is_ours():
                self.path.unlink()

    def _make(self) -> bool:
        try:
            with self.path.open("x", encoding="utf-8") as file:
                file.write(self._text)
        except FileExistsError:
            return False
        return True

    def _remove_stale(self) -> bool:
        """Take a stale lock out of the way: renamed first, which only one process can do."""
        judged = self._read()
        if judged is None or not is_stale(self.path):
            return judged is None and not self.path.exists()
        aside = self.path.with_name(f"{self.path.name}.{uuid.uuid4().hex}")
        try:
            os.rename(self.path, aside)
        except FileNotFoundError:
            return True
        try:
            if aside.read_text(encoding="utf-8") == judged:
                return True
            with suppress(OSError):  # it was another's, taken since then: back with it
                os.link(aside, self.path)
            return False
        finally:
            aside.unlink(missing_ok=True)

    def _touch(self) -> None:
        while not self._over.wait(BEAT):
            with suppress(OSError):
                if not self._is_ours():
                    return
                os.utime(self.path)

    def _is_ours(self) -> bool:
        return self._read() == self._text

    def _read(self) -> str | None:
        try:
            return self.path.read_text(encoding="utf-8", errors="replace")
        except FileNotFoundError:
            return None


def is_stale(path: Path) -> bool:
    """Whether the holder of a lock has ended: as is seen on its own machine, or because it touches no more.

    Raises
    ------
    OSError
        If the folder cannot be written.
    """
    # By the disk's own clock, which is not that of this machine.
    with tempfile.NamedTemporaryFile(dir=path.parent, prefix=".gyrify-now-") as now:
        silent = os.stat(now.name).st_mtime - path.stat().st_mtime
    if silent > STALE:
        return True
    try:
        holder: dict[str, Any] = read_facts(path)
        here = _this_process()
        if (holder["host"], holder["space"]) != (here["host"], here["space"]) or os.name != "posix":
            return False
        os.kill(int(holder["pid"]), 0)
    except ProcessLookupError:
        return True
    except (OSError, ValueError, KeyError, TypeError, OverflowError):
        return False
    return False


def _this_process() -> dict[str, Any]:
    """Where the number of a process means this one: the machine, and the container on it."""
    try:
        space = os.readlink("/proc/self/ns/pid")
    except OSError:
        space = ""
    return {"pid": os.getpid(), "host": socket.gethostname(), "space": space}
