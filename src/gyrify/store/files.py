"""Files written beside their target first; a folder from elsewhere may hold links where they would go."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

from gyrify.errors import HistoryError

# Largest file of facts (summary, point, owner) that is read, in bytes.
MAX_FACTS: Final = 16_000_000


def fresh(path: Path) -> Path:
    """Path of a file that is about to be written anew: what has the name now, also a link, is taken away."""
    path.unlink(missing_ok=True)
    return path


@contextmanager
def whole_file(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Path to write to; it takes the place of ``path`` when all is written, and vanishes if anything fails.

    Parameters
    ----------
    path : path-like
        File to write.

    Yields
    ------
    Path
        Temporary file beside it, with the suffix ``.partial``.
    """
    target = Path(path)
    partial = fresh(target.with_name(target.name + ".partial"))
    try:
        yield partial
        os.replace(partial, target)
    except BaseException:  # an interrupt, too, leaves no half of a file
        partial.unlink(missing_ok=True)
        raise


def refuse_link(path: Path) -> None:
    """Refuse to write through a link, which may lead out of the folder.

    Raises
    ------
    HistoryError
        If the path is a symbolic link.
    """
    if path.is_symlink():
        raise HistoryError(
            f"{path} is a symbolic link, and gyrify does not write through links.",
            "Remove it, or put the file itself there.",
        )


def read_facts(path: Path) -> dict[str, Any]:
    """Read a JSON object.

    Raises
    ------
    ValueError
        If the file is too large, or holds anything but an object.
    OSError
        If it cannot be read.
    """
    with path.open("rb") as file:
        data = file.read(MAX_FACTS + 1)
    if len(data) > MAX_FACTS:
        raise ValueError(f"it is larger than {MAX_FACTS} bytes")
    try:
        told = json.loads(data.decode("utf-8"))
    except RecursionError:
        raise ValueError("it is nested too deeply") from None
    if not isinstance(told, dict):
        raise ValueError("it is not a JSON object")
    return told
