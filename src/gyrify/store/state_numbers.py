"""Which states are meant: one by its number, or several by a slice or a list of numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gyrify.base.arguments import index_of, native
from gyrify.errors import HistoryError
from gyrify.solve.types import FloatArray

# One state, or several.
Index = int | slice | Sequence[int] | NDArray[Any]


def state_number(index: object, n_states: int) -> int:
    """Number of a state, from 0.

    Parameters
    ----------
    index : int
        State, also as a NumPy integer; negative numbers count from the end.
    n_states : int
        How many there are.

    Raises
    ------
    HistoryError
        If there is no such state, or it is not a whole number.
    """
    held = f"This history holds states 0 to {n_states - 1}; -1 is the last one."
    number = index_of(index)
    if number is None:
        raise HistoryError(f"A state is chosen by a whole number, not by {str(index)[:60]!r}.", held)
    if not -n_states <= number < n_states:
        raise HistoryError(f"There is no state {number}.", held)
    return number % n_states


def state_numbers(index: object, n_states: int) -> int | list[int]:
    """Number of one state, or numbers of several.

    Parameters
    ----------
    index : int, slice or sequence of int
        As lists and arrays are indexed; an array of truth values chooses as many states as there are.
    n_states : int
        How many there are.

    Raises
    ------
    HistoryError
        If there is no such state.
    """
    if isinstance(index, slice):
        ends = (None if end is None else index_of(end) for end in (index.start, index.stop, index.step))
        start, stop, step = ends
        if step == 0 or _is_lost(index, (start, stop, step)):
            raise HistoryError(f"{index} does not choose states.", "Give whole numbers, such as [2:10:2].")
        return list(range(n_states))[start:stop:step]
    chosen = native(index)
    if isinstance(chosen, Iterable) and not isinstance(chosen, str | bytes):
        marks = list(chosen)
        if len(marks) == n_states and all(isinstance(mark, bool) for mark in marks):
            return [number for number, mark in enumerate(marks) if mark]
        return [state_number(mark, n_states) for mark in marks]
    return state_number(index, n_states)


def gathered(index: object, n_states: int, of: Callable[[int], FloatArray], n_points: int) -> FloatArray:
    """An (n_points, 2) array of one state, or those of several along a first axis."""
    numbers = state_numbers(index, n_states)
    if isinstance(numbers, int):
        return of(numbers)
    return np.array([of(number) for number in numbers], dtype=np.float64).reshape(-1, n_points, 2)


def _is_lost(index: slice, ends: tuple[int | None, ...]) -> bool:
    """Whether an end of a slice was given, and is not a whole number."""
    given = (index.start, index.stop, index.step)
    return any(end is None and was is not None for was, end in zip(given, ends, strict=True))
