"""Faults of disks and folders, in plain words."""

from __future__ import annotations

import errno
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from shlex import quote
from typing import Final

from gyrify.errors import HistoryError

_FULL: Final = {errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC)}
_BLOCKED: Final = {errno.EACCES, errno.EPERM, errno.EROFS}
_NOT_A_FOLDER: Final = {errno.EEXIST, errno.ENOTDIR}


@contextmanager
def storage_faults(folder: Path, lost: str = "", what: str = "run") -> Iterator[None]:
    """Turn what the system says of a folder into one sentence with advice.

    Parameters
    ----------
    folder : Path
        Where is written.
    lost : str
        What could not be written; by default the folder itself.
    what : str
        Whether it is the folder of a run or of a study.

    Raises
    ------
    HistoryError
        In place of every `OSError`, and of the `RuntimeError` by which HDF5 reports a full disk.
    """
    try:
        yield
    except OSError as error:
        raise _explained(error, folder, lost, what) from error
    except RuntimeError as error:
        if "No space left" not in str(error):
            raise
        raise _explained(OSError(errno.ENOSPC, "No space left on device"), folder, lost, what) from error


def _explained(error: OSError, folder: Path, lost: str, kind: str) -> HistoryError:
    reason = error.strerror or str(error)
    what = f"{lost or f'The {kind} folder {folder}'} cannot be written: {reason}."
    if error.errno in _FULL or "No space left" in reason:
        again = f"continue with `gyrify resume {quote(str(folder))}`" if kind == "run" else "run it again"
        return HistoryError(what, f"Free space on the disk, then {again}.")
    if error.errno in _BLOCKED:
        return HistoryError(what, "Choose a folder that you may write to, with --out.")
    if error.errno in _NOT_A_FOLDER:
        return HistoryError(
            f"The {kind} folder {folder} cannot be made: {_file_in_the_way(folder)} is a file, not a folder.",
            "Choose another with --out.",
        )
    return HistoryError(what, "Choose another with --out.")


def _file_in_the_way(folder: Path) -> Path:
    return next((path for path in (folder, *folder.parents) if path.exists()), folder)
