"""Onset of folding: the smooth equilibrium of the tissue followed in growth, and every change of stability.

The equilibrium is that of the slice without node jitter and dissipation, whatever the run itself has. A state
that drag holds back is none: along a rotation its stiffness holds the virial of the unbalanced force, which
is negative without any fold being near.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from gyrify.errors import SolveError
from gyrify.model.slice import Slice
from gyrify.run.onset.crossing import LowestEigenvalue, Root, limit_point
from gyrify.run.onset.mode_kinds import outwards, wave_of
from gyrify.run.onset.smooth import IDEAL, SmoothBranch, SmoothState
from gyrify.solve.stability import Onset, StabilityChange
from gyrify.solve.types import FloatArray

# Growth is looked at so many times, evenly spaced.
MARKS: Final = 16
# Tolerance of the onset, as a fraction of the duration of growth.
_TOLERANCE: Final = 1e-5
# Halvings of the step between two looks: past the loss of stability the branch is given up at once.
_HALVINGS, _HALVINGS_UNSTABLE = 6, 0


class OnsetSearch:
    """Follows the smooth branch from look to look.

    What it finds depends on the configuration alone, not on the run, nor on where that was taken up.

    Parameters
    ----------
    problem : Slice
        The slice of the run.
    watch : callable
        Called at each iteration; may raise to stop.

    Attributes
    ----------
    onset : Onset or None
        The first loss of stability, once it is passed.
    changes : list of StabilityChange
        Every change of stability passed, in order.
    mark : int
        Looks done: growth has been followed to the fraction ``mark / MARKS``.
    lost_at : float or None
        Growth time at which the smooth branch ends, or folds by degrees; None while it goes on.
    """

    def __init__(self, problem: Slice, watch: Callable[[], None] = lambda: None) -> None:
        self._mesh, self._duration = problem.mesh, problem.config.growth.duration
        ideal = problem.config.with_overrides(IDEAL)
        is_perfect = problem.config.mesh.node_jitter == 0.0
        # A name of its own: a reference to this object would keep the factors until a collection of cycles.
        perfect = problem.varied(ideal) if is_perfect else Slice(ideal)
        perfect.contact_library = problem.contact_library
        perfect.use_linear_solver(problem.linear_solver)
        self._problem = perfect
        self.onset: Onset | None = None
        self.changes: list[StabilityChange] = []
        self.mark, self.lost_at = 0, None  # type: tuple[int, float | None]
        system = self._problem.system(np.empty((0, 2), dtype=np.int64))
        start = SmoothState(0.0, self._problem, 0.0, np.zeros(self._problem.state_shape))
        self._branch = SmoothBranch(lambda fraction: (perfect, fraction), start, system, watch)
        self._lowest = LowestEigenvalue(self._branch, system)
        self._last, self._n_negative = start, 0

    def follow(self, fraction: float) -> None:
        """Follow the branch up to the last look at or before a fraction of growth."""
        while self.lost_at is None and (self.mark + 1) / MARKS <= fraction:
            self.mark += 1
            self._look(self.mark / MARKS)

    def onset_by(self, fraction: float) -> Onset | None:
        """The onset, looked for up to a fraction of growth that need not be one of the looks."""
        self.follow(fraction)
        if self.onset is None and self.lost_at is None:
            self._look(fraction)
        return self.onset

    def _look(self, fraction: float) -> None:
        halvings = _HALVINGS if self._n_negative == 0 else _HALVINGS_UNSTABLE
        has_ended = True
        try:
            state = self._branch.at(fraction, halvings)
            if state.is_folded:
                raise SolveError("The smooth branch has folded.", "")
            has_ended = False  # modes that are not found say nothing of the branch
            tangent = state.tangent(self._lowest.system)
            before, self._n_negative = self._n_negative, tangent.n_negative
            if before != self._n_negative:
                self.changes.append(self._change(state, before))
            self._last = state
        except SolveError:
            self.lost_at = self._last.fraction * self._duration
            if has_ended and self.onset is None and self._n_negative == 0 and self._mesh.n_dim == 3:
                self._end_at_limit_point(fraction)

    def _end_at_limit_point(self, failed: float) -> None:
        """Take the end of a stable branch as the onset, if its lowest eigenvalue vanishes there."""
        known = sorted(self._branch.known)
        if len(known) < 2:
            return
        before, last = known[-2:]
        try:
            if self._lowest.at(last) <= 0.0:  # it was lost on the way to where there is no state
                state = self._branch.at(last)
                self._n_negative = state.tangent(self._lowest.system).n_negative
                self.changes.append(self._change(state, 0))
                return
            value = limit_point(before, last, self._lowest.at(before), self._lowest.at(last))
        except SolveError:
            return
        if value is not None and value < failed:
            root = Root(value, (last, failed), self._branch.at(last), self._lowest.pairs[last], False)
            self.onset = self._onset(root)
            wave, time = self.onset, self._duration
            self.changes.append(
                StabilityChange(
                    value * time, wave.bracket, 0, 1, wave.kind, wave.mode_number, wave.wavelength
                )
            )

    def _change(self, state: SmoothState, before: int) -> StabilityChange:
        """What happened since the last look."""
        low, high, after = self._last.fraction, state.fraction, self._n_negative
        if before == 0 or after == 0:
            root = self._lowest.root(low, high, _TOLERANCE, was_unstable=before > 0)
            if self.onset is None:
                self.onset = self._onset(root)
            value, bracket, at, vector = root.value, root.bracket, root.state, root.pair.vector
        else:
            value, bracket = 0.5 * (low + high), (low, high)
            at = state if after > before else self._last
            vector = at.tangent(self._lowest.system).latest().vector
        wave = wave_of(self._problem.mesh, at.u, vector)
        time = self._duration
        ends = (bracket[0] * time, bracket[1] * time)
        return StabilityChange(
            value * time, ends, before, after, wave.kind, wave.mode_number, wave.wavelength
        )

    def _onset(self, root: Root) -> Onset:
        state, time = root.state, self._duration
        mesh, vector = self._problem.mesh, root.pair.vector
        wave = wave_of(mesh, state.u, vector)
        return Onset(
            growth_time=root.value * time,
            bracket=(root.bracket[0] * time, root.bracket[1] * time),
            eigenvalue=root.pair.eigenvalue,
            mode_number=wave.mode_number,
            wavelength=wave.wavelength,
            displacement=self._from_own_points(state.u),
            vector=outwards(mesh, state.u, vector),
            kind=wave.kind,
        )

    def _from_own_points(self, u: FloatArray) -> FloatArray:
        """Displacement to the same place from the points of the run's own mesh, jitter included."""
        moved = u.copy()
        moved[: self._mesh.n_points] += self._problem.mesh.points - self._mesh.points
        return moved
