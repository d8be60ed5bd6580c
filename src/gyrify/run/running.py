"""A run that this process holds: grows, stores every accepted increment, tells observers, records its end."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass

from gyrify.energy.contact_libraries import OWN, contact_library
from gyrify.errors import GyrifyError, HistoryError, LimitReachedError, SolveError
from gyrify.model.slice import Slice
from gyrify.run.limits import Watch
from gyrify.run.onset.detector import Detector
from gyrify.run.onset.relax import relax
from gyrify.solve.linear import is_available
from gyrify.solve.problem import State
from gyrify.solve.quasistatic import grow
from gyrify.store.history import History
from gyrify.store.journal import Journal


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
    """A run that this process holds; from `gyrify.run.simulation.new_run` or `stored_run`.

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
        limits = problem.config.limits
        self._limits = Watch(limits.wall_time, limits.memory)
        if len(journal) == 0:
            journal.append(problem.reference_state(), 0.0)

    @property
    def history(self) -> History:
        """What is stored so far."""
        return History(self.journal, self.problem)

    def grow(self, observers: Iterable[Observer] = (), watch: Watcher = lambda: None) -> None:
        """Grow from the last stored state to the end; whatever happens, how it ended is recorded.

        Parameters
        ----------
        observers : iterable of callables
            As in `gyrify.run.simulation.simulate`.
        watch : callable
            Called at each Newton iteration; may raise to end the run there.

        Raises
        ------
        SolveError
            If growth cannot be completed.
        HistoryError
            If the disk is full.
        """
        self.journal.set_meta(
            status="running",
            reason="",
            advice="",
            stable="",
            relaxed="",
            linear_solver=self._linear_solver(),
            contact_library=self._contact_library(),
        )
        try:
            self.problem.compile()  # memory may run out even here
            self._accept(tuple(observers), watch)
            self.journal.set_meta(status="completed", **self._last_state(watch))
        except LimitReachedError as limit:
            self.journal.set_meta(status="stopped", reason=limit.message, advice=limit.advice)
        except KeyboardInterrupt as interrupt:
            self._record("interrupted", _ended_by(interrupt), "Continue with `gyrify resume`.")
            raise
        except GyrifyError as failure:
            self._record("failed", failure.message, failure.advice)
            raise
        except MemoryError:
            self._record(
                "failed", "Memory ran out.", "Use a smaller mesh, or more memory and `gyrify resume`."
            )
            raise
        except Exception as error:
            reason = f"An unexpected {type(error).__name__} ended it: {error}."
            self._record("failed", reason, "Once its cause is removed, continue with `gyrify resume`.")
            raise

    def grow_to_some_end(self, watch: Watcher = lambda: None) -> None:
        """`grow` to whatever end is on record; what is not is raised."""
        try:
            self.grow((), watch)
        except Exception:
            with suppress(GyrifyError):
                if self.history.status == "failed":
                    return
            raise

    def _last_state(self, watch: Watcher) -> dict[str, str]:
        """Whether the last state stays as it is, and what it relaxes to where dissipation holds it back."""
        last = len(self.journal) - 1
        state, fraction = self.journal.state(last), 1.0
        known = self.journal.negative_pivots.get(last)
        if known is not None:
            return {"stable": "false" if known else "true"}
        try:  # whatever comes of it, growth has come to its end
            if self.problem.is_conservative:
                return {"stable": _word(self.problem.is_stable(fraction, state.u))}
            if self.problem.config.stability.detect:
                relaxed = relax(self.problem, fraction, state.u, self._look(watch))
                if relaxed is not None:
                    return {"stable": _word(relaxed.is_kept), "relaxed": relaxed.to_text()}
        except (SolveError, LimitReachedError):
            pass
        return {}

    def _linear_solver(self) -> str:
        """Library that solves; the one that the run began with, or its end would be another."""
        asked, solver = self.problem.config.solver.linear_solver, self.problem.linear_solver
        begun_with = self.journal.meta("linear_solver", solver)
        if begun_with == solver:
            return solver
        if self._is_under_way and asked == "auto" and is_available(begun_with):
            self.problem.use_linear_solver(begun_with)  # a machine of another memory would choose another
            return begun_with
        if self._is_under_way:
            raise HistoryError(
                f"The run was begun with {begun_with}, but solver.linear_solver is now {solver}: "
                "continued, it would not end with the same result.",
                f"Resume where {begun_with} is installed, or run again.",
            )
        return begun_with if self._last_position > 0 else solver

    def _contact_library(self) -> str:
        """Library that computes contact; the one that the run began with, or its end would be another.

        Runs of versions without a record of it had ipctk.
        """
        if not self.problem.config.contact.enabled:
            return "none"
        library = contact_library()
        begun_with = self.journal.meta("contact_library", "ipctk" if self._last_position > 0 else library)
        if begun_with == OWN and self._last_position > 0:
            self.problem.use_contact_library(OWN)
            return OWN
        if begun_with != library and self._is_under_way:
            raise HistoryError(
                "The run was begun with contact by ipctk, which is not installed here: continued without it, "
                "the run would not end with the same result.",
                "Resume where ipctk is installed (pip install ipctk), or run again.",
            )
        return library if self._last_position == 0 else begun_with

    @property
    def _last_position(self) -> int:
        """Growth time of the last stored state, in ticks."""
        return self.journal.state(len(self.journal) - 1).position

    @property
    def _is_under_way(self) -> bool:
        """Whether the run has begun to grow, and is not at its end."""
        return 0 < self._last_position < self.problem.stepping.end

    def _accept(self, observers: tuple[Observer, ...], watch: Watcher) -> None:
        """Store and tell every increment that the solver accepts."""
        problem, stepping = self.problem, self.problem.stepping
        state = self.journal.state(len(self.journal) - 1)
        start, begun = state.position / stepping.end, time.perf_counter()
        look = self._look(watch)
        detector = (
            Detector(problem, stepping, state.position, look) if problem.config.stability.detect else None
        )
        inspect = detector.inspect if detector else lambda _, accepted: accepted
        clock = begun
        try:
            for accepted in grow(problem, stepping, state, look, inspect, self.journal.state):
                now = time.perf_counter()
                self.journal.append(accepted, now - clock, *(detector.found if detector else ()))
                clock = now
                progress = Progress(problem, accepted, accepted.position / stepping.end, now - begun, start)
                for observer in observers:
                    observer(progress)
        except SolveError:
            if detector and detector.onset is not None:
                self.journal.set_onset(detector.onset, detector.changes)
            raise
        finally:
            if detector and detector.search.lost_at is not None:
                with suppress(HistoryError):
                    self.journal.set_meta(smooth_until=repr(detector.search.lost_at))

    def _look(self, watch: Watcher) -> Watcher:
        """What is called at each iteration: the caller's, and the limits."""

        def look() -> None:
            watch()
            self._limits()

        return look

    def _record(self, status: str, reason: str, advice: str) -> None:
        """Note how the run ended; what ended it may keep even that from being written."""
        with suppress(HistoryError):
            self.journal.set_meta(status=status, reason=reason, advice=advice)


def _word(value: bool) -> str:
    return "true" if value else "false"


def _ended_by(interrupt: KeyboardInterrupt) -> str:
    """Who ended a run; an interrupt holds the name of the signal where it was not Ctrl-C."""
    name = str(interrupt)
    return f"The signal {name} ended it." if name not in ("", "SIGINT") else "It was interrupted by the user."
