"""Loss of stability in a run: looked for at accepted increments, located, and where asked for, followed."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.optimize import brentq

from gyrify.errors import SolveError
from gyrify.mesh.waves import dominant_wave, normal_displacement
from gyrify.model import Slice
from gyrify.solve.branch import settle
from gyrify.solve.equilibrium import find_equilibrium
from gyrify.solve.problem import State, Stepping
from gyrify.solve.result import Result
from gyrify.solve.stability import Eigenpair, Onset, Tangent
from gyrify.solve.system import System
from gyrify.solve.types import FloatArray

# With dissipation so many increments are looked at until the onset, evenly spaced, and half as many after it;
# the first unstable one is then sought among those between.
LOOKS = 20
# Tolerance of the onset, as a fraction of its increment; first step along a mode over the cortical thickness.
_ONSET_TOLERANCE = 1e-3
_DEPARTURE = 0.2


@dataclass
class Detector:
    """Looks at accepted increments; an add-on that leaves a run with dissipation as it is.

    Without dissipation an accepted state is an equilibrium of the tissue itself. An unstable one is left for
    a stable one: to the chosen side (`stability.follow_branch`), or else to the side that node jitter pushes
    to. A perfect slice that is not to be followed ends there with the evidence.

    Attributes
    ----------
    problem : Slice
        The tissue.
    stepping : Stepping
        How growth is divided.
    found : bool
        Whether the onset is known already.
    recall : callable
        Gives an earlier accepted increment by its number.
    watch : callable
        Called at each Newton iteration; may raise to stop.
    n_negative : int or None
        Negative pivots at the last increment, before it was left; None where it was not looked at.
    onset : Onset or None
        The onset, if it lies in the last increment.
    """

    problem: Slice
    stepping: Stepping
    found: bool
    recall: Callable[[int], State]
    watch: Callable[[], None] = lambda: None
    n_negative: int | None = None
    onset: Onset | None = None
    _system: System | None = field(default=None, repr=False)

    def inspect(self, before: State, after: State) -> State:
        """Look at an increment; the state to go on from.

        Raises
        ------
        SolveError
            If the state is an unstable equilibrium that is not followed, or cannot be.
        """
        self.n_negative = self.onset = None
        conservative, end = self.problem.is_conservative, after.position == self.stepping.end
        if not (conservative or end or after.index % (self._spacing * (1 + self.found)) == 0):
            return after
        try:
            n_negative = self._look(before, after)
        except SolveError:
            if conservative:
                raise
            return after
        return self._leave(before, after) if conservative and n_negative > 0 else after

    @property
    def _spacing(self) -> int:
        """Increments from one look to the next."""
        return max(1, self.stepping.increments // LOOKS)

    def _look(self, before: State, after: State) -> int:
        """Count the negative pivots of an increment; locate the onset if it lies since the last look."""
        if self._system is None:
            self._system = self.problem.system(after.couplings)
        self.n_negative = n_negative = self._tangent(after, before, self._system).n_negative
        if n_negative > 0 and not self.found:
            stable, unstable = self._first_unstable(before, after)
            system = self._system_for(unstable)
            self.onset = locate_onset(self.problem, self.stepping, stable, unstable, system, self.watch)
            self.found = True
        return n_negative

    def _first_unstable(self, before: State, after: State) -> tuple[State, State]:
        """By bisection, neighbouring increments since the last look, stable and unstable, up to ``after``."""
        known = {before.index: before, after.index: after}
        low = before.index if self.problem.is_conservative else before.index // self._spacing * self._spacing
        high = after.index

        def state(index: int) -> State:
            if index not in known:
                known[index] = self.recall(index)
            return known[index]

        while high - low > 1:
            middle = (low + high) // 2
            tangent = self._tangent(state(middle), state(middle - 1), self._system_for(state(middle)))
            low, high = (middle, high) if tangent.is_stable else (low, middle)
        return state(low), state(high)

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
        is_perfect = problem.config.mesh.node_jitter == 0.0
        if is_perfect and not stability.follow_branch:
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
            return lambda u, mode: stability.sign * outwards(problem, u, mode)
        straight = before.u + (before.u - before.u_before) * (after.span / before.span)

        def drifting(u: FloatArray, mode: FloatArray) -> FloatArray:
            drift = problem.lumped_area @ np.sum(mode * (u - straight), axis=1)
            return mode if drift >= 0.0 else -mode

        return drifting

    def _unstable(self, state: State, eigenvalue: float) -> SolveError:
        time = state.position / self.stepping.end * self.problem.config.growth.duration
        text = (
            f"Buckling instability: the equilibrium at growth time {time:.6g} is unstable, with "
            f"{self.n_negative} negative pivots in the stiffness and a lowest eigenvalue of "
            f"{eigenvalue:.4g} Pa/mm^2"
        )
        if self.onset is not None:
            onset = self.onset
            text += f"; stability is lost at growth time {onset.growth_time:.6g} in mode {onset.mode_number}"
        return SolveError(
            f"{text}.",
            "Set stability.follow_branch = true to fold, mesh.node_jitter above 0 to drift into folds, "
            "or choose a dissipation.kind.",
        )


def locate_onset(
    problem: Slice,
    stepping: Stepping,
    before: State,
    after: State,
    system: System,
    watch: Callable[[], None] = lambda: None,
) -> Onset:
    """Find where the lowest eigenvalue of elasticity and contact vanishes inside an increment.

    Parameters
    ----------
    problem : Slice
        The tissue.
    stepping : Stepping
        How growth is divided.
    before, after : State
        The last stable and the first unstable accepted state. Between them the same incremental problem is
        solved with parts of the span.
    system : System
        Linear system of the free degrees of freedom.
    watch : callable
        Called at each Newton iteration; may raise to stop.

    Returns
    -------
    Onset
        The state closest to singular that was found; its bracket is wide if a part could not be solved.
    """
    start, end = (state.position / stepping.end for state in (before, after))
    known: dict[float, tuple[FloatArray, Eigenpair]] = {}

    def eigenvalue(share: float) -> float:
        fraction = start + share * (end - start)
        u = before.u + share * (after.u - before.u)
        if 0.0 < share < 1.0:
            total = problem.energy(fraction, before, start)
            solution = find_equilibrium(total, u, system, stepping.criterion, problem.candidates, watch)
            if solution.result is not Result.CONVERGED:
                raise SolveError(solution.result.message)
            u = solution.u
        pair = problem.tangent(fraction, u, before.u, system).lowest()
        known[share] = u, pair
        return pair.eigenvalue

    with suppress(SolveError, ValueError):  # next to a singular state Newton's method may have no answer
        brentq(eigenvalue, 0.0, 1.0, xtol=_ONSET_TOLERANCE)
    if 1.0 not in known:
        eigenvalue(1.0)
    stable = max((share for share, (_, pair) in known.items() if pair.eigenvalue > 0.0), default=0.0)
    unstable = min((share for share, (_, pair) in known.items() if pair.eigenvalue <= 0.0), default=1.0)
    ends = [share for share in (stable, unstable) if share in known]
    nearest = min(ends, key=lambda share: abs(known[share][1].eigenvalue))
    low, high, at = (
        (start + share * (end - start)) * problem.config.growth.duration
        for share in (stable, unstable, nearest)
    )
    return make_onset(problem, at, (low, high), *known[nearest])


def make_onset(
    problem: Slice, growth_time: float, bracket: tuple[float, float], u: FloatArray, pair: Eigenpair
) -> Onset:
    """Onset of a state and its lowest eigenpair, with the wave that the mode is."""
    mode_number, wavelength = dominant_wave(problem.mesh, u, pair.vector)
    mode = outwards(problem, u, pair.vector)
    return Onset(growth_time, bracket, pair.eigenvalue, mode_number, wavelength, u, mode)


def outwards(problem: Slice, u: FloatArray, mode: FloatArray) -> FloatArray:
    """A mode with the sign by which its largest displacement normal to the contour points outwards."""
    normal = normal_displacement(problem.mesh, u, mode)
    # Among peaks that are equal but for rounding, the first one decides.
    peak = int(np.argmax(np.abs(normal) > (1.0 - 1e-6) * np.abs(normal).max()))
    return mode if normal[peak] >= 0.0 else -mode
