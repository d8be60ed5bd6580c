"""What a state that dissipation holds back becomes once growth stops: a stable equilibrium downhill."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np

from gyrify.metrics import Measures
from gyrify.model.slice import Slice
from gyrify.run.body_measures import measured
from gyrify.solve.newton import minimise
from gyrify.solve.relaxation import KEPT, Relaxation
from gyrify.solve.result import Result
from gyrify.solve.types import FloatArray

# Newton iterations allowed, over those of an increment.
_PATIENCE: Final = 10


def relax(
    problem: Slice, fraction: float, u: FloatArray, watch: Callable[[], None] = lambda: None
) -> Relaxation | None:
    """Let go of a state: minimise the energy of elasticity and contact from there.

    Parameters
    ----------
    problem : Slice
        The tissue.
    fraction : float
        Growth time over the duration of growth.
    u : (n_points, n_dim) float array
        The state [mm].
    watch : callable
        Called at each iteration; may raise to stop.

    Returns
    -------
    Relaxation or None
        None if no equilibrium is found.
    """
    criterion = problem.stepping.criterion
    patient = replace(criterion, max_iterations=_PATIENCE * criterion.max_iterations)
    system, total = problem.system(np.empty((0, 2), dtype=np.int64)), problem.tissue_energy(fraction, u)
    solution = minimise(total, u, system, patient, problem.candidates, watch, problem.free_mass)
    if solution.result is not Result.CONVERGED:
        return None
    held, free = _measured(problem, u), _measured(problem, solution.u)
    is_kept = are_folds_kept((held.n_gyri, held.index), (free.n_gyri, free.index))
    moved = np.linalg.norm(solution.u - u, axis=1)[: problem.mesh.n_points]
    return Relaxation(float(free.index), int(free.n_gyri), float(moved.max()), is_kept)


def are_folds_kept(held: tuple[int, float], free: tuple[int, float]) -> bool:
    """Whether gyri and index (closing) of a state are those of what it relaxes to."""
    return held[0] == free[0] and abs(held[1] - free[1]) <= KEPT


def _measured(problem: Slice, u: FloatArray) -> Measures:
    mesh, metrics = problem.mesh, problem.config.metrics
    x = mesh.points + u[: mesh.n_points]
    return measured(mesh, x, metrics)
