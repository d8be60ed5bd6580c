"""Configuration in, history out: runs growth, records every accepted increment, tells observers."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from pathlib import Path

from gyrify.config import Config
from gyrify.errors import HistoryError, LimitReachedError, SolveError
from gyrify.limits import Watch
from gyrify.model import Slice
from gyrify.solve.linear import linear_solver
from gyrify.solve.quasistatic import State, grow
from gyrify.store.history import History
from gyrify.store.journal import Journal
from gyrify.store.lock import run_lock
from gyrify.versions import versions

RUN_FILES = ("config.toml", "journal.sqlite", "history.vtkhdf", "metrics.csv", "summary.json", "folded.png")


@dataclass(frozen=True, eq=False)
class Progress:
    """What an observer sees at each accepted increment.

    Attributes
    ----------
    slice : Slice
        The problem.
    state : State
        The accepted state.
    fraction : float
        Growth time over the duration of growth.
    elapsed_s : float
        Time since this process took the run up [s].
    start_fraction : float
        Where this process took it up.
    """

    slice: Slice
    state: State
    fraction: float
    elapsed_s: float
    start_fraction: float

    @property
    def remaining_s(self) -> float:
        """Estimated time to the end [s], at the mean pace so far."""
        done = self.fraction - self.start_fraction
        return self.elapsed_s * (1.0 - self.fraction) / done if done > 0.0 else 0.0


Observer = Callable[[Progress], None]


def simulate(
    config: Config,
    out: str | Path | None = None,
    *,
    observers: Iterable[Observer] = (),
    overwrite: bool = False,
) -> History:
    """Fold a slice.

    Parameters
    ----------
    config : Config
        Every number of the run.
    out : path, optional
        Run folder for the journal; without it, the run is kept in memory.
    observers : iterable of callables
        Called with a `Progress` at each accepted increment.
    overwrite : bool
        Whether a run in the folder may be replaced.

    Returns
    -------
    History
        Complete, or ``stopped`` by a limit of the configuration.

    Raises
    ------
    SolveError
        If growth cannot be completed; all accepted increments are in the folder.
    HistoryError
        If the folder cannot be used.
    """
    problem = Slice(config)
    with nullcontext() if out is None else _claimed(Path(out), config, overwrite):
        path = None if out is None else Path(out) / "journal.sqlite"
        journal = Journal.create(path, {"config": config.to_toml(), "versions": json.dumps(versions())})
        journal.append(State.reference(problem.mesh.n_points, problem.mesh.n_dim), 0.0)
        return _run(problem, journal, tuple(observers))


def resume(run: str | Path, *, observers: Iterable[Observer] = ()) -> History:
    """Continue a run from its last accepted increment to the same end as if it had never stopped.

    Parameters
    ----------
    run : path
        Run folder.
    observers : iterable of callables
        As in `simulate`.

    Returns
    -------
    History

    Raises
    ------
    HistoryError
        If the folder holds no run, a damaged one, or one that another process works on.
    SolveError
        If growth cannot be completed.
    """
    folder = Path(run)
    if not (folder / "journal.sqlite").is_file():
        raise HistoryError(f"There is no run in {folder}.", "Name a folder that `gyrify run` has written.")
    with run_lock(folder):
        journal = Journal.open(folder / "journal.sqlite")
        return _run(Slice(Config.from_toml(journal.meta("config"))), journal, tuple(observers))


def _run(problem: Slice, journal: Journal, observers: tuple[Observer, ...]) -> History:
    problem.compile()
    state = journal.state(len(journal) - 1)
    stepping = problem.stepping
    start, begun = state.position / stepping.end, time.perf_counter()
    solver = linear_solver(problem.config.solver.linear_solver).name
    journal.set_meta(status="running", reason="", advice="", stable="", linear_solver=solver)
    watch = Watch(problem.config.limits.wall_time, problem.config.limits.memory)
    try:
        clock = begun
        for accepted in grow(problem, stepping, state, watch):
            now = time.perf_counter()
            journal.append(accepted, now - clock)
            clock = now
            progress = Progress(problem, accepted, accepted.position / stepping.end, now - begun, start)
            for observer in observers:
                observer(progress)
    except LimitReachedError as limit:
        journal.set_meta(status="stopped", reason=limit.message, advice=limit.advice)
    except SolveError as failure:
        journal.set_meta(status="failed", reason=failure.message, advice=failure.advice)
        raise
    except KeyboardInterrupt:
        journal.set_meta(
            status="interrupted", reason="interrupted by the user", advice="Continue with resume."
        )
        raise
    else:
        last = journal.state(len(journal) - 1)
        stable = problem.is_stable(last.position / stepping.end, last.u)
        journal.set_meta(status="completed", stable="true" if stable else "false")
    return History(journal)


@contextmanager
def _claimed(folder: Path, config: Config, overwrite: bool) -> Iterator[None]:
    """Hold the folder, made if need be, free of an earlier run, with the configuration in it."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise HistoryError(
            f"The run folder {folder} cannot be made: {error.strerror}.", "Choose another with --out."
        ) from error
    with run_lock(folder):
        if (folder / "journal.sqlite").exists() and not overwrite:
            raise HistoryError(
                f"The folder {folder} already holds a run.",
                "Replace it with --overwrite, continue it with `gyrify resume`, or choose another.",
            )
        for file in _leftovers(folder):
            file.unlink()
        (folder / "config.toml").write_text(config.to_toml(), encoding="utf-8")
        yield


def _leftovers(folder: Path) -> Iterator[Path]:
    """Files of an earlier run, and nothing else that a user may keep in the folder."""
    names = [*RUN_FILES, "journal.sqlite-wal", "journal.sqlite-shm"]
    return (folder / name for name in names if (folder / name).exists())
