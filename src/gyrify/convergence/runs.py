"""Runs of a study, each in a folder of its own: begun, taken up again, or read when they are complete."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing.connection import wait
from multiprocessing.synchronize import Event
from pathlib import Path
from typing import Final

from gyrify.config import Config
from gyrify.convergence.measured import measured
from gyrify.convergence.result import Level
from gyrify.errors import GyrifyError, HistoryError, SolveError
from gyrify.simulation import new_run, stored_run
from gyrify.store.folder import JOURNAL
from gyrify.store.history import History
from gyrify.summary import summarise, write_summary

HASH_DIGITS: Final = 12
_ONE_THREAD: Final = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS")
Watcher = Callable[[], None]
_stop: Event | None = None


def run_folder(config: Config, folder: Path) -> Path:
    """Folder of a run: the first digits of its configuration's hash."""
    return folder / config.config_hash[:HASH_DIGITS]


def complete(config: Config, folder: Path, watch: Watcher = lambda: None) -> Level:
    """Bring a run to its end, unless it is there already, and measure it; a failure is a result too.

    Parameters
    ----------
    config : Config
        The run.
    folder : Path
        Where the folders of the runs are.
    watch : callable
        Called at each Newton iteration; may raise to end the run there.

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
            return Level(config, target, "completed", "", measured(history), history.wall_s)
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
        The runs, each once.
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
        If a process dies.
    """
    levels: dict[str, Level] = {}
    for level in _in_turn(configs, folder) if workers == 1 else _in_pool(configs, folder, workers):
        levels[level.config.config_hash] = level
        tell(level)
    return levels


def _in_turn(configs: Sequence[Config], folder: Path) -> Iterator[Level]:
    return (complete(config, folder) for config in configs)


def _in_pool(configs: Sequence[Config], folder: Path, workers: int) -> Iterator[Level]:
    """Runs as they end; the last ones given, which are the finest, are begun first."""
    context = multiprocessing.get_context("spawn")
    stop = context.Event()
    with _one_thread(), ProcessPoolExecutor(workers, context, _begin_worker, (stop,)) as pool:
        futures: list[Future[Level]] = []
        try:
            with _deaf_children():
                futures += [pool.submit(_complete_in_worker, config, folder) for config in reversed(configs)]
            yield from (future.result() for future in as_completed(futures))
        except BrokenProcessPool as error:
            raise GyrifyError(
                "A process of the study ended without a word, for want of memory perhaps.",
                "Run it again with fewer workers; in a script, call it below if __name__ == '__main__'.",
            ) from error
        finally:
            stop.set()  # only an interrupt or an error finds runs that still go on
            for future in futures:
                future.cancel()


@contextmanager
def _deaf_children() -> Iterator[None]:
    """Hold Ctrl-C back while processes begin: they inherit that, and lay it down once they ignore it."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _begin_worker(stop: Event) -> None:
    """Leave Ctrl-C to the parent, and end with it whatever becomes of it."""
    global _stop
    _stop = stop
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    parent = multiprocessing.parent_process()
    if parent is not None:
        sentinel = parent.sentinel
        threading.Thread(target=lambda: (wait([sentinel]), os._exit(1)), daemon=True).start()


def _complete_in_worker(config: Config, folder: Path) -> Level:
    try:
        return complete(config, folder, _look)
    except KeyboardInterrupt:
        return Level(config, run_folder(config, folder), "interrupted", "The study was interrupted.", {}, 0.0)


def _look() -> None:
    if _stop is not None and _stop.is_set():
        raise KeyboardInterrupt


@contextmanager
def _one_thread() -> Iterator[None]:
    """Let processes that begin inside a ``with`` block compute with one thread each."""
    before = {name: os.environ.get(name) for name in _ONE_THREAD}
    os.environ.update(dict.fromkeys(_ONE_THREAD, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


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
    if (target / JOURNAL).is_file():
        limits = {f"limits.{key}": value for key, value in config.limits.model_dump().items()}
        begin = stored_run(target, limits)
    else:
        begin = new_run(config, target)
    with begin as run:
        try:
            run.grow((), watch)
        except SolveError:
            pass  # it is on record
        finally:
            write_summary(summarise(run.history), target / "summary.json")
