r"""Increments of a stored run, evaluated again from the states alone.

At fixed displacement, growth changes the energy that is stored in the tissue and in its surroundings: that is
the work of growth W. The rest of the change is done against the forces f of dissipation, because the states
are in equilibrium, so that over an increment

.. math::
   \Delta E_{stored} + \Delta E_{contact} + \Delta E_{external} + D = W, \quad
   W = \int \left.\frac{\partial (E_{stored} + E_{external})}{\partial t}\right|_u dt, \quad
   D = \int f \cdot du .

Terms are summed by their role (`gyrify.model.terms`), so that none can be taken for another.

W is integrated by Simpson's rule along the straight path from state to state, D by the trapezoidal rule; the
defect falls with the square of the increments while the path is smooth. Where the tissue jumps, energy is
lost that slow dissipation does not account for; none may ever be created. Kelvin-Voigt dissipation that goes
with growth at fixed displacement is on neither side.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from gyrify.model.slice import Slice
from gyrify.model.terms import ROLES, GrowthStep, Role, terms_of
from gyrify.solve.problem import State
from gyrify.solve.types import FloatArray
from gyrify.store.history import History

# Half the fraction of growth over which the power of growth is differenced.
_DIFFERENCE: Final = 1e-4


@dataclass(frozen=True)
class Increment:
    """What one increment shows when it is evaluated again.

    Attributes
    ----------
    residual, stored_residual : float
        Largest nodal force, recomputed and as recorded [Pa mm].
    rise : float
        Change of the energy that was minimised, from the start, over that energy; never positive.
    min_J, min_J_elastic : float
        Smallest J and J_e over the whole of its cells [-].
    smallest_cell, smallest_elastic_cell : int
        The cells that have them.
    is_path_free : bool
        Whether the contour crosses itself nowhere on the straight path to here; true without contact.
    stored, contact, external : float
        Changes of energy: stored in the tissue, in contact, in the surroundings [Pa mm^2].
    dissipated : float
        Work done against dissipation [Pa mm^2].
    work, work_error : float
        Work of growth, and how far the trapezoidal rule is from Simpson's [Pa mm^2].
    """

    residual: float
    stored_residual: float
    rise: float
    min_J: float
    min_J_elastic: float
    smallest_cell: int
    smallest_elastic_cell: int
    is_path_free: bool
    stored: float
    contact: float
    external: float
    dissipated: float
    work: float
    work_error: float

    @property
    def defect(self) -> float:
        """Energy that appeared from nowhere; negative if it was lost."""
        return self.stored + self.contact + self.external + self.dissipated - self.work


def reevaluated(history: History) -> Iterator[Increment]:
    """Evaluate every increment of a run again, from the stored states."""
    problem, fractions = history.slice, history.fractions
    before = history.journal.state(0)
    power, force = _growth_power(problem, 0.0, before.u, before.internal), np.zeros_like(before.u)
    for number in range(1, len(history)):
        after, span = history.journal.state(number), (float(fractions[number - 1]), float(fractions[number]))
        increment, power, force = _evaluate(problem, before, after, span, power, force)
        yield increment
        before = after


def _evaluate(
    problem: Slice, before: State, after: State, span: tuple[float, float], power: float, force: FloatArray
) -> tuple[Increment, float, FloatArray]:
    """One increment; ``power`` of growth and ``force`` of dissipation are those at its start, then end."""
    step = GrowthStep(problem, before.u, *span, before.internal)
    duration = problem.config.growth.duration
    at_start = _growing(problem, span[0], before.u, before.internal)
    gradient, force_after = np.zeros_like(after.u), np.zeros_like(after.u)
    change: dict[Role, float] = dict.fromkeys(ROLES, 0.0)
    rise = scale = 0.0
    for kind, term in terms_of(step):
        end, start = term.evaluate(after.u, 1), term.evaluate(before.u, 0).value
        if end.gradient is not None:
            gradient += end.gradient
            force_after += end.gradient if kind.role == "dissipative" else 0.0
        rise += end.value - start
        scale += abs(start)
        change[kind.role] += end.value - at_start.get(kind.name, start)
    relaxed = _relaxed(problem, span[1], before, after)
    gradient.ravel()[problem.held] = 0.0
    J, J_e = problem.least_volume_ratios(after.u, span[1] * duration)
    power_after = _growth_power(problem, span[1], after.u, after.internal)
    work, work_error = _growth_work(problem, before, after, span, (power, power_after))
    return (
        Increment(
            residual=float(np.linalg.norm(gradient, axis=1).max()),
            stored_residual=after.residual,
            rise=rise / scale if scale > 0.0 else 0.0,
            min_J=float(J.min()),
            min_J_elastic=float(J_e.min()),
            smallest_cell=int(J.argmin()),
            smallest_elastic_cell=int(J_e.argmin()),
            is_path_free=problem.is_path_admissible(before.u, after.u),
            stored=change["stored"] - relaxed,
            contact=change["contact"],
            external=change["external"],
            dissipated=relaxed + float(0.5 * np.sum((force + force_after) * (after.u - before.u))),
            work=work,
            work_error=work_error,
        ),
        power_after,
        force_after,
    )


def _growing(
    problem: Slice, fraction: float, u: FloatArray, internal: Mapping[str, FloatArray]
) -> dict[str, float]:
    """Energy of each term that growth changes at fixed displacement, by name [Pa mm^2]."""
    terms = terms_of(GrowthStep(problem, u, fraction, fraction, internal), ("stored", "external"))
    return {kind.name: term.evaluate(u, 0).value for kind, term in terms}


def _relaxed(problem: Slice, fraction: float, before: State, after: State) -> float:
    """Energy that a change of the internal variables lets go at fixed displacement [Pa mm^2]."""
    if not after.internal:
        return 0.0
    held, free = (_growing(problem, fraction, after.u, state.internal) for state in (before, after))
    return sum(held.values()) - sum(free.values())


def _growth_power(
    problem: Slice, fraction: float, u: FloatArray, internal: Mapping[str, FloatArray]
) -> float:
    """Change of energy with growth at fixed displacement, per fraction of growth [Pa mm^2]."""
    early, late = (
        sum(_growing(problem, fraction + step, u, internal).values()) for step in (-_DIFFERENCE, _DIFFERENCE)
    )
    return (late - early) / (2.0 * _DIFFERENCE)


def _growth_work(
    problem: Slice, before: State, after: State, span: tuple[float, float], powers: tuple[float, float]
) -> tuple[float, float]:
    """Work of growth by Simpson's rule, and how far it is from that of the trapezoidal rule."""
    length, trapezoid = span[1] - span[0], 0.5 * (powers[0] + powers[1])
    halfway = 0.5 * (before.u + after.u)
    middle = _growth_power(problem, 0.5 * (span[0] + span[1]), halfway, before.internal)
    if not math.isfinite(middle):
        return length * trapezoid, math.inf
    simpson = (2.0 * trapezoid + 4.0 * middle) / 6.0
    return length * simpson, length * abs(simpson - trapezoid)
