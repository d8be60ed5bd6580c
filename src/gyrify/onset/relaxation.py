"""What a state that dissipation holds back becomes once growth stops: a stable equilibrium downhill."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from typing import Final

import numpy as np

from gyrify.metrics import Measures
from gyrify.metrics.measure import measure_valid
from gyrify.model import Slice
from gyrify.solve.newton import minimise
from gyrify.solve.result import Result
from gyrify.solve.types import FloatArray

# Folds are the same while the index by the closing changes by no more than this; it is known to about that
# between seeds of the node jitter.
KEPT: Final = 0.02
# Newton iterations allowed, over those of an increment.
_PATIENCE: Final = 10


@dataclass(frozen=True)
class Relaxation:
    """What a state relaxes to without dissipation, while growth stands still.

    Attributes
    ----------
    gi_closing : float
        Gyrification index by the closing of the relaxed state [-].
    n_gyri : int
        Its gyri.
    moved_mm : float
        Largest displacement of a point on the way [mm].
    is_kept : bool
        Whether the folds are the same: as many gyri, and an index within `KEPT`.
    """

    gi_closing: float
    n_gyri: int
    moved_mm: float
    is_kept: bool

    def to_text(self) -> str:
        """JSON."""
        return json.dumps(asdict(self))

    @staticmethod
    def from_text(text: str) -> Relaxation | None:
        """Relaxation of its JSON; None where that is not one."""
        try:
            found = Relaxation(**json.loads(text))
        except (ValueError, TypeError, RecursionError):
            return None
        numbers = (found.gi_closing, found.moved_mm)
        if not all(type(value) is float and math.isfinite(value) for value in numbers):
            return None
        return found if type(found.n_gyri) is int and type(found.is_kept) is bool else None


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
    is_kept = are_folds_kept((held.n_gyri, held.gi_closing), (free.n_gyri, free.gi_closing))
    moved = np.linalg.norm(solution.u - u, axis=1)[: problem.mesh.n_points]
    return Relaxation(float(free.gi_closing), int(free.n_gyri), float(moved.max()), is_kept)


def are_folds_kept(held: tuple[int, float], free: tuple[int, float]) -> bool:
    """Whether gyri and index (closing) of a state are those of what it relaxes to."""
    return held[0] == free[0] and abs(held[1] - free[1]) <= KEPT


def _measured(problem: Slice, u: FloatArray) -> Measures:
    mesh, metrics = problem.mesh, problem.config.metrics
    x = mesh.points + u[: mesh.n_points]
    return measure_valid(
        x[mesh.contour],
        x[mesh.interface],
        metrics.closing_radius,
        metrics.gyrus_prominence,
        metrics.samples,
        mesh.period,
    )
