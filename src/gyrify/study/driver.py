"""Runs the points of a study that are not known yet."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Final

from gyrify.base.arguments import Pathlike, as_path, whole_number
from gyrify.base.pool import MAX_WORKERS
from gyrify.errors import ConfigError
from gyrify.store.disk_faults import storage_faults
from gyrify.store.files import refuse_link, whole_file
from gyrify.store.lock import run_lock
from gyrify.study.definition import Keep, Point, Study, as_study, require_keep
from gyrify.study.executors import dask_executor
from gyrify.study.known_points import KnownPoints
from gyrify.study.outcome import StudyObserver, StudyResult
from gyrify.study.stored_point import RUNS

STUDY_FILE: Final = "study.toml"


def run_study(
    study: Study | Mapping[str, Any] | str | os.PathLike[str], folder: Pathlike, **options: Any
) -> StudyResult:
    """Run a study; the same call again computes only what is not known yet.

    Parameters
    ----------
    study : Study, dict or path
        What to run; a path is that of a study file. ``study.toml`` in the folder keeps it.
    folder : path
        Study folder.
    **options
        As of `run_points`; ``keep`` is the study's unless it is given.

    Returns
    -------
    StudyResult
    """
    study, target = as_study(study), as_path("folder", folder)
    with storage_faults(target, what="study"):
        target.mkdir(parents=True, exist_ok=True)
        with whole_file(target / STUDY_FILE) as partial:
            partial.write_text(study.to_toml(), encoding="utf-8")
    return run_points(study.points(), target, **{"keep": study.keep, **options})


def run_points(
    points: Sequence[Point],
    folder: Pathlike,
    *,
    workers: int = 1,
    executor: Executor | None = None,
    scheduler: str | None = None,
    retry_failed: bool = False,
    keep: Keep = "final",
    observer: StudyObserver | None = None,
) -> StudyResult:
    """Run points; those that the folder holds, computed by the same solver, are not run again.

    Parameters
    ----------
    points : sequence of Point
        What to run, each configuration once; begun in this order.
    folder : path
        Study folder.
    workers : int
        Processes, of one thread each; 1 computes in this one. More need the usual
        ``if __name__ == "__main__"`` in a script.
    executor : concurrent.futures.Executor, optional
        Who computes instead of processes of our own; it stays open.
    scheduler : str, optional
        Address of a dask scheduler whose workers compute, such as ``tcp://node1:8786``.
    retry_failed : bool
        Whether points that failed, or were stopped by a limit, are run again.
    keep : {"final", "all"}
        What is kept of each run: its final result, or its whole run folder. With an executor or a scheduler,
        whole run folders need a disk that all machines share.
    observer : callable, optional
        Called with a `StudyProgress` at the beginning and as each point ends.

    Returns
    -------
    StudyResult

    Raises
    ------
    ConfigError
        If an argument is wrong.
    HistoryError
        If the folder is in use or cannot be written.
    GyrifyError
        If nothing can compute.
    KeyboardInterrupt
        At Ctrl-C; what is done is stored, and the same call continues.
    """
    workers = whole_number("workers", workers)
    _require_sensible(points, workers, executor, scheduler)
    target = as_path("folder", folder).absolute()
    with ExitStack() as stack:
        _make_runs_folder(target)
        stack.enter_context(run_lock(target, "study"))
        known = KnownPoints(
            tuple(points), target, require_keep(keep), retry_failed, observer or (lambda _: None)
        )
        if scheduler is not None and known.unknown:
            executor = stack.enter_context(dask_executor(scheduler))
        return known.complete(workers, executor)


def _make_runs_folder(target: Path) -> None:
    with storage_faults(target, what="study"):
        refuse_link(target / RUNS)
        (target / RUNS).mkdir(parents=True, exist_ok=True)


def _require_sensible(
    points: Sequence[Point], workers: int, executor: Executor | None, scheduler: str | None
) -> None:
    if not points:
        raise ConfigError("No points are given.", "Give at least one.")
    if len({point.key for point in points}) < len(points):
        raise ConfigError("A configuration is given twice.", "Give each point once.")
    if not 1 <= workers <= MAX_WORKERS:
        raise ConfigError(
            f"workers = {workers} is out of range (1 to {MAX_WORKERS}).", "Try the number of cores."
        )
    if executor is not None and scheduler is not None:
        raise ConfigError("Both an executor and a scheduler are given.", "Give one of them.")
