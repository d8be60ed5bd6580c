"""What a study tells while it goes on, and what it came to."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from gyrify.base.markup import html_rows
from gyrify.base.versions import solver_version
from gyrify.study.archive import Record
from gyrify.study.definition import Point
from gyrify.study.results import dimensions, read_results
from gyrify.study.stored_point import RUNS, StoredPoint

if TYPE_CHECKING:
    from pyarrow import Table


@dataclass(frozen=True)
class StudyProgress:
    """What an observer sees: once at the beginning, and as each point ends.

    Attributes
    ----------
    point : Point or None
        The one that has ended; None at the beginning.
    record : Record or None
        What it came to.
    done, failed, total : int
        Points that are known, those among them that did not complete, and all.
    elapsed_s : float
        Time since this call began computing [s].
    remaining_s : float or None
        Estimated time to the end [s], at the mean pace so far; None while there is none.
    """

    point: Point | None
    record: Record | None
    done: int
    failed: int
    total: int
    elapsed_s: float
    remaining_s: float | None


# Quantities and rows that a notebook shows.
_INDEX: Final = {2: "gi_closing", 3: "gi_area_closing"}
_SHOWN: Final = ("n_gyri", "sulcal_depth_mm_max")
_MOST_ROWS: Final = 50


def _cell(value: object) -> str:
    if value is None:
        return "-"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


StudyObserver = Callable[[StudyProgress], None]


def warnings_of(records: Mapping[str, Record]) -> dict[str, list[str]]:
    """Keys of the runs that a warning holds for, by its sentence.

    Parameters
    ----------
    records : mapping
        What each run came to, by key.

    Returns
    -------
    dict
    """
    found: dict[str, list[str]] = {}
    for key, record in records.items():
        for sentence in (record.summary or {}).get("warnings", ()):
            found.setdefault(sentence, []).append(key)
    return found


@dataclass(frozen=True, eq=False, repr=False)
class StudyResult:
    """A study that has ended.

    Attributes
    ----------
    folder : Path
        Study folder.
    points : tuple of Point
        The design.
    records : dict
        What each point came to, by key.
    computed : int
        Points computed by this call; the others were known.
    wall_s : float
        Time taken by this call [s].
    """

    folder: Path
    points: tuple[Point, ...]
    records: dict[str, Record]
    computed: int
    wall_s: float

    def __repr__(self) -> str:
        done = f"{len(self.points) - len(self.failures)} of {len(self.points)} runs completed"
        return f"StudyResult({self.status}: {done}, {self.computed} of them computed now, in {self.folder})"

    def _repr_html_(self) -> str:
        table = self.table
        indices = [_INDEX[n_dim] for n_dim in dimensions(table)]
        varied = (name for name in table.column_names if "." in name)
        names = ["key", "status", *varied, "phenotype", *indices, *_SHOWN]
        chosen = table.select([name for name in names if name in table.column_names]).slice(0, _MOST_ROWS)
        rows = ([_cell(value) for value in row.values()] for row in chosen.to_pylist())
        return html_rows(repr(self), rows, chosen.column_names)

    @property
    def failures(self) -> dict[str, str]:
        """Reason by key, of points that did not complete."""
        found = ((key, self.records[key]) for key in (point.key for point in self.points))
        return {key: f"{r.reason} {r.advice}".strip() for key, r in found if r.status != "completed"}

    @property
    def warnings(self) -> dict[str, list[str]]:
        """Keys of the points that a warning holds for, by its sentence."""
        return warnings_of({point.key: self.records[point.key] for point in self.points})

    @property
    def status(self) -> str:
        """``completed``, or what became of points that did not complete: ``failed`` before ``stopped``."""
        found = {record.status for record in self.records.values()}
        return next((status for status in ("failed", "stopped") if status in found), "completed")

    @property
    def table(self) -> Table:
        """One row per point; see `gyrify.study.read_results`."""
        return read_results(self.folder)

    def point(self, key: str) -> StoredPoint:
        """A point as it is stored; see `gyrify.study.final_state`.

        Parameters
        ----------
        key : str
            First 12 digits of the configuration's hash, the ``key`` of its row.
        """
        return StoredPoint(self.folder / RUNS / key, self.records[key])

    def as_dict(self) -> dict[str, Any]:
        """Fields as in ``gyrify study --json``."""
        return {
            "status": self.status,
            "folder": str(self.folder),
            "total": len(self.points),
            "computed": self.computed,
            "completed": len(self.points) - len(self.failures),
            "failures": [{"key": key, "reason": reason} for key, reason in self.failures.items()],
            "warnings": [{"warning": said, "keys": keys} for said, keys in self.warnings.items()],
            "solver_version": solver_version(),
            "wall_s": self.wall_s,
        }
