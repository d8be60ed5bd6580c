"""Runs of a study, each in a folder of its own: begun, taken up again, or read when they are complete."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Final

from gyrify.base.pool import Watcher, each, go_on
from gyrify.config import Config
from gyrify.convergence.levels import Level
from gyrify.convergence.measured import measured
from gyrify.errors import GyrifyError, HistoryError
from gyrify.run.simulation import kept_run
from gyrify.run.summary import summarise, write_summary
from gyrify.store.folder import JOURNAL
from gyrify.store.history import History

HASH_DIGITS: Final = 12


def run_folder(config: Config, folder: Path) -> Path:
    """Folder of a run: the first digits of its configuration's hash."""
    return folder / config.config_hash[:HASH_DIGITS]


def complete(config: Config, watch: Watcher = go_on, *, folder: Path) -> Level:
    """Bring a run to its end, unless it is there already, and measure it; a failure is a result too.

    Parameters
    ----------
    config : Config
        The run.
    watch : callable
        Called at each Newton iteration; may raise to end the run there.
    folder : Path
        Where the folders of the runs are.

    Returns
    -------
    Level
    """
    target = run_folder(config, folder)
    try:
        if not _is_complete(config, target):
            _grow(config, target, watch)
        history = History.load(target)
        if history.status == "completed":
            warnings = tuple(summarise(history)["warnings"])
            return Level(config, target, "completed", "", measured(history), history.wall_s, warnings)
        reason = f"{history.reason} {history.advice}".strip()
        return Level(config, target, history.status, reason, {}, history.wall_s)
    except GyrifyError as failure:
        return Level(config, target, "failed", str(failure), {}, 0.0)
    except MemoryError:
        return Level(config, target, "failed", "Memory ran out.", {}, 0.0)
    except Exception as error:  # one run must not take the study with it
        return Level(config, target, "failed", f"An unexpected {type(error).__name__}: {error}.", {}, 0.0)


def complete_all(
    configs: Sequence[Config], folder: Path, workers: int, tell: Callable[[Level], None]
) -> dict[str, Level]:
    """Complete runs in processes of one thread each, or with a single worker in this process.

    Parameters
    ----------
    configs : sequence of Config
        The runs, each once; the last ones, which are the finest, are begun first.
    folder : Path
        Where the folders of the runs are.
    workers : int
        Processes.
    tell : callable
        Called with each run as it ends.

    Returns
    -------
    dict
        Runs by the hash of their configuration.

    Raises
    ------
    KeyboardInterrupt
        At Ctrl-C, once every process has ended at a safe place.
    GyrifyError
        If processes cannot begin.
    """
    levels: dict[str, Level] = {}
    found = each(partial(complete, folder=folder), configs[::-1], workers, partial(_lost, folder=folder))
    with closing(found):
        for level in found:
            levels[level.config.config_hash] = level
            tell(level)
    return levels


def _lost(config: Config, *, folder: Path) -> Level:
    reason = "Its process ended unexpectedly; memory may have run out. Use a smaller mesh."
    return Level(config, run_folder(config, folder), "failed", reason, {}, 0.0)


def _is_complete(config: Config, target: Path) -> bool:
    """Whether the folder holds the run, grown to the end.

    Raises
    ------
    HistoryError
        If it holds another one.
    """
    if not (target / JOURNAL).is_file():
        return False
    history = History.load(target)
    if history.config.config_hash != config.config_hash:
        raise HistoryError(
            f"The folder {target} holds a run of another configuration.", "Choose another with --out."
        )
    return history.status == "completed"


def _grow(config: Config, target: Path, watch: Watcher) -> None:
    """Begin a run, or take it up where it ended; its summary is written whatever comes of it."""
    with kept_run(config, target) as run:
        try:
            run.grow_to_some_end(watch)
        finally:
            write_summary(summarise(run.history), target / "summary.json")
