"""Files that appear whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from gyrify.store.files import fresh


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
