"""What a disk can do: locks of two kinds, and its name for messages."""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Final

from gyrify.config.words import shorten

_MOUNTS: Final = Path("/proc/self/mounts")
# Disks of several machines, on which memory that processes share is not the same on all of them.
_SHARED: Final = re.compile(
    r"nfs|lustre|gpfs|beegfs|ceph|cifs|smb|afs|9p|ocfs2|gfs2|panfs|pvfs|orangefs|wekafs|glusterfs|fuse\.sshfs"
)
_PROBE: Final = ".gyrify-probe-"


def file_system(path: Path) -> tuple[str, str]:
    """Kind and mount point of the disk of a file, such as ``("nfs4", "/home")``; empty if unknown."""
    try:
        lines = _MOUNTS.read_text(encoding="utf-8", errors="replace").splitlines()
        place = os.path.realpath(path)
    except OSError:
        return "", ""
    kind, point = "", ""
    for fields in map(str.split, lines):
        if len(fields) > 2:
            mount = re.sub(r"\\([0-7]{3})", lambda code: chr(int(code[1], 8)), fields[1])
            is_above = place == mount or place.startswith(mount.rstrip("/") + "/")
            if is_above and len(mount) >= len(point):
                kind, point = fields[2], mount
    return kind, point


def described(path: Path) -> str:
    """Return the words that name the disk of a file in a message, or nothing."""
    kind, point = file_system(path)
    return f" It is on a disk of type {shorten(kind, 40)} (mounted at {shorten(point, 80)})." if kind else ""


def is_shared(folder: Path) -> bool:
    """Whether other machines may use the disk of a folder too."""
    return _SHARED.search(file_system(folder)[0]) is not None


def has_record_locks(folder: Path) -> bool:
    """Whether POSIX locks (``fcntl``), which SQLite needs, work in a folder.

    Raises
    ------
    OSError
        If the folder cannot be written.
    """

    def lock(file: int) -> None:
        import fcntl

        fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB)

    return _works(folder, lock)


def has_file_locks(folder: Path) -> bool:
    """Whether locks of whole files (``flock``) work in a folder.

    Raises
    ------
    OSError
        If the folder cannot be written.
    """

    def lock(file: int) -> None:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)

    return _works(folder, lock)


def _works(folder: Path, lock: Callable[[int], None]) -> bool:
    """Whether a lock can be had on a new file, which nobody else knows."""
    if os.name != "posix":
        return True
    with tempfile.NamedTemporaryFile(dir=folder, prefix=_PROBE) as file:
        try:
            lock(file.fileno())
        except OSError:
            return False
    return True
