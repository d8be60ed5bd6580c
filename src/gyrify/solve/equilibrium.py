"""Newton's method for an equilibrium, stable or not: exact Hessian, never projected.

Unlike `gyrify.solve.newton.minimise` it stays on a smooth branch past the loss of stability. The full step
is damped until the residual falls; a Newton direction of the exact Hessian always allows that.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from gyrify.energy.total import TotalEnergy
from gyrify.errors import SolveError
from gyrify.solve.newton import SMALLEST_STEP, Criterion, Iterate
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
    at = Iterate.at(total, u, system)
    if not np.isfinite(at.value):
        return Solution(u, Result.INADMISSIBLE, np.inf, Stats())
    result, iteration = Result.MAX_NEWTON, 0
    while result is Result.MAX_NEWTON and iteration < criterion.max_iterations:
        watch()
        if at.residual <= criterion.force:
            result = Result.CONVERGED
            break
        iteration += 1
        try:
            evaluations = total.evaluate(at.u, project_psd=False)
            factor = system.factorise_data(system.assemble(evaluations, lambda at=at: candidates(at.u)))  # type: ignore[misc]
            du = system.scatter(-factor.solve(at.gradient))
        except SolveError:
            result = Result.SINGULAR
            break
        moved = _damped_step(total, at, du.reshape(u.shape), system)
        if moved is None:
            result = Result.LINE_SEARCH
            break
        at = moved
    work = Stats(iteration, system.factorizations - before[0], system.analyses - before[1])
    return Solution(at.u, result, at.residual, work)


def _damped_step(total: TotalEnergy, at: Iterate, du: FloatArray, system: System) -> Iterate | None:
    """First of ever shorter steps that lowers the residual."""
    size, step = float(np.linalg.norm(at.gradient)), total.max_step(at.u, du)
    while step >= SMALLEST_STEP:
        trial = Iterate.at(total, at.u + step * du, system)
        after = float(np.linalg.norm(trial.gradient))
        if np.isfinite(trial.value) and after <= (1.0 - _SUFFICIENT_DECREASE * step) * size:
            return trial
        step *= 0.5
    return None
