"""Newton's method for a minimum: exact Hessian, projected where its inertia is wrong, safe line search."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gyrify.energy.total import TotalEnergy
from gyrify.errors import SolveError
from gyrify.solve.definite import DefiniteHessian
from gyrify.solve.iterative.inexact import InexactHessian
from gyrify.solve.iterative.krylov import ConjugateGradients
from gyrify.solve.quasi_newton import STEPS, QuasiNewton
from gyrify.solve.result import Result, Solution, Stats
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


@dataclass(frozen=True, eq=False)
class Iterate:
    """A state with its energy and the forces on it.

    Attributes
    ----------
    u : (n_points, n_dim) float array
        Displacement [mm].
    value : float
        Total energy [Pa mm^2]; infinite where not admissible.
    gradient : (n_unknowns,) float array
        Its gradient [Pa mm].
    residual : float
        Largest nodal force [Pa mm].
    """

    u: FloatArray
    value: float
    gradient: FloatArray
    residual: float

    @staticmethod
    def at(total: TotalEnergy, u: FloatArray, system: System) -> Iterate:
        """Evaluate a state."""
        value, gradient = total.slope(u)
        residual = system.largest_force(gradient) if np.isfinite(value) else np.inf
        return Iterate(u, value, system.gather(gradient), residual)


def minimise(
    total: TotalEnergy,
    start: FloatArray | Iterate,
    system: System,
    criterion: Criterion,
    candidates: Callable[[FloatArray], IntArray],
    watch: Callable[[], None] = lambda: None,
    mass: FloatArray | None = None,
    model: QuasiNewton | None = None,
) -> Solution:
    """Minimise the total energy from a starting state.

    Parameters
    ----------
    total : TotalEnergy
        What to minimise.
    start : (n_points, n_dim) float array or Iterate
        Admissible starting state [mm], evaluated already or not.
    system : System
        Linear system of the free degrees of freedom.
    criterion : Criterion
        When to stop.
    candidates : callable
        Couplings near a state, for the pattern.
    watch : callable
        Called at each iteration; may raise to stop.
    mass : (n_unknowns,) float array, optional
        Lumped area [mm^2]: an indefinite Hessian is then shifted by a multiple of it instead of projected,
        which is what leads along the flat valleys of a tissue that buckles without dissipation.
    model : QuasiNewton, optional
        A factor from before to begin with; left with the latest one.

    Returns
    -------
    Solution
    """
    before = (system.factorizations, system.analyses)
    at = start if isinstance(start, Iterate) else Iterate.at(total, start, system)
    model = model or QuasiNewton(0 if isinstance(system.solver, ConjugateGradients) else STEPS)
    hessian = _hessian(total, system, criterion, candidates, watch, mass)
    # MAX_NEWTON is what it comes to unless something else happens first.
    result, iteration = Result.MAX_NEWTON if np.isfinite(at.value) else Result.INADMISSIBLE, 0
    while result is Result.MAX_NEWTON:
        watch()
        if at.residual <= criterion.force:
            result = Result.CONVERGED
        if result is Result.CONVERGED or iteration == criterion.max_iterations:
            break
        iteration += 1
        is_old = model.serves(at.residual, criterion.force)
        at, result = _step(total, at, model, system, None if is_old else hessian)
        if is_old and result is not Result.MAX_NEWTON:
            # an old factor may fail where a new one does not
            model.renew(None)
            result = Result.MAX_NEWTON
    work = Stats(iteration, system.factorizations - before[0], system.analyses - before[1])
    return Solution(at.u, result, at.residual, work)


def _hessian(
    total: TotalEnergy,
    system: System,
    criterion: Criterion,
    candidates: Callable[[FloatArray], IntArray],
    watch: Callable[[], None],
    mass: FloatArray | None,
) -> DefiniteHessian | InexactHessian:
    """What gives descent directions: factors, or conjugate gradients where the system is solved by them."""
    solver = system.solver
    if isinstance(solver, ConjugateGradients):
        return InexactHessian(total, system, solver, candidates, mass, criterion.force, watch)
    return DefiniteHessian(total, system, candidates, mass)


def _step(
    total: TotalEnergy,
    at: Iterate,
    model: QuasiNewton,
    system: System,
    hessian: DefiniteHessian | InexactHessian | None,
) -> tuple[Iterate, Result]:
    """Step along the model's direction, with a new factor of a Hessian if given; the model learns from it."""
    try:
        if hessian is not None:
            # even one that fails takes the old one's place in the solver
            model.renew(None)
            model.renew(hessian.factor(at.u))
        direction = model.direction(at.gradient)
    except SolveError:
        return at, Result.SINGULAR
    step, after, result = _line_search(total, at, direction, system)
    if result is Result.MAX_NEWTON:
        # a shortened step says nothing of the next one
        contraction = min(1.0, after.residual / at.residual) if step == 1.0 else 1.0
        model.learn(step * direction, after.gradient - at.gradient, contraction)
    return after, result


def _line_search(
    total: TotalEnergy, at: Iterate, direction: FloatArray, system: System
) -> tuple[float, Iterate, Result]:
    """First step of a halving sequence that lowers the energy enough, where it leads, and how to go on."""
    # not a product of BLAS, whose sums depend on the number of threads
    slope = float(np.einsum("i,i->", at.gradient, direction))
    if not slope < 0.0:  # a negative pivot next to zero was overlooked
        return 0.0, at, Result.LINE_SEARCH
    du = system.scatter(direction).reshape(at.u.shape)
    step = total.max_step(at.u, du)
    if step < SMALLEST_STEP:
        return 0.0, at, Result.BLOCKED if total.limiting(at.u, du).is_barrier else Result.INVERTING
    noise = ROUNDING * abs(at.value)
    while step >= SMALLEST_STEP:
        trial = Iterate.at(total, at.u + step * du, system)
        if trial.value <= at.value + SUFFICIENT_DECREASE * step * slope + noise:
            return step, trial, Result.MAX_NEWTON
        step *= 0.5
    return 0.0, at, Result.LINE_SEARCH
