"""Times of several tasks, taken in turns, so that a slow moment of the machine falls on all of them."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Sample:
    """Repeated measurements of one quantity.

    Attributes
    ----------
    values : tuple of float
        In the order they were taken.
    """

    values: tuple[float, ...]

    @property
    def median(self) -> float:
        """Middle value."""
        return float(np.median(self.values))

    @property
    def low(self) -> float:
        """First quartile."""
        return float(np.percentile(self.values, 25))

    @property
    def high(self) -> float:
        """Third quartile."""
        return float(np.percentile(self.values, 75))

    def over(self, other: Sample) -> Sample:
        """Ratios of measurements taken next to each other."""
        return Sample(tuple(a / b for a, b in zip(self.values, other.values, strict=True)))


def interleaved(
    tasks: Mapping[str, Callable[[], object]],
    repeats: int,
    least: float = 0.02,
    clock: Callable[[], float] = time.process_time,
) -> dict[str, Sample]:
    """Seconds per call of every task.

    Parameters
    ----------
    tasks : mapping of str to callable
        What to measure.
    repeats : int
        Rounds; in each of them every task has its turn, in an order that rotates.
    least : float
        Shortest duration of a turn [s]: a quick task is called as often as that takes; 0 for
        one call.
    clock : callable
        Processor time of this process, which has one thread, unless others do the work.

    Returns
    -------
    dict of str to Sample
    """
    calls = {name: _calls_that_take(least, task, clock) for name, task in tasks.items()}
    seconds: dict[str, list[float]] = {name: [] for name in tasks}
    names = list(tasks)
    for turn in range(repeats):
        for name in names[turn % len(names) :] + names[: turn % len(names)]:
            gc.collect()
            begun = clock()
            for _ in range(calls[name]):
                tasks[name]()
            seconds[name].append((clock() - begun) / calls[name])
    return {name: Sample(tuple(values)) for name, values in seconds.items()}


def _calls_that_take(least: float, task: Callable[[], object], clock: Callable[[], float]) -> int:
    """Number of calls in a turn; the first call warms up and is not measured."""
    task()
    if least == 0.0:
        return 1
    begun = clock()
    task()
    once = clock() - begun
    return max(1, int(np.ceil(least / max(once, 1e-9))))
