"""Progress of a run on stderr: a live bar on a terminal, plain lines elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from gyrify.metrics.gyrification import index_of
from gyrify.run.body_measures import surface_of

if TYPE_CHECKING:
    from gyrify.run.running import Observer, Progress

# Seconds between two updates of the bar: the gyrification index is only computed for what is shown.
_PAUSE = 0.1
# Seconds after which a plain line is due even if growth has not come far.
_PATIENCE = 60.0


def _print(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


@contextmanager
def progress_observer(
    is_shown: bool = True, tell: Callable[[str], None] = _print
) -> Iterator[list[Observer]]:
    """Observers to pass to a run, which show its progress inside a ``with`` block.

    Parameters
    ----------
    is_shown : bool
        Whether anything is to be shown at all.
    tell : callable
        Prints a line where there is no terminal.
    """
    if not is_shown:
        yield []
    elif sys.stderr.isatty():
        with _live_bar() as observer:
            yield [observer]
    else:
        yield [_plain_lines(tell)]


def _index(progress: Progress) -> float:
    """Index that is told on the way; in space that by the hull, which takes no time."""
    mesh, chosen = progress.slice.mesh, progress.slice.config.metrics
    points = mesh.points + progress.state.u[: mesh.n_points]
    if mesh.n_dim == 3:
        surface = surface_of(mesh, points, chosen)
        return surface.area / surface.hull_area
    return index_of(points[mesh.contour], "closing", chosen.closing_radius)


def _describe(progress: Progress) -> str:
    time_, duration = progress.fraction, progress.slice.config.growth.duration
    return (
        f"growth time {time_ * duration:.4g} of {duration:g}, GI {_index(progress):.3f}, "
        f"increment {progress.state.index}, {progress.state.stats.newton_iterations} iterations"
    )


def _brief(progress: Progress) -> str:
    """The same in few columns."""
    duration, state = progress.slice.config.growth.duration, progress.state
    return (
        f"time {progress.fraction * duration:.4g}/{duration:g}  GI {_index(progress):.3f}  "
        f"increment {state.index}  {state.stats.newton_iterations} iterations"
    )


def _plain_lines(tell: Callable[[str], None]) -> Callable[[Progress], None]:
    """A line at each tenth of growth, at the end, and at least every minute."""
    tenth, said = -1, time.monotonic()

    def observe(progress: Progress) -> None:
        nonlocal tenth, said
        reached, now = int(10.0 * progress.fraction + 1e-9), time.monotonic()
        if reached > tenth or now - said > _PATIENCE:
            tenth, said = reached, now
            tell(f"{_describe(progress)}, about {progress.remaining_s:.0f} s left")

    return observe


@contextmanager
def _live_bar() -> Iterator[Callable[[Progress], None]]:
    from rich.console import Console
    from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    left = TimeRemainingColumn(compact=True)
    columns = (BarColumn(None), TaskProgressColumn(), left, TextColumn("{task.description}"))
    with Bar(*columns, console=Console(stderr=True), expand=True) as bar:
        task = bar.add_task("growing", total=1.0)
        shown = 0.0

        def observe(progress: Progress) -> None:
            nonlocal shown
            now = time.monotonic()
            if now - shown >= _PAUSE or progress.fraction == 1.0:
                shown = now
                bar.update(task, completed=progress.fraction, description=_brief(progress))

        yield observe
