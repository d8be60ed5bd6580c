"""Progress of a study: a live bar on a terminal, a line per run elsewhere, nothing when quiet."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from gyrify.cli.streams import complain

if TYPE_CHECKING:
    from gyrify.study import StudyProgress


@contextmanager
def progress_of_points(quiet: bool) -> Iterator[Callable[[StudyProgress], None]]:
    """Observer to pass to a study."""
    if quiet:
        yield lambda _: None
    elif sys.stderr.isatty():
        with _live_bar() as observer:
            yield observer
    else:
        yield _plain_line


def described(progress: StudyProgress) -> str:
    """The run that has ended, in one line."""
    if progress.point is None or progress.record is None:
        known = f"{progress.done} known from before" if progress.done else "none known yet"
        return f"{progress.total} runs, {known}"
    values = ", ".join(f"{key} = {_short(value)}" for key, value in progress.point.parameters.items())
    summary = progress.record.summary
    if progress.record.status != "completed" or summary is None:
        return f"{values}: {progress.record.status}: {progress.record.reason}"
    gi = summary["gi"]
    index = f"GI {gi['closing']:.3f}" if "closing" in gi else f"GI by area {gi['area']['closing']:.3f}"
    return f"{values}: {index}, {summary['n_gyri']} gyri"


def duration(seconds: float) -> str:
    """A time span in words: ``40 s``, ``12 min``, ``3 h 20 min``."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"


def _left(progress: StudyProgress) -> str:
    return "" if progress.remaining_s is None else f"about {duration(progress.remaining_s)} left"


def _plain_line(progress: StudyProgress) -> None:
    if progress.point is None:
        complain(described(progress))
        return
    left = f"; {_left(progress)}" if progress.done < progress.total else ""
    complain(f"{progress.done} of {progress.total}: {described(progress)}{left}")


def _short(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


@contextmanager
def _live_bar() -> Iterator[Callable[[StudyProgress], None]]:
    from rich.console import Console
    from rich.markup import escape
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (
        BarColumn(None),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("{task.fields[left]}"),
        TextColumn("[red]{task.fields[failed]}"),
    )
    with Progress(*columns, console=Console(stderr=True), expand=True) as bar:
        task = bar.add_task("running", total=None, left="", failed="")

        def observe(progress: StudyProgress) -> None:
            failed = f"{progress.failed} failed" if progress.failed else ""
            bar.update(
                task, total=progress.total, completed=progress.done, left=_left(progress), failed=failed
            )
            bar.console.print(escape(described(progress)), highlight=False, soft_wrap=True)

        yield observe
