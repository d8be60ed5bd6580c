"""Internal variables: what a state of the body has besides the displacement. None exists yet.

A variable is stored, resumed and hashed with the state. Terms read it, as it is at the start of an increment,
from their `gyrify.model.terms.GrowthStep`; it changes once the increment is accepted.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from gyrify.energy.term import FloatArray
from gyrify.solve.problem import State

if TYPE_CHECKING:
    from gyrify.model.slice import Slice


@dataclass(frozen=True)
class InternalVariable:
    """A variable.

    Attributes
    ----------
    name : str
        Its name in the state and in the journal.
    at_start : callable
        Its value in the reference state of a body, an array of any shape.
    after : callable
        Its value after an increment, from the body and the states before and after.
    """

    name: str
    at_start: Callable[[Slice], FloatArray]
    after: Callable[[Slice, State, State], FloatArray]


INTERNAL: Final[list[InternalVariable]] = []
