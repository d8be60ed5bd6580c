"""The smooth branch of equilibria, stable or not, followed in growth and in a parameter."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from gyrify.errors import SolveError
from gyrify.model.slice import Slice
from gyrify.run.onset.visible_time import VISIBLE, visible_index
from gyrify.solve.equilibrium import find_equilibrium
from gyrify.solve.newton import Criterion
from gyrify.solve.result import Result
from gyrify.solve.stability import Tangent
from gyrify.solve.system import System
from gyrify.solve.types import FloatArray

# Stability is defined on the smooth branch: without what would disturb or delay the loss of it.
IDEAL: Final = {"mesh.node_jitter": 0.0, "dissipation.kind": "none", "stability.follow_branch": False}

# Growth is followed in this many steps at first. Where Newton's method needs more iterations, or corrects the
# prediction by more than this share of the step, the state may be on another branch: the step is halved.
GROWTH_STEPS = 8
_ITERATIONS = 10
_CORRECTION = 0.5
_HALVINGS = 7
# The prediction is the polynomial through so many known states at most.
_POINTS = 4


@dataclass(frozen=True, eq=False)
class SmoothState:
    """An equilibrium on the smooth branch.

    Attributes
    ----------
    value : float
        Value of the parameter that the branch is followed in.
    problem : Slice
        The tissue there.
    fraction : float
        Growth time over the duration of growth.
    u : (n_points, n_dim) float array
        Displacement [mm].
    """

    value: float
    problem: Slice
    fraction: float
    u: FloatArray

    @property
    def is_in_contact(self) -> bool:
        """Whether the contact barrier acts."""
        if not self.problem.config.contact.enabled:
            return False
        return any(term.evaluate(self.u, 0).value > 0.0 for term in self.problem.contacts(self.u))

    @property
    def is_folded(self) -> bool:
        """Whether folds are seen: the branch has then veered away from the smooth one."""
        points = self.problem.mesh.points + self.u[: self.problem.mesh.n_points]
        return visible_index(self.problem.mesh, points, self.problem.config.metrics) > VISIBLE

    def tangent(self, system: System) -> Tangent:
        """Exact stiffness of the state."""
        return self.problem.tangent(self.fraction, self.u, self.u, system)


class SmoothBranch:
    """Equilibria over one parameter, each found from its neighbours by Newton's method on the residual.

    Parameters
    ----------
    problem_at : callable
        Tissue and growth fraction of a value of the parameter.
    start : SmoothState
        A known state of the branch.
    system : System
        Linear system, shared by all states.
    watch : callable
        Called at each iteration; may raise to stop.
    """

    def __init__(
        self,
        problem_at: Callable[[float], tuple[Slice, float]],
        start: SmoothState,
        system: System,
        watch: Callable[[], None] = lambda: None,
    ) -> None:
        self._problem_at, self._system, self._watch = problem_at, system, watch
        self.known = {start.value: start}

    def at(self, value: float, halvings: int = _HALVINGS) -> SmoothState:
        """State at a value of the parameter.

        Raises
        ------
        SolveError
            If it is not found, however small the steps towards it, or no state is left to start from.
        """
        if value in self.known:
            return self.known[value]
        if not self.known:
            raise SolveError(
                f"No smooth state is known to reach {value:.6g} from: every one that was found is folded.",
                "Refine the mesh (mesh.refine = 1): on a coarse one the smooth state may fold gradually.",
            )
        near = min(self.known.values(), key=lambda state: abs(state.value - value))
        state = self._try(value, near)
        if state is None:
            if halvings == 0:
                raise SolveError(
                    f"The smooth state is lost between {near.value:.6g} and {value:.6g}.",
                    "Narrow the range, or refine the mesh (mesh.refine = 1).",
                )
            self.at(0.5 * (near.value + value), halvings - 1)
            return self.at(value, halvings - 1)
        self.known[value] = state
        return state

    def _try(self, value: float, near: SmoothState) -> SmoothState | None:
        """State found from a prediction, if it is plainly on the same branch."""
        problem, fraction = self._problem_at(value)
        guess = self._predict(value, near)
        step = float(np.abs(guess - near.u).max())
        criterion = Criterion(problem.stepping.criterion.force, _ITERATIONS)
        total = problem.tissue_energy(fraction, near.u)
        solution = find_equilibrium(total, guess, self._system, criterion, problem.candidates, self._watch)
        if solution.result is not Result.CONVERGED:
            return None
        allowed = _CORRECTION * max(step, 0.1 * problem.config.geometry.cortical_thickness)
        if len(self.known) > 1 and float(np.abs(solution.u - guess).max()) > allowed:
            return None
        return SmoothState(value, problem, fraction, solution.u)

    def _predict(self, value: float, near: SmoothState) -> FloatArray:
        """Displacement on the polynomial through the nearest known states that are not too close together."""
        distance = abs(value - near.value)
        taken = [near.value]
        for other in sorted(self.known, key=lambda v: abs(v - value)):
            if len(taken) < _POINTS and min(abs(other - v) for v in taken) >= 0.5 * distance:
                taken.append(other)
        u = np.zeros_like(near.u)
        for v in taken:
            weight = np.prod([(value - other) / (v - other) for other in taken if other != v])
            u += float(weight) * self.known[v].u
        return u


def grown(
    problem: Slice, system: System, fraction: float = 1.0, watch: Callable[[], None] = lambda: None
) -> SmoothState:
    """Smooth state of a tissue at a growth fraction, followed from the reference state.

    Raises
    ------
    SolveError
        If the smooth branch is lost on the way.
    """
    reference = SmoothState(0.0, problem, 0.0, np.zeros(problem.state_shape))
    branch = SmoothBranch(lambda time: (problem, time), reference, system, watch)
    state = reference
    for share in np.linspace(0.0, 1.0, GROWTH_STEPS + 1)[1:]:
        state = branch.at(float(share * fraction))
    return replace(state, value=fraction)
