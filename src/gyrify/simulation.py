"""Configuration in, history out: runs growth, records every accepted increment, tells observers."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from gyrify.config import Config
from gyrify.detection import Detector
from gyrify.errors import ConfigError, GyrifyError, HistoryError, LimitReachedError, SolveError
from gyrify.limits import Watch
from gyrify.model import Slice
from gyrify.solve.linear import linear_solver
from gyrify.solve.quasistatic import State, grow
from gyrify.store.faults import storage_faults
from gyrify.store.folder import JOURNAL, new_folder, stored_folder, write_config
from gyrify.store.history import History
from gyrify.store.journal import Journal
from gyrify.versions import versions


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
Watcher = Callable[[], None]


class Run:
    """A run that this process holds; from `new_run` or `stored_run`.

    Parameters
    ----------
    problem : Slice
        The problem.
    journal : Journal
        Where accepted increments go; it holds one at least.
    note : str
        What a user should know about the folder.
    """

    def __init__(self, problem: Slice, journal: Journal, note: str = "") -> None:
        self.problem, self.journal, self.note = problem, journal, note
        if len(journal) == 0:
            journal.append(State.reference(problem.mesh.n_points, problem.mesh.n_dim), 0.0)

    @property
    def history(self) -> History:
        """What is stored so far."""
        return History(self.journal)

    def grow(self, observers: Iterable[Observer] = (), watch: Watcher = lambda: None) -> None:
        """Grow from the last stored state to the end; whatever happens, how it ended is recorded.

        Parameters
        ----------
        observers : iterable of callables
            As in `simulate`.
        watch : callable
            Called at each Newton iteration; may raise to end the run there.

        Raises
        ------
        SolveError
            If growth cannot be completed.
        HistoryError
            If the disk is full.
        """
        self.problem.compile()
        solver = linear_solver(self.problem.config.solver.linear_solver).name
        self.journal.set_meta(status="running", reason="", advice="", stable="", linear_solver=solver)
        try:
            self._accept(tuple(observers), watch)
            last = self.journal.state(len(self.journal) - 1)
            stable = self.problem.is_stable(last.position / self.problem.stepping.end, last.u)
            self.journal.set_meta(status="completed", stable="true" if stable else "false")
        except LimitReachedError as limit:
            self.journal.set_meta(status="stopped", reason=limit.message, advice=limit.advice)
        except KeyboardInterrupt:
            self._record("interrupted", "It was interrupted by the user.", "Continue with `gyrify resume`.")
            raise
        except GyrifyError as failure:
            self._record("failed", failure.message, failure.advice)
            raise
        except Exception as error:
            reason = f"An unexpected {type(error).__name__} ended it: {error}."
            self._record("failed", reason, "Once its cause is removed, continue with `gyrify resume`.")
            raise

    def _accept(self, observers: tuple[Observer, ...], watch: Watcher) -> None:
        """Store and tell every increment that the solver accepts."""
        problem, stepping = self.problem, self.problem.stepping
        state = self.journal.state(len(self.journal) - 1)
        start, begun = state.position / stepping.end, time.perf_counter()
        limits = Watch(problem.config.limits.wall_time, problem.config.limits.memory)

        def look() -> None:
            watch()
            limits()

        detector = Detector(problem, stepping, self.journal.onset is not None, look)
        inspect = (detector.inspect,) if problem.config.stability.detect else ()
        clock = begun
        try:
            for accepted in grow(problem, stepping, state, look, *inspect):
                now = time.perf_counter()
                self.journal.append(accepted, now - clock, detector.n_negative, detector.onset)
                clock = now
                progress = Progress(problem, accepted, accepted.position / stepping.end, now - begun, start)
                for observer in observers:
                    observer(progress)
        except SolveError:
            if detector.onset is not None:
                self.journal.set_onset(detector.onset)
            raise

    def _record(self, status: str, reason: str, advice: str) -> None:
        """Note how the run ended; what ended it may keep even that from being written."""
        with suppress(HistoryError):
            self.journal.set_meta(status=status, reason=reason, advice=advice)


@contextmanager
def new_run(config: Config, out: str | Path | None = None, *, overwrite: bool = False) -> Iterator[Run]:
    """Begin a run, and hold its folder until the end of the ``with`` block.

    Parameters
    ----------
    config : Config
        Every number of the run.
    out : path, optional
        Run folder; without it, the run is kept in memory.
    overwrite : bool
        Whether a run in the folder may be replaced.

    Yields
    ------
    Run

    Raises
    ------
    HistoryError
        If the folder cannot be used.
    """
    problem = Slice(config)
    meta = {"config": config.to_toml(), "versions": json.dumps(versions())}
    if out is None:
        yield Run(problem, Journal.create(None, meta))
        return
    folder = Path(out)
    with new_folder(folder, meta["config"], overwrite) as note:
        journal = Journal.create(folder / JOURNAL, meta)
        try:
            yield Run(problem, journal, note)
        finally:
            journal.settle()


@contextmanager
def stored_run(run: str | Path, overrides: Mapping[str, object] | None = None) -> Iterator[Run]:
    """Take up a stored run, and hold its folder until the end of the ``with`` block.

    Parameters
    ----------
    run : path
        Run folder.
    overrides : mapping, optional
        New values in ``limits`` and ``output``, by dotted key; nothing else of a run can change.

    Yields
    ------
    Run

    Raises
    ------
    HistoryError
        If the folder holds no run, a damaged one, or one that another process works on.
    ConfigError
        If an override is not allowed.
    """
    folder = Path(run)
    with stored_folder(folder) as note:
        journal = Journal.open(folder / JOURNAL)
        config = Config.from_toml(journal.meta("config"))
        if overrides:
            config = _changed(config, overrides)
            journal.set_meta(config=config.to_toml())
        with storage_faults(folder):
            write_config(folder, config.to_toml())
            (folder / "summary.json").unlink(missing_ok=True)  # it told of an earlier end
        try:
            yield Run(Slice(config), journal, note)
        finally:
            journal.settle()


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
        Called with a `Progress` at each accepted increment, once that is stored; what one raises ends the
        run.
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
    with new_run(config, out, overwrite=overwrite) as run:
        run.grow(observers)
    return run.history


def resume(
    run: str | Path,
    *,
    overrides: Mapping[str, object] | None = None,
    observers: Iterable[Observer] = (),
) -> History:
    """Continue a run from its last accepted increment to the same end as if it had never stopped.

    Parameters
    ----------
    run : path
        Run folder.
    overrides : mapping, optional
        New values in ``limits`` and ``output``, by dotted key.
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
    with stored_run(run, overrides) as held:
        held.grow(observers)
    return held.history


def _changed(config: Config, overrides: Mapping[str, object]) -> Config:
    changed = config.with_overrides(overrides)
    if changed.config_hash != config.config_hash:
        raise ConfigError(
            "A stored run keeps its configuration: only values in limits and output can change.",
            "Begin another run with `gyrify run`.",
        )
    return changed
