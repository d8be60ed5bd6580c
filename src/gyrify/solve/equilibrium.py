"""Newton's method for an equilibrium, stable or not: exact Hessian, never projected.

Unlike `gyrify.solve.newton.minimise` it stays on a smooth branch past the loss of stability. The full step
is damped until the residual falls; a Newton direction of the exact Hessian always allows that.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from gyrify.energy.term import Evaluation
from gyrify.energy.total import TotalEnergy
from gyrify.errors import SolveError
from gyrify.solve.newton import SMALLEST_STEP, Criterion, free_gradient, largest_force
from gyrify.solve.result import Result, Solution, Stats
from gyrify.solve.system import System
from gyrify.solve.types import FloatArray, IntArray

# The residual must fall by this fraction of the step.
_SUFFICIENT_DECREASE = 1e-4


def find_equilibrium(
    total: TotalEnergy,
    u: FloatArray,
    system: System,
    criterion: Criterion,
    candidates: Callable[[FloatArray], IntArray],
    watch: Callable[[], None] = lambda: None,
) -> Solution:
    """Find the equilibrium that a starting state leads to.

    Parameters
    ----------
    total : TotalEnergy
        Whose gradient is to vanish.
    u : (n_points, n_dim) float array
        Admissible state near the equilibrium [mm].
    system : System
        Linear system of the free degrees of freedom.
    criterion : Criterion
        When to stop.
    candidates : callable
        Couplings near a state, for the pattern.
    watch : callable
        Called at each iteration; may raise to stop.

    Returns
    -------
    Solution
    """
    before = (system.factorizations, system.analyses)
    if not np.isfinite(total.value(u)):
        return Solution(u, Result.INADMISSIBLE, np.inf, Stats())
    evaluations = total.evaluate(u, project_psd=False)
    gradient = free_gradient(evaluations, system)
    result, iteration = Result.MAX_NEWTON, 0
    while result is Result.MAX_NEWTON and iteration < criterion.max_iterations:
        watch()
        if largest_force(gradient, system) <= criterion.force:
            result = Result.CONVERGED
            break
        iteration += 1
        try:
            factor = system.factorise_data(system.assemble(evaluations, lambda u=u: candidates(u)))  # type: ignore[misc]
            du = np.zeros(system.n_dofs)
            du[system.free] = -factor.solve(gradient)
        except SolveError:
            result = Result.SINGULAR
            break
        moved = _damped_step(total, u, du.reshape(u.shape), gradient, system)
        if moved is None:
            result = Result.LINE_SEARCH
            break
        u, evaluations, gradient = moved
    work = Stats(iteration, system.factorizations - before[0], system.analyses - before[1])
    return Solution(u, result, largest_force(gradient, system), work)


def _damped_step(
    total: TotalEnergy, u: FloatArray, du: FloatArray, gradient: FloatArray, system: System
) -> tuple[FloatArray, list[Evaluation], FloatArray] | None:
    """State, evaluations and gradient after the first of ever shorter steps that lowers the residual."""
    size, step = float(np.linalg.norm(gradient)), total.max_step(u, du)
    while step >= SMALLEST_STEP:
        trial = u + step * du
        evaluations = total.evaluate(trial, project_psd=False)
        if all(np.isfinite(e.value) for e in evaluations):
            after = free_gradient(evaluations, system)
            if float(np.linalg.norm(after)) <= (1.0 - _SUFFICIENT_DECREASE * step) * size:
                return trial, evaluations, after
        step *= 0.5
    return None
