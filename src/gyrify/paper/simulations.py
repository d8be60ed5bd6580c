"""Where the runs of the paper are made and remembered: one study folder, one set of processes."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from multiprocessing.connection import wait
from pathlib import Path
from typing import Any, Final, Self

from gyrify.base.pool import deaf_children
from gyrify.base.signals import ending_signals
from gyrify.errors import GyrifyError
from gyrify.paper.index import Index, index_metrics
from gyrify.paper.row import Row, row_of
from gyrify.study import Point, Record, StoredPoint, StudyProgress, final_state, run_points
from gyrify.study.results import write_results

_ONE_THREAD: Final = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS")


class Bench:
    """Runs points and remembers what they came to; use it in a ``with`` block.

    Parameters
    ----------
    folder : Path
        Study folder; runs that it holds already are not made again.
    workers : int
        Processes of one thread each; with 1, runs are made in this one.
    tell : callable
        Called with a `gyrify.study.StudyProgress` as each run ends.
    """

    def __init__(
        self, folder: Path, workers: int = 1, tell: Callable[[StudyProgress], None] = lambda _: None
    ) -> None:
        self.folder, self.workers, self._tell = folder, workers, tell
        self.points: dict[str, Point] = {}
        self.records: dict[str, Record] = {}
        self.computed = 0
        self._rows: dict[tuple[str, Index], Row] = {}
        self._executor: Executor | None = None

    def __enter__(self) -> Self:
        if self.workers > 1:
            os.environ.update(dict.fromkeys(_ONE_THREAD, "1"))
            context = multiprocessing.get_context("spawn")
            with deaf_children():  # Python begins a process that looks after the queues
                self._executor = ProcessPoolExecutor(self.workers, context, _begin_worker)
        return self

    def __exit__(self, *_: object) -> None:
        if self._executor is not None:
            self._executor.shutdown(wait=True, cancel_futures=True)

    def run(self, points: Sequence[Point]) -> None:
        """Bring points to their end, unless they are known.

        Raises
        ------
        GyrifyError
            If nothing can compute.
        KeyboardInterrupt
            At Ctrl-C; what is done is stored.
        """
        todo = list({point.key: point for point in points if point.key not in self.records}.values())
        if not todo:
            return
        result = run_points(todo, self.folder, executor=self._executor, observer=self._tell)
        self.computed += result.computed
        self.points |= {point.key: point for point in todo}
        self.records |= result.records

    @property
    def core_minutes(self) -> float:
        """Time that all known runs took, on one core each [min]."""
        return sum(record.wall_s for record in self.records.values()) / 60

    def call(self, work: Callable[..., Any], *arguments: object) -> Callable[[], Any]:
        """Begin other work in one of the processes; the answer is had by calling what is returned."""
        if self._executor is None:
            return lambda: work(*arguments)
        future: Future[Any] = self._executor.submit(work, *arguments)
        return future.result

    def row(self, point: Point, index: Index) -> Row | None:
        """What a point came to by one gyrification index, if it is known."""
        record = self.records.get(point.key)
        if record is None:
            return None
        known = (point.key, index)
        if known not in self._rows:
            reason = f"{record.reason} {record.advice}".strip()
            metrics = None
            if record.status == "completed" and record.summary is not None:
                metrics = index_metrics(index, point.config, record.summary, lambda: self.stored(point.key))
            self._rows[known] = row_of(point.config, point.key, record.status, reason, metrics)
        return self._rows[known]

    def stored(self, key: str) -> StoredPoint:
        """A point with its final state."""
        return final_state(self.folder, key)

    def write(self) -> None:
        """Write ``results.parquet`` with every run, and not only those of the last stage."""
        if not self.records:
            raise GyrifyError("Nothing has been run.", "Run something first.")
        write_results(self.folder, list(self.points.values()), self.records)


def _begin_worker() -> None:
    """Leave Ctrl-C and a queue's warnings to the parent, and end with it whatever becomes of it."""
    for number in ending_signals("SIGTERM"):
        signal.signal(number, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        sentinel = parent.sentinel
        threading.Thread(target=lambda: (wait([sentinel]), os._exit(1)), daemon=True).start()
