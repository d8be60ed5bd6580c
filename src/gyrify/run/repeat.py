"""The same configuration again, into a folder that holds it: done already, or to be continued."""

from __future__ import annotations

from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from shlex import quote
from typing import Any, Final

from gyrify.base.versions import versions
from gyrify.config import Config
from gyrify.config.inputs.named_files import FILE_KEYS
from gyrify.config.rows import rows
from gyrify.config.words import show
from gyrify.errors import HistoryError
from gyrify.store.derived import read_summary
from gyrify.store.folder import JOURNAL
from gyrify.store.journal import Journal
from gyrify.store.kept_inputs import stored_config

# What a run that ended leaves beside its journal and its summary.
_DERIVED: Final = ("metrics.csv", "folded.png", "history.vtkhdf")
_MOST_NAMED: Final = 3


@dataclass(frozen=True)
class KnownRun:
    """A run of one configuration that a folder holds already.

    Attributes
    ----------
    folder : Path
        Its folder.
    status : str
        How it ended, as the journal has it.
    changes : dict
        Values in ``limits`` and ``output`` that differ from the stored ones, by dotted key.
    summary : dict or None
        What ``summary.json`` says, where it is the one of this run.
    """

    folder: Path
    status: str
    changes: dict[str, object] = field(default_factory=dict)
    summary: dict[str, Any] | None = None

    @property
    def is_done(self) -> bool:
        """Whether it completed, and all its files are there as they are asked for."""
        return (
            self.status == "completed"
            and not self.changes
            and self.summary is not None
            and all((self.folder / name).is_file() for name in _DERIVED)
        )

    @property
    def note(self) -> str:
        """What becomes of it, in one sentence."""
        if self.is_done:
            what = f"it is complete: nothing is computed.{self._other_versions}"
        elif self.status == "completed":
            what = "it is complete: its files are written again."
        else:
            what = "it is not complete: it is continued."
        return f"{self.folder} already holds this run, and {what}"

    @property
    def _other_versions(self) -> str:
        stored, now = dict((self.summary or {}).get("versions", {})), versions()
        changed = [f"{name} {stored[name]}" for name in stored if stored[name] != now.get(name)]
        if not changed:
            return ""
        return f" It was computed with other versions ({', '.join(changed)}); --overwrite computes it again."


def known_run(config: Config, folder: Path) -> KnownRun | None:
    """Look whether a folder holds the run of a configuration.

    Parameters
    ----------
    config : Config
        What is to be run.
    folder : Path
        Run folder; it need not exist.

    Returns
    -------
    KnownRun or None
        None where the folder holds no run.

    Raises
    ------
    HistoryError
        If it holds a run of another configuration, or one that cannot be read.
    """
    if not (folder / JOURNAL).exists():
        return None
    with closing(Journal.open(folder / JOURNAL, read_only=True)) as journal:
        stored = stored_config(journal.meta("config"), journal.path)
        status = journal.meta("status", "running")
        result_hash = journal.result_hash
    if stored.config_hash != config.config_hash:
        raise HistoryError(
            f"The folder {folder} already holds a run of another configuration: "
            f"{_differences(stored, config)}.",
            f"Continue that run with `gyrify resume {quote(str(folder))}`, replace it with --overwrite, "
            "or choose another folder.",
        )
    summary = _own_summary(folder, result_hash) if status == "completed" else None
    return KnownRun(folder, status, _changes(stored, config), summary)


def _own_summary(folder: Path, result_hash: str) -> dict[str, Any] | None:
    """``summary.json`` of the run that the journal holds; None where it is missing, damaged or another's."""
    try:
        summary = read_summary(folder)
    except HistoryError:
        return None
    is_its_own = summary is not None and summary.get("result_hash") == result_hash
    return summary if is_its_own and summary is not None and summary.get("status") == "completed" else None


def _changes(stored: Config, config: Config) -> dict[str, object]:
    before = {row.key: row.value for row in rows(stored)}
    after = {row.key: row.value for row in rows(config)}
    elsewhere = {f"geometry.{key}" for key in FILE_KEYS}  # the digest tells whether files are the same
    return {key: value for key, value in after.items() if value != before[key] and key not in elsewhere}


def _differences(stored: Config, config: Config) -> str:
    """What differs outside of limits and output, in words."""
    before = {row.key: row.value for row in rows(stored)}
    keys = [key for key in _changes(stored, config) if key.split(".")[0] not in ("limits", "output")]
    after = {row.key: row.value for row in rows(config)}
    named = [f"{key} is {show(before[key])} there and {show(after[key])} here" for key in keys[:_MOST_NAMED]]
    more = len(keys) - _MOST_NAMED
    return ", ".join([*named, *([f"and {more} more values differ"] if more > 0 else [])])
