"""Crossings of stability: the smooth branch scanned over a parameter, each change of inertia refined."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from itertools import pairwise

import numpy as np

from gyrify.config import Config
from gyrify.errors import SolveError
from gyrify.run.onset.crossing import LowestEigenvalue, limit_point
from gyrify.run.onset.mode_kinds import Wave, wave_of
from gyrify.run.onset.smooth import IDEAL, SmoothBranch, SmoothState, grown
from gyrify.threshold.crossings import Becomes, Crossing, Scanned
from gyrify.threshold.problems import Problems
from gyrify.threshold.scanned_parameter import Range

# The scan ends after so many values in a row without a smooth state.
_GIVE_UP = 3
_BISECTIONS = 8
# Halvings of the step between neighbours of the scan, before a state is followed in growth instead.
_HALVINGS = 3


class StabilityScan:
    """Inertia and lowest eigenvalue along the smooth branch over one parameter.

    Parameters
    ----------
    config : Config
        The other parameters; jitter and dissipation are set aside.
    parameter : str
        Key of the parameter.
    watch : callable
        Called at each Newton iteration; may raise to stop.
    """

    def __init__(self, config: Config, parameter: str, watch: Callable[[], None] = lambda: None) -> None:
        self._config, self._parameter, self._watch = config.with_overrides(IDEAL), parameter, watch
        # An object of its own: a bound method would keep this one, and its factors, in a cycle of references.
        self._problem_at = Problems(self._config, parameter)
        self.notes: list[str] = []
        self._branch: SmoothBranch
        self._lowest: LowestEigenvalue

    @property
    def evaluations(self) -> int:
        """Equilibria computed."""
        return len(self._branch.known)

    def scan(self, values: Sequence[float]) -> list[Scanned]:
        """Inertia at each value, as far as the smooth branch is found from either end of the range."""
        self._start(values)
        found = self._sweep(values)
        if len(found) < len(values):
            rest = self._sweep(values[: len(found) - 1 : -1])
            found += rest[::-1]
        scanned = self._approached(found)
        missing = [
            value for value in values if all(p.value != value or p.n_negative is None for p in scanned)
        ]
        if missing:
            shown = ", ".join(f"{value:.5g}" for value in missing[:5]) + (" …" if len(missing) > 5 else "")
            self.notes.append(
                f"No smooth state is found at {shown}: it ends, folds without a bifurcation, or the mesh "
                "is too coarse to tell."
            )
        return scanned

    def _sweep(self, values: Sequence[float]) -> list[Scanned]:
        """Points in turn, until too many in a row have no smooth state."""
        points: list[Scanned] = []
        for value in values:
            points.append(self._point(value))
            if len(points) >= _GIVE_UP and all(p.n_negative is None for p in points[-_GIVE_UP:]):
                break
        return points

    def _approached(self, points: Sequence[Scanned]) -> list[Scanned]:
        """The points, and those tried between one that is known and a missing one, to see how it ends."""
        scanned = list(points[:1])
        for before, after in pairwise(points):
            if before.n_negative == 0 and after.n_negative is None:
                scanned += self._bisected(before, after)
            if before.n_negative is None and after.n_negative == 0:
                scanned += self._bisected(after, before)[::-1]
            scanned.append(after)
        return scanned

    def _bisected(self, stable: Scanned, missing: Scanned) -> list[Scanned]:
        """Stable states ever closer to a missing one, up to an unstable one between them."""
        near, far, found = stable.value, missing.value, []
        for _ in range(_BISECTIONS):
            point = self._point(0.5 * (near + far))
            if point.n_negative is None:
                far = point.value
                continue
            found.append(point)
            near = point.value
            if point.n_negative > 0:
                break
        return found

    def _point(self, value: float) -> Scanned:
        state = self._state(value)
        if state is None:
            return Scanned(value)
        self._note_contact(state)
        return Scanned(value, state.tangent(self._system).n_negative)

    def _state(self, value: float) -> SmoothState | None:
        """Smooth state from its neighbours, or else followed in growth; None where neither finds it."""
        for find in (lambda at: self._branch.at(at, _HALVINGS), self._grown_at):
            with suppress(SolveError):
                state = find(value)
                if not state.is_folded:
                    self._branch.known[value] = state
                    return state
                del self._branch.known[value]
        return None

    def _grown_at(self, value: float) -> SmoothState:
        problem, fraction = self._problem_at(value)
        state = SmoothState(value, problem, fraction, grown(problem, self._system, fraction, self._watch).u)
        self._branch.known[value] = state
        return state

    def _note_contact(self, state: SmoothState) -> None:
        if state.is_in_contact and not any("Contact" in note for note in self.notes):
            self.notes.append(f"Contact acts on the smooth branch from {state.value:.6g} on.")

    def crossing(self, below: Scanned, above: Scanned, tolerance: float) -> Crossing:
        """Where the lowest eigenvalue vanishes between two points of the scan."""
        was_unstable = bool(below.n_negative)
        root = self._lowest.root(below.value, above.value, tolerance * above.value, was_unstable)
        low, high = root.bracket
        if not root.is_refined and high - low > tolerance * above.value:
            self.notes.append(f"The crossing between {low:.6g} and {high:.6g} is not known more closely.")
        becomes: Becomes = "stable" if was_unstable else "unstable"
        wave = wave_of(root.state.problem.mesh, root.state.u, root.pair.vector)
        return self._crossing(root.value, becomes, root.bracket, wave)

    def _crossing(self, value: float, becomes: Becomes, bracket: Range, wave: Wave) -> Crossing:
        time = value if self._parameter == "growth.time" else self._config.growth.duration
        return Crossing(value, becomes, bracket, wave.mode_number, wave.wavelength or None, time, wave.kind)

    def ends(self, scanned: Sequence[Scanned]) -> list[Crossing]:
        """Where the smooth state of a body in space ends, stable, as its lowest eigenvalue vanishes.

        See `gyrify.run.onset.crossing.limit_point`.
        """
        if self._config.geometry.n_dim == 2:
            return []
        pairs = [(before, after) for before, after in pairwise(scanned) if before.n_negative == 0]
        back = [(after, before) for before, after in pairwise(scanned) if after.n_negative == 0]
        found = (self._end(stable.value, other.value) for stable, other in (*pairs, *back) if _missing(other))
        return [crossing for crossing in found if crossing is not None]

    def _end(self, stable: float, missing: float) -> Crossing | None:
        """The limit point between a stable state and a value without one, if the last two states tell it."""
        side = [v for v in self._branch.known if (v - stable) * (missing - stable) <= 0.0]
        before = min((v for v in side if v != stable), key=lambda v: abs(v - stable), default=None)
        if before is None:
            return None
        with suppress(SolveError):
            value = limit_point(before, stable, self.eigenvalue(before), self.eigenvalue(stable))
            if value is None or abs(value - stable) > abs(missing - stable):
                return None
            self.notes.append(
                f"The smooth state ends at {value:.6g}: its lowest eigenvalue vanishes there as at a limit "
                "point, since the mesh is less symmetric than the body. A finer mesh moves it."
            )
            bracket = (min(stable, missing), max(stable, missing))
            becomes: Becomes = "unstable" if stable < missing else "stable"
            state, mode = self._branch.known[stable], self._lowest.pairs[stable].vector
            return self._crossing(value, becomes, bracket, wave_of(state.problem.mesh, state.u, mode))
        return None

    def eigenvalue(self, value: float) -> float:
        """Lowest eigenvalue at a value of the parameter [Pa/mm^2]."""
        return self._lowest.at(value)

    def _start(self, values: Sequence[float]) -> None:
        """First state of the branch, followed in growth: at the lowest value, or else at the highest."""
        for value in (values[0], values[-1]):
            problem, fraction = self._problem_at(value)
            self._system = problem.system(np.empty((0, 2), dtype=np.int64))
            try:
                u = grown(problem, self._system, fraction, self._watch).u
            except SolveError:
                if value == values[-1]:
                    raise
                continue
            start = SmoothState(value, problem, fraction, u)
            self._branch = SmoothBranch(self._problem_at, start, self._system, self._watch)
            self._lowest = LowestEigenvalue(self._branch, self._system)
            return


def _missing(point: Scanned) -> bool:
    return point.n_negative is None
