"""What is solved: accepted states, how growth is divided, and what the driver needs to know of the tissue."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final, Protocol

import numpy as np

from gyrify.energy.total import TotalEnergy
from gyrify.solve.newton import Criterion
from gyrify.solve.result import Stats
from gyrify.solve.system import System
from gyrify.solve.types import FloatArray, IntArray

# A nominal increment is this many ticks: growth time is an integer, so halving and resuming are exact.
TICKS: Final = 2**20


@dataclass(frozen=True, eq=False)
class State:
    """An accepted increment, with all that the next one depends on.

    Attributes
    ----------
    index : int
        Number of the increment; 0 is the reference state.
    position : int
        Growth time in ticks.
    u : (n_points, n_dim) float array
        Displacement [mm].
    span : int
        Ticks of the increment that led here.
    u_before : (n_points, n_dim) float array
        Displacement at its start [mm].
    next_span : int
        Ticks of the increment to try next.
    couplings : (n_pairs, 2) int array
        Point pairs in the sparsity pattern because of contact.
    residual : float
        Largest nodal force [Pa mm].
    stats : Stats
        Work since the start of the run.
    internal : mapping of str to float array
        Internal variables by name: what the state has besides the displacement; see `gyrify.model.internal`.
    """

    index: int
    position: int
    u: FloatArray
    span: int
    u_before: FloatArray
    next_span: int
    couplings: IntArray
    residual: float
    stats: Stats
    internal: Mapping[str, FloatArray] = field(default_factory=dict)

    @staticmethod
    def reference(n_points: int, n_dim: int, internal: Mapping[str, FloatArray] | None = None) -> State:
        """Undeformed state at growth time zero."""
        zero, none = np.zeros((n_points, n_dim)), np.empty((0, 2), dtype=np.int64)
        return State(0, 0, zero, TICKS, zero, TICKS, none, 0.0, Stats(), internal or {})


class Problem(Protocol):
    """What the driver needs to know of the tissue."""

    @property
    def shift_mass(self) -> FloatArray | None:
        """Diagonal of the mass that indefinite Hessians are shifted by; None to project them."""
        ...

    @property
    def old_steps(self) -> int:
        """How many steps with an old Hessian are worth trying; see `QuasiNewton`."""
        ...

    @property
    def is_path_kept(self) -> bool:
        """Whether to stay on a branch of equilibria where it turns unstable, for `inspect` to see that."""
        ...

    @property
    def may_jump(self) -> bool:
        """Whether the path of states may have jumps, which no increment is small enough to resolve."""
        ...

    def evolved(self, before: State, after: State) -> State:
        """The accepted state with its internal variables, which an increment from ``before`` has led to."""
        ...

    def energy(self, fraction: float, start: State, start_fraction: float) -> TotalEnergy:
        """Total energy at a fraction of the growth duration, for an increment from a state."""
        ...

    def system(self, couplings: IntArray) -> System:
        """Linear system with couplings in its pattern."""
        ...

    def increment_system(self, couplings: IntArray) -> System:
        """The same for the increments, of as few unknowns as the symmetry that is kept leaves."""
        ...

    def candidates(self, u: FloatArray) -> IntArray:
        """Point pairs that contact may couple soon."""
        ...

    def is_path_admissible(self, u: FloatArray, u_end: FloatArray) -> bool:
        """Whether the contour crosses itself nowhere on the straight path between two states."""
        ...


@dataclass(frozen=True)
class Stepping:
    """How growth is divided into increments.

    Attributes
    ----------
    increments : int
        Nominal number of increments.
    min_increment : float
        Smallest increment, as a fraction of the duration.
    criterion : Criterion
        When an increment has converged.
    force_unit : str
        Unit of nodal forces, for people.
    """

    increments: int
    min_increment: float
    criterion: Criterion
    force_unit: str = "Pa mm"

    @property
    def end(self) -> int:
        """Final growth time in ticks."""
        return self.increments * TICKS

    @property
    def smallest_span(self) -> float:
        """Smallest increment in ticks, a whole number of them at least."""
        return max(1.0, self.min_increment * self.end)

    def is_smallest(self, span: int) -> bool:
        """Whether half of an increment would be too small."""
        return span // 2 < self.smallest_span
