"""The folder of a run: claimed by one process, free of an earlier run, never emptied of anything else."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from shlex import quote
from typing import Final

from gyrify.config.inputs.named_files import kept_files
from gyrify.errors import HistoryError
from gyrify.store.disk_faults import storage_faults
from gyrify.store.files import refuse_link, whole_file
from gyrify.store.lock import run_lock

JOURNAL: Final = "journal.sqlite"
RUN_FILES: Final = (
    "config.toml",
    JOURNAL,
    "history.vtkhdf",
    "metrics.csv",
    "summary.json",
    "folded.png",
    "onset.png",
    "report.html",
)


@contextmanager
def new_folder(folder: Path, config: str, overwrite: bool) -> Iterator[str]:
    """Hold a folder, made if need be, free of an earlier run, with the configuration in it.

    Parameters
    ----------
    folder : Path
        Run folder.
    config : str
        Configuration as TOML.
    overwrite : bool
        Whether a run in the folder may be replaced.

    Yields
    ------
    str
        A sentence about an owner that ended without letting go, or nothing.

    Raises
    ------
    HistoryError
        If the folder is in use, holds a run that may not be replaced, or cannot be written.
    """
    with storage_faults(folder):
        folder.mkdir(parents=True, exist_ok=True)
    with run_lock(folder) as note:
        if (folder / JOURNAL).exists() and not overwrite:
            raise HistoryError(
                f"The folder {folder} already holds a run.",
                f"Continue it with `gyrify resume {quote(str(folder))}`, replace it with --overwrite, "
                "or choose another.",
            )
        with storage_faults(folder):
            for file in _leftovers(folder):
                file.unlink()
            write_config(folder, config)
        yield note


@contextmanager
def stored_folder(folder: Path) -> Iterator[str]:
    """Hold a folder that holds a run.

    Parameters
    ----------
    folder : Path
        Run folder.

    Yields
    ------
    str
        As `new_folder` does.

    Raises
    ------
    HistoryError
        If there is no run in it or a link to one, another process uses it, or it cannot be written.
    """
    if not (folder / JOURNAL).is_file():
        raise HistoryError(f"There is no run in {folder}.", "Name a folder that `gyrify run` has written.")
    for name in ("", "-wal", "-shm", "-journal"):
        refuse_link(folder / f"{JOURNAL}{name}")
    with run_lock(folder) as note:
        yield note


def write_config(folder: Path, config: str) -> None:
    """Write ``config.toml`` by atomic rename."""
    with whole_file(folder / "config.toml") as partial:
        partial.write_text(config, encoding="utf-8")


def _leftovers(folder: Path) -> Iterator[Path]:
    """Files of an earlier run, and nothing else that a user may keep in the folder."""
    names = [*RUN_FILES, *(f"{JOURNAL}{suffix}" for suffix in ("-wal", "-shm", "-journal"))]
    paths = (*(folder / name for name in names), *kept_files(folder))
    return (path for path in paths if path.is_symlink() or path.exists())
