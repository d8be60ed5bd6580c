"""Newton's method for a minimum: exact Hessian, projected where its inertia is wrong, safe line search."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from gyrify.energy.term import Evaluation
from gyrify.energy.total import TotalEnergy
from gyrify.errors import SolveError
from gyrify.solve.linear import Factor
from gyrify.solve.result import Result, Solution, Stats
from gyrify.solve.shift import shifted_factor
from gyrify.solve.system import System
from gyrify.solve.types import FloatArray, IntArray

# Fraction of the linear decrease that a step must achieve, and the rounding of a sum over all cells.
SUFFICIENT_DECREASE = 1e-4
ROUNDING = 1e-14
SMALLEST_STEP = 1e-9


@dataclass(frozen=True)
class Criterion:
    """When to stop.

    Attributes
    ----------
    force : float
        Largest nodal force accepted as zero [Pa mm].
    max_iterations : int
        Iterations after which the solve has failed.
    """

    force: float
    max_iterations: int


def minimise(
    total: TotalEnergy,
    u: FloatArray,
    system: System,
    criterion: Criterion,
    candidates: Callable[[FloatArray], IntArray],
    watch: Callable[[], None] = lambda: None,
    mass: FloatArray | None = None,
) -> Solution:
    """Minimise the total energy from a starting state.

    Parameters
    ----------
    total : TotalEnergy
        What to minimise.
    u : (n_points, n_dim) float array
        Admissible starting state [mm].
    system : System
        Linear system of the free degrees of freedom.
    criterion : Criterion
        When to stop.
    candidates : callable
        Couplings near a state, for the pattern.
    watch : callable
        Called at each iteration; may raise to stop.
    mass : (n_free,) float array, optional
        Lumped area [mm^2]: an indefinite Hessian is then shifted by a multiple of it instead of projected,
        which is what leads along the flat valleys of a tissue that buckles without dissipation.

    Returns
    -------
    Solution
    """
    before = (system.factorizations, system.analyses)
    value = total.value(u)
    # MAX_NEWTON is what it comes to unless something else happens first.
    result, residual, iteration = Result.MAX_NEWTON, np.inf, 0
    if not np.isfinite(value):
        result = Result.INADMISSIBLE
    while result is Result.MAX_NEWTON:
        watch()
        evaluations = total.evaluate(u, project_psd=False)
        gradient = free_gradient(evaluations, system)
        residual = largest_force(gradient, system)
        if residual <= criterion.force:
            result = Result.CONVERGED
        if result is Result.CONVERGED or iteration == criterion.max_iterations:
            break
        iteration += 1
        try:
            du = _direction(total, u, evaluations, gradient, system, candidates, mass)
        except SolveError:
            result = Result.SINGULAR
            break
        slope = float(gradient @ du.ravel()[system.free])
        step, value, result = _line_search(total, u, du, value, slope)
        u = u + step * du
    work = Stats(iteration, system.factorizations - before[0], system.analyses - before[1])
    return Solution(u, result, residual, work)


def largest_force(gradient: FloatArray, system: System) -> float:
    """Largest Euclidean norm of the force on a free point [Pa mm]."""
    forces = np.zeros(system.n_dofs)
    forces[system.free] = gradient
    return float(np.sqrt(np.square(forces.reshape(-1, system.n_dim)).sum(axis=1).max()))


def free_gradient(evaluations: Sequence[Evaluation], system: System) -> FloatArray:
    """(n_free,) sum of the gradients of all terms [Pa mm]."""
    total = np.zeros(system.n_dofs)
    for evaluation in evaluations:
        if evaluation.gradient is not None:
            total += evaluation.gradient.ravel()
    return total[system.free]


def _direction(
    total: TotalEnergy,
    u: FloatArray,
    evaluations: Sequence[Evaluation],
    gradient: FloatArray,
    system: System,
    candidates: Callable[[FloatArray], IntArray],
    mass: FloatArray | None,
) -> FloatArray:
    """Newton direction of the exact Hessian, or of the projected or shifted one where that is indefinite."""
    data = system.assemble(evaluations, lambda: candidates(u))
    factor: Factor = system.factorise_data(data)
    if factor.n_negative > 0 and mass is not None:
        factor = shifted_factor(system, data, mass, growth=4.0)
    elif factor.n_negative > 0:
        factor = system.factorise(total.evaluate(u, project_psd=True), lambda: candidates(u))
    du = np.zeros(system.n_dofs)
    du[system.free] = -factor.solve(gradient)
    return du.reshape(u.shape)


def _line_search(
    total: TotalEnergy, u: FloatArray, du: FloatArray, value: float, slope: float
) -> tuple[float, float, Result]:
    """First step of a halving sequence that lowers the energy enough, its energy, and how to go on."""
    step = total.max_step(u, du)
    if step < SMALLEST_STEP:
        return 0.0, value, Result.BLOCKED
    noise = ROUNDING * abs(value)
    while step >= SMALLEST_STEP:
        trial = total.value(u + step * du)
        if trial <= value + SUFFICIENT_DECREASE * step * slope + noise:
            return step, trial, Result.MAX_NEWTON
        step *= 0.5
    return 0.0, value, Result.LINE_SEARCH
