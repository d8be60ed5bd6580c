"""From an unstable equilibrium to a stable one: leave along the lowest mode, then descend in energy."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from gyrify.energy.total import TotalEnergy
from gyrify.errors import SolveError
from gyrify.solve.newton import Criterion, minimise
from gyrify.solve.result import Result, Stats
from gyrify.solve.stability import Tangent
from gyrify.solve.system import System
from gyrify.solve.types import FloatArray, IntArray

# First step along a mode over the largest allowed, and how often an equilibrium may be left in a row.
_FIRST_STEP = 1e-3
_DEPARTURES = 20
# A descent leads further than an increment does, and along a flat valley next to a bifurcation: it may take
# so many times the iterations.
_PATIENCE = 10


@dataclass(frozen=True, eq=False)
class Settled:
    """A stable equilibrium and the work that led to it.

    Attributes
    ----------
    u : (n_points, n_dim) float array
        Displacement [mm].
    residual : float
        Largest nodal force [Pa mm].
    departures : int
        How often an unstable equilibrium was left.
    stats : Stats
        Work done.
    """

    u: FloatArray
    residual: float
    departures: int
    stats: Stats


def settle(
    total: TotalEnergy,
    u: FloatArray,
    system: System,
    mass: FloatArray,
    criterion: Criterion,
    candidates: Callable[[FloatArray], IntArray],
    oriented: Callable[[FloatArray, FloatArray], FloatArray],
    size: float,
    watch: Callable[[], None] = lambda: None,
) -> Settled:
    """Leave an unstable equilibrium, and every one met on the way, until no pivot is negative.

    Parameters
    ----------
    total : TotalEnergy
        The energy, without dissipation.
    u : (n_points, n_dim) float array
        Equilibrium [mm].
    system : System
        Linear system of the free degrees of freedom.
    mass : (n_free,) float array
        Diagonal of M [mm^2].
    criterion : Criterion
        When the descent has converged.
    candidates : callable
        Couplings near a state, for the pattern.
    oriented : callable
        Gives a mode v at a state u, ``oriented(u, v)``, the side to leave to.
    size : float
        Largest displacement of a point by the first step [mm].
    watch : callable
        Called at each iteration; may raise to stop.

    Returns
    -------
    Settled

    Raises
    ------
    SolveError
        If no stable equilibrium is reached.
    """
    residual, stats = np.inf, Stats()
    patient = replace(criterion, max_iterations=_PATIENCE * criterion.max_iterations)
    for departures in range(_DEPARTURES + 1):
        tangent = _tangent(total, u, system, mass, candidates)
        if departures > 0 and tangent.is_stable:
            return Settled(u, residual, departures, stats)
        mode = oriented(u, tangent.lowest().vector)
        try:
            start = leave(total, u, mode, size)
        except SolveError:  # next to a singular state one side alone may lead down
            start = leave(total, u, -mode, size)
        solution = minimise(total, start, system, patient, candidates, watch, mass)
        u, residual, stats = solution.u, solution.residual, stats + solution.stats
        if solution.result is not Result.CONVERGED:
            raise _lost(f"the descent from it failed: {solution.result.message}", solution.result.advice)
    raise _lost(f"{_DEPARTURES} equilibria in a row were unstable", "Raise solver.increments.")


def _tangent(
    total: TotalEnergy,
    u: FloatArray,
    system: System,
    mass: FloatArray,
    candidates: Callable[[FloatArray], IntArray],
) -> Tangent:
    return Tangent(total.evaluate(u, project_psd=False), system, mass, lambda: candidates(u))


def leave(total: TotalEnergy, u: FloatArray, mode: FloatArray, size: float) -> FloatArray:
    """Lowest state along a mode, among ever longer steps for as long as they lower the energy.

    Parameters
    ----------
    total : TotalEnergy
        The energy, without dissipation.
    u : (n_points, n_dim) float array
        Unstable equilibrium [mm].
    mode : (n_points, n_dim) float array
        Direction of negative curvature, in any unit.
    size : float
        Largest displacement of a point [mm].

    Returns
    -------
    (n_points, n_dim) float array

    Raises
    ------
    SolveError
        If no step lowers the energy.
    """
    step = mode * (size / float(np.linalg.norm(mode, axis=1).max()))
    step = total.max_step(u, step) * step
    best, value = u, total.value(u)
    scale = _FIRST_STEP
    while scale <= 1.0:
        trial = u + scale * step
        lower = total.value(trial)
        if lower < value:
            best, value = trial, lower
        elif best is not u:
            break
        scale *= 2.0
    if best is u:
        raise _lost("no step along its lowest mode lowers the energy", "Tighten solver.tolerance.")
    return best


def _lost(reason: str, advice: str) -> SolveError:
    return SolveError(f"An unstable equilibrium could not be left for a stable one: {reason}.", advice)
