"""Crossings of visibility: the gyrification index of full runs, scanned over a parameter, then bisected."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import closing

import numpy as np

from gyrify.base.pool import Watcher, each, go_on
from gyrify.config import Config
from gyrify.errors import LimitReachedError, SolveError
from gyrify.metrics import Measures
from gyrify.run.simulation import new_run
from gyrify.run.summary import measure_state
from gyrify.store.history import History
from gyrify.threshold.crossings import Becomes, Crossing, Scanned
from gyrify.threshold.scanned_parameter import configured

Item = tuple[float, Config]
Result = tuple[float, Measures | str]


class VisibleScan:
    """Gyrification index after a run with the configuration's own dissipation and jitter.

    Parameters
    ----------
    config : Config
        The other parameters.
    parameter : str
        Key of the parameter.
    level : float
        Index by the closing above which a slice counts as folded [-].
    watch : callable
        Called before each run; may raise to stop.
    workers : int
        Processes for the runs of the scan.
    """

    def __init__(
        self,
        config: Config,
        parameter: str,
        level: float,
        watch: Callable[[], None] = lambda: None,
        workers: int = 1,
    ) -> None:
        self._workers = workers
        self._config = config.with_overrides({"stability.detect": False, "stability.follow_branch": False})
        self._parameter, self._level, self._watch = parameter, level, watch
        self._measures: dict[float, Measures] = {}
        self.notes: list[str] = []
        self.evaluations = 0

    def scan(self, values: Sequence[float]) -> list[Scanned]:
        """Index at each value; over growth time, at the increments of one run inside the range."""
        if self._parameter == "growth.time":
            return self._one_run(values[0], values[-1])
        items = [(value, configured(self._config, self._parameter, value)) for value in values]
        failures: dict[float, str] = {}
        with closing(each(_measured, items, self._workers, _lost)) as results:
            for value, found in results:
                self._watch()
                if isinstance(found, str):
                    failures[value] = found
                else:
                    self._measures[value] = found
        self.evaluations += len(items)
        self.notes += [
            f"The run at {value:.6g} failed and is left out: {failures[value]}"
            for value in values
            if value in failures
        ]
        return [
            Scanned(value, gi=self._index(self._measures[value])) for value in values if value not in failures
        ]

    def crossing(self, below: Scanned, above: Scanned, tolerance: float) -> Crossing:
        """Where the index passes the level between two points of the scan, by bisection."""
        low, high = below, above
        while self._parameter != "growth.time" and high.value - low.value > tolerance * high.value:
            middle = 0.5 * (low.value + high.value)
            between = Scanned(middle, gi=self._index(self._run(middle)))
            low, high = (between, high) if self.folded(between) == self.folded(low) else (low, between)
        folded = self._measures[(high if self.folded(high) else low).value]
        becomes: Becomes = "folded" if self.folded(high) else "smooth"
        value = 0.5 * (low.value + high.value)
        if self._parameter == "growth.time" and low.gi is not None and high.gi is not None:
            value = low.value + (self._level - low.gi) / (high.gi - low.gi) * (high.value - low.value)
        time = value if self._parameter == "growth.time" else self._config.growth.duration
        n_gyri = folded.n_gyri or None
        wavelength = _wavelength(folded) if n_gyri else None
        return Crossing(value, becomes, (low.value, high.value), n_gyri, wavelength, time)

    def folded(self, point: Scanned) -> bool:
        """Whether the index is above the level."""
        return point.gi is not None and point.gi > self._level

    def _run(self, value: float) -> Measures:
        self._watch()
        self.evaluations += 1
        self._measures[value] = measure_state(_grown(configured(self._config, self._parameter, value)))
        return self._measures[value]

    def _one_run(self, low: float, high: float) -> list[Scanned]:
        self._watch()
        self.evaluations += 1
        history = _grown(configured(self._config, "growth.time", high))
        times = history.growth_times
        inside = np.flatnonzero(times >= low)
        self._measures = {float(times[index]): measure_state(history, int(index)) for index in inside}
        return [Scanned(time, gi=self._index(measures)) for time, measures in self._measures.items()]

    def _index(self, measures: Measures) -> float:
        """Index by the closing, in space of areas: 1 where that by the hull is at most the level.

        The area of the closing is read off a grid, and lacks as much of a smooth surface as of a folded one.
        """
        if measures.n_dim == 3 and measures.gi_area_hull <= self._level:
            return 1.0
        return measures.index


def _wavelength(measures: Measures) -> float | None:
    """Contour over the number of gyri; in space as it is measured, None where there are no folds."""
    if measures.n_dim == 3:
        return measures.wavelength or None
    return measures.contour_length / measures.n_gyri


def _grown(config: Config, watch: Watcher = go_on) -> History:
    """A whole run; the index of one that a limit has stopped says nothing about the end of growth.

    Raises
    ------
    LimitReachedError
        If a limit of the configuration stopped it.
    """
    with new_run(config) as run:
        run.grow(watch=watch)
    if run.history.status == "stopped":
        raise LimitReachedError(run.history.reason, "Raise the limit, or scan fewer points.")
    return run.history


def _measured(item: Item, watch: Watcher) -> Result:
    """Metrics at the end of a run, or why it failed."""
    value, config = item
    try:
        return value, measure_state(_grown(config, watch))
    except SolveError as failure:
        return value, failure.message


def _lost(item: Item) -> Result:
    return item[0], "Its process ended unexpectedly; memory may have run out."
