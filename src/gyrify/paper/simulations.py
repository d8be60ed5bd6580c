"""Where the runs of the paper are made and remembered: one study folder, one set of processes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Self

from gyrify.base.pool import Crew
from gyrify.errors import GyrifyError
from gyrify.paper.index import Index, index_metrics
from gyrify.paper.row import Row, row_of
from gyrify.study import Point, Record, StoredPoint, StudyProgress, final_state, run_points
from gyrify.study.results import write_results


class Simulations:
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
        self._crew: Crew | None = None

    def __enter__(self) -> Self:
        if self.workers > 1:
            self._crew = Crew(self.workers)
        return self

    def __exit__(self, *raised: Any) -> None:
        if self._crew is not None:
            self._crew.__exit__(*raised)

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
        result = run_points(todo, self.folder, executor=self._crew, observer=self._tell)
        self.computed += result.computed
        self.points |= {point.key: point for point in todo}
        self.records |= result.records

    @property
    def core_minutes(self) -> float:
        """Time that all known runs took, on one core each [min]."""
        return sum(record.wall_s for record in self.records.values()) / 60

    def call(self, work: Callable[..., Any], *arguments: object) -> Callable[[], Any]:
        """Begin other work in one of the processes; the answer is had by calling what is returned."""
        if self._crew is None:
            return lambda: work(*arguments)
        return self._crew.submit(work, *arguments).result

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
