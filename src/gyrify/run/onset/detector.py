"""Stability of a run as it goes on: the onset of folding is found, and unstable equilibria are left."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from gyrify.errors import SolveError
from gyrify.model.slice import Slice
from gyrify.run.onset.mode_kinds import outwards
from gyrify.run.onset.onset_search import OnsetSearch
from gyrify.solve.branch import settle
from gyrify.solve.problem import State, Stepping
from gyrify.solve.stability import Onset, StabilityChange, Tangent
from gyrify.solve.system import System
from gyrify.solve.types import FloatArray

# First step along a mode over the cortical thickness.
_DEPARTURE = 0.2


@dataclass
class Detector:
    """Looks at accepted increments; an add-on that leaves a run with dissipation as it is.

    With growth, the smooth equilibrium is followed beside the run (`OnsetSearch`). Without dissipation an
    accepted state is an equilibrium of the tissue itself. An unstable one is left for a stable one: to the
    chosen side (`stability.follow_branch`), or else to the side that node jitter pushes to. A perfect slice
    that is not to be followed ends there with the evidence.

    Attributes
    ----------
    problem : Slice
        The tissue.
    stepping : Stepping
        How growth is divided.
    start : int
        Growth time in ticks at which this process took the run up: what lies before is stored already.
    watch : callable
        Called at each Newton iteration; may raise to stop.
    search : OnsetSearch
        What is known of the smooth equilibrium.
    n_negative : int or None
        Negative pivots at the last increment, before it was left; None where it was not looked at.
    onset : Onset or None
        The onset, if it was passed with the last increment.
    changes : list of StabilityChange
        Changes of stability that were passed with the last increment.
    """

    problem: Slice
    stepping: Stepping
    start: int = 0
    watch: Callable[[], None] = lambda: None
    search: OnsetSearch = field(init=False)
    n_negative: int | None = None
    onset: Onset | None = None
    changes: list[StabilityChange] = field(default_factory=list)
    _system: System | None = field(default=None, repr=False)
    _is_caught_up: bool = field(default=False, repr=False)

    def __post_init__(self) -> None:
        self.search = OnsetSearch(self.problem, self.watch)

    @property
    def found(self) -> tuple[int | None, Onset | None, list[StabilityChange]]:
        """What is to be stored with the last increment."""
        return self.n_negative, self.onset, self.changes

    def inspect(self, before: State, after: State) -> State:
        """Look at an increment; the state to go on from.

        Raises
        ------
        SolveError
            If the state is an unstable equilibrium that is not followed, or cannot be.
        """
        self._follow(after)
        if not self.problem.is_conservative:
            return after
        system = self._system_for(after)
        self.n_negative = self._tangent(after, before, system).n_negative
        return self._leave(before, after) if self.n_negative > 0 else after

    def _follow(self, after: State) -> None:
        """Follow the smooth equilibrium as far as the run has come; note what is new."""
        search = self.search
        if not self._is_caught_up:
            search.follow(self.start / self.stepping.end)
            self._is_caught_up = True
        n_known, was_known = len(search.changes), search.onset is not None
        search.follow(after.position / self.stepping.end)
        self.changes = search.changes[n_known:]
        self.onset = None if was_known else search.onset

    def _tangent(self, state: State, before: State, system: System) -> Tangent:
        return self.problem.tangent(state.position / self.stepping.end, state.u, before.u, system)

    def _system_for(self, state: State) -> System:
        """System whose pattern depends on the state alone, so that a resumed run finds the same bits."""
        known = self._system
        if known is not None and np.array_equal(known.couplings, state.couplings):
            return known
        self._system = self.problem.system(state.couplings)
        return self._system

    def _leave(self, before: State, after: State) -> State:
        """Stable state that an unstable equilibrium leads to."""
        problem, system = self.problem, self._system_for(after)
        stability = problem.config.stability
        if problem.is_perfect and not stability.follow_branch:
            eigenvalue = self._tangent(after, before, system).lowest().eigenvalue
            raise self._unstable(after, eigenvalue)
        settled = settle(
            problem.tissue_energy(after.position / self.stepping.end, before.u),
            after.u,
            system,
            problem.free_mass,
            self.stepping.criterion,
            problem.candidates,
            self._side(before, after),
            _DEPARTURE * problem.config.geometry.cortical_thickness,
            self.watch,
        )
        return replace(after, u=settled.u, residual=settled.residual, stats=after.stats + settled.stats)

    def _side(self, before: State, after: State) -> Callable[[FloatArray, FloatArray], FloatArray]:
        """The side to leave to: the chosen one, or else the one to which the imperfection pushes already."""
        problem, stability = self.problem, self.problem.config.stability
        if stability.follow_branch:
            return lambda u, mode: stability.sign * outwards(problem.mesh, u, mode)
        straight = before.u + (before.u - before.u_before) * (after.span / before.span)

        def drifting(u: FloatArray, mode: FloatArray) -> FloatArray:
            drift = problem.lumped_area @ np.sum(mode * (u - straight), axis=1)
            return mode if drift >= 0.0 else -mode

        return drifting

    def _unstable(self, state: State, eigenvalue: float) -> SolveError:
        duration = self.problem.config.growth.duration
        text = (
            f"Buckling instability: the equilibrium at growth time "
            f"{state.position / self.stepping.end * duration:.6g} is unstable, with "
            f"{self.n_negative} negative pivots in the stiffness and a lowest eigenvalue of "
            f"{eigenvalue:.4g} Pa/mm^2"
        )
        onset = self.search.onset_by(state.position / self.stepping.end)
        if onset is not None:
            self.onset = onset
            text += f"; stability is lost at growth time {onset.growth_time:.6g} in mode {onset.mode_number}"
        if self.problem.unknowns is not None:
            advice = 'Choose another mesh.split than "symmetric", or a dissipation.kind.'
            return SolveError(f"{text}.", advice)
        return SolveError(
            f"{text}.",
            "Set stability.follow_branch = true to fold, mesh.node_jitter above 0 to drift into folds, "
            "or choose a dissipation.kind.",
        )
