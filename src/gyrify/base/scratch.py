"""A folder for caches where neither the installation nor the home folder can be written."""

from __future__ import annotations

import atexit
import getpass
import os
import shutil
import stat
import tempfile
from contextlib import suppress
from functools import cache
from pathlib import Path


@cache
def scratch_folder() -> Path | None:
    """Return a folder in the temporary one that this user alone can write; None where there is none.

    It has the same name in every process of the user, so that what one process stores, others find. Caches
    hold compiled code: where somebody else owns a folder of that name, or could write to it, a new folder is
    made instead, which is removed when the process ends.

    Returns
    -------
    Path or None
    """
    try:
        base = Path(tempfile.gettempdir())
    except OSError:
        return None
    shared = base / f"gyrify-{_user()}"
    with suppress(OSError):
        shared.mkdir(mode=0o700, exist_ok=True)
        if _is_ours_alone(shared):
            return shared
    try:
        own = Path(tempfile.mkdtemp(prefix="gyrify-", dir=base))
    except OSError:
        return None
    atexit.register(shutil.rmtree, own, ignore_errors=True)
    return own


def _user() -> str:
    if hasattr(os, "getuid"):
        return str(os.getuid())
    try:
        return "".join(c for c in getpass.getuser() if c.isalnum()) or "user"
    except (OSError, KeyError, ImportError):
        return "user"


def _is_ours_alone(folder: Path) -> bool:
    """Whether it is a folder, no link to one, that belongs to this user and nobody else may write to."""
    found = folder.lstat()
    if not stat.S_ISDIR(found.st_mode) or not os.access(folder, os.W_OK | os.X_OK):
        return False
    if not hasattr(os, "geteuid"):
        return True
    return found.st_uid == os.geteuid() and not found.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
