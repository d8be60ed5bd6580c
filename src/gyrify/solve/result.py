"""Named outcomes of a solve; each says what happened and what to try."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from gyrify.solve.types import FloatArray


class Result(Enum):
    """How a minimisation ended: (what happened, what to try)."""

    CONVERGED = ("the residual is below the tolerance", "")
    MAX_NEWTON = (
        "Newton's method did not converge within solver.max_newton iterations",
        "Raise solver.max_newton or solver.increments, or add dissipation.",
    )
    LINE_SEARCH = (
        "no step along the Newton direction lowers the energy",
        "Raise solver.increments or mesh.n_around (in space lower mesh.edge_length), or use a larger "
        "solver.tolerance.",
    )
    BLOCKED = (
        "no step is possible: the contour would cross itself",
        "Raise mesh.n_around (in space lower mesh.edge_length), or contact.activation_fraction.",
    )
    INVERTING = (
        "no step is possible: a cell would be inverted, in a part of it at least",
        'With mesh.element = "quadratic" set mesh.inversion_resistance = 0.1: nothing else resists that '
        'between integration points (in space take mesh.element = "mean_dilatation"). With another element '
        "raise mesh.n_around (in space lower mesh.edge_length) or solver.increments.",
    )
    INADMISSIBLE = (
        "a cell of the state that the increment starts from is inverted",
        "Run again from the start with `gyrify run`: this state cannot be continued.",
    )
    SINGULAR = (
        "the stiffness matrix is singular",
        "Check that the clamped boundary and all stiffnesses are reasonable, or add dissipation.",
    )
    CROSSING_PATH = (
        "the straight path between two accepted states would cross the contour",
        "Raise solver.increments.",
    )

    @property
    def is_inversion(self) -> bool:
        """Whether an inverted cell is the reason."""
        return self in (Result.INVERTING, Result.INADMISSIBLE)

    @property
    def message(self) -> str:
        """What happened."""
        return self.value[0]

    @property
    def advice(self) -> str:
        """What to try."""
        return self.value[1]


@dataclass(frozen=True)
class Stats:
    """Work done: sums over the increments of a run."""

    newton_iterations: int = 0
    factorizations: int = 0
    analyses: int = 0
    rejected: int = 0

    def __add__(self, other: Stats) -> Stats:
        return Stats(
            self.newton_iterations + other.newton_iterations,
            self.factorizations + other.factorizations,
            self.analyses + other.analyses,
            self.rejected + other.rejected,
        )

    def __sub__(self, other: Stats) -> Stats:
        return Stats(
            self.newton_iterations - other.newton_iterations,
            self.factorizations - other.factorizations,
            self.analyses - other.analyses,
            self.rejected - other.rejected,
        )


@dataclass(frozen=True, eq=False)
class Solution:
    """End of a minimisation.

    Attributes
    ----------
    u : (n_points, n_dim) float array
        Displacement [mm]; a minimiser only if ``result`` is CONVERGED.
    result : Result
        How it ended.
    residual : float
        Largest nodal force [Pa mm].
    stats : Stats
        Work done.
    """

    u: FloatArray
    result: Result
    residual: float
    stats: Stats
