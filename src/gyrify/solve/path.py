r"""Where the path of accepted states leads: polynomials in growth time, of the order that hindsight favours.

.. math:: u(t) \approx \sum_i u_i \prod_{j \ne i} \frac{t - t_j}{t_i - t_j}

over the last states: two of them for order 1, four for order 3. That order is taken by which the newest state
would have been foretold best.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Final

import numpy as np

from gyrify.solve.problem import State
from gyrify.solve.types import FloatArray

_MAX_ORDER: Final = 3


class Path:
    """The last accepted states.

    Parameters
    ----------
    state : State
        The newest.
    recall : callable
        Gives an earlier one by its number.
    """

    def __init__(self, state: State, recall: Callable[[int], State]) -> None:
        self._known: deque[tuple[int, FloatArray]] = deque(maxlen=_MAX_ORDER + 2)
        for index in range(max(0, state.index - _MAX_ORDER - 1), state.index):
            self.append(recall(index))
        self.append(state)

    def append(self, state: State) -> None:
        """Add a newer state."""
        self._known.append((state.position, state.u))

    def extrapolated(self, position: int) -> FloatArray:
        """(n_points, n_dim) displacement [mm] that the path leads to at a growth time in ticks."""
        known = list(self._known)
        *past, (now, u) = known
        orders = range(1, min(_MAX_ORDER, len(past) - 1) + 1)
        errors = [float(np.abs(_through(past[-1 - order :], now) - u).max()) for order in orders]
        order = 1 + int(np.argmin(errors)) if errors else min(1, len(past))
        return _through(known[-1 - order :], position)


def _through(points: list[tuple[int, FloatArray]], position: int) -> FloatArray:
    """Value of the polynomial through given points."""
    total = np.zeros_like(points[0][1])
    for time, u in points:
        others = [other for other, _ in points if other != time]
        weight = np.prod([(position - other) / (time - other) for other in others])
        total += weight * u
    return total
