"""What is known of the points of a study: read at its beginning, stored as each point ends."""

from __future__ import annotations

import time
from concurrent.futures import Executor
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Final

from gyrify.base.versions import solver_version
from gyrify.errors import GyrifyError
from gyrify.store.disk_faults import storage_faults
from gyrify.store.folder import JOURNAL
from gyrify.study.archive import Record, read_record, sha256, write_record
from gyrify.study.definition import Keep, Point
from gyrify.study.executors import outcomes
from gyrify.study.outcome import StudyObserver, StudyProgress, StudyResult
from gyrify.study.results import write_results
from gyrify.study.solve import Outcome, solve_point
from gyrify.study.stored_point import RUNS

# Seconds between two writings of the results while points go on.
_PAUSE: Final = 10.0


class KnownPoints:
    """Keeps what is known of the points of a study while the others are computed."""

    def __init__(
        self, points: tuple[Point, ...], folder: Path, keep: Keep, retry: bool, tell: StudyObserver
    ) -> None:
        self.points, self.folder, self.keep, self.tell = points, folder, keep, tell
        self.by_hash = {point.config.config_hash: point for point in points}
        found = {point.key: self._known(point, retry) for point in points}
        self.records = {key: record for key, record in found.items() if record is not None}
        self.begun, self.written, self.computed = time.perf_counter(), 0.0, 0

    @property
    def unknown(self) -> list[Point]:
        """Points still to be computed."""
        return [point for point in self.points if point.key not in self.records]

    def complete(self, workers: int, executor: Executor | None) -> StudyResult:
        """Compute what is unknown, store it as it comes, and write the results whatever the end."""
        self._say(None)
        work = partial(solve_point, folder=self.folder / RUNS if self.keep == "all" else None)
        todo = [point.config for point in self.unknown]
        try:
            if todo:
                with closing(outcomes(work, todo, min(workers, len(todo)), executor)) as found:
                    for outcome in found:
                        self._note(outcome)
        finally:
            self._take_back()
            self._write()
        wall_s = time.perf_counter() - self.begun
        return StudyResult(self.folder, self.points, self.records, self.computed, wall_s)

    def _known(self, point: Point, retry: bool) -> Record | None:
        target = self.folder / RUNS / point.key
        record = read_record(target)
        if record is None or record.config_hash != point.config.config_hash:
            return None
        if record.solver_version != solver_version() or (retry and record.status != "completed"):
            return None
        needs_journal = self.keep == "all" and record.summary is not None
        return None if needs_journal and not (target / JOURNAL).is_file() else record

    def _take_back(self) -> None:
        """Note what is stored and not yet noted: a signal may come between the two."""
        found = {point.key: self._known(point, retry=False) for point in self.unknown}
        self.records.update({key: record for key, record in found.items() if record is not None})

    def _note(self, outcome: Outcome) -> None:
        """Store a point that has ended."""
        if outcome.solver_version != solver_version():
            raise GyrifyError(
                f"A worker computes with solver version {outcome.solver_version}, this process with "
                f"{solver_version()}.",
                "Install the same gyrify and libraries wherever points are computed; where the source has "
                "changed since the study began, run it again.",
            )
        point = self.by_hash[outcome.config.config_hash]
        record = Record(
            outcome.config.config_hash,
            outcome.solver_version,
            outcome.status,
            outcome.reason,
            outcome.advice,
            outcome.config.to_dict(),
            outcome.summary,
            sha256(outcome.final),
            outcome.wall_s,
        )
        with storage_faults(self.folder, what="study"):
            write_record(self.folder / RUNS / point.key, record, outcome.final)
        self.records[point.key] = record
        self.computed += 1
        if time.perf_counter() - self.written > _PAUSE:
            self._write()
        self._say(point)

    def _write(self) -> None:
        with storage_faults(self.folder, what="study"):
            write_results(self.folder, self.points, self.records)
        self.written = time.perf_counter()

    def _say(self, point: Point | None) -> None:
        elapsed, left = time.perf_counter() - self.begun, len(self.points) - len(self.records)
        failed = sum(record.status != "completed" for record in self.records.values())
        remaining = elapsed * left / self.computed if self.computed else (0.0 if left == 0 else None)
        record = None if point is None else self.records[point.key]
        self.tell(
            StudyProgress(point, record, len(self.records), failed, len(self.points), elapsed, remaining)
        )
