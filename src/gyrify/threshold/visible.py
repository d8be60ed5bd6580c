"""Crossings of visibility: the gyrification index of full runs, scanned over a parameter, then bisected."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from gyrify.config import Config
from gyrify.errors import SolveError
from gyrify.metrics import Measures
from gyrify.simulation import simulate
from gyrify.summary import measure_state
from gyrify.threshold.parameters import configured
from gyrify.threshold.result import Becomes, Crossing, Scanned


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
    """

    def __init__(
        self, config: Config, parameter: str, level: float, watch: Callable[[], None] = lambda: None
    ) -> None:
        self._config = config.with_overrides({"stability.detect": False, "stability.follow_branch": False})
        self._parameter, self._level, self._watch = parameter, level, watch
        self._measures: dict[float, Measures] = {}
        self.notes: list[str] = []
        self.evaluations = 0

    def scan(self, values: Sequence[float]) -> list[Scanned]:
        """Index at each value; over growth time, at the increments of one run inside the range."""
        if self._parameter == "growth.time":
            return self._one_run(values[0], values[-1])
        scanned = []
        for value in values:
            try:
                scanned.append(Scanned(value, gi=self._run(value).gi_closing))
            except SolveError as failure:
                self.notes.append(f"The run at {value:.6g} failed and is left out: {failure.message}")
        return scanned

    def crossing(self, below: Scanned, above: Scanned, tolerance: float) -> Crossing:
        """Where the index passes the level between two points of the scan, by bisection."""
        low, high = below, above
        while self._parameter != "growth.time" and high.value - low.value > tolerance * high.value:
            middle = 0.5 * (low.value + high.value)
            between = Scanned(middle, gi=self._run(middle).gi_closing)
            low, high = (between, high) if self.folded(between) == self.folded(low) else (low, between)
        folded = self._measures[(high if self.folded(high) else low).value]
        becomes: Becomes = "folded" if self.folded(high) else "smooth"
        value = 0.5 * (low.value + high.value)
        if self._parameter == "growth.time" and low.gi is not None and high.gi is not None:
            value = low.value + (self._level - low.gi) / (high.gi - low.gi) * (high.value - low.value)
        time = value if self._parameter == "growth.time" else self._config.growth.duration
        n_gyri = folded.n_gyri or None
        wavelength = folded.contour_length / n_gyri if n_gyri else None
        return Crossing(value, becomes, (low.value, high.value), n_gyri, wavelength, time)

    def folded(self, point: Scanned) -> bool:
        """Whether the index is above the level."""
        return point.gi is not None and point.gi > self._level

    def _run(self, value: float) -> Measures:
        self._watch()
        self.evaluations += 1
        history = simulate(configured(self._config, self._parameter, value))
        self._measures[value] = measure_state(history)
        return self._measures[value]

    def _one_run(self, low: float, high: float) -> list[Scanned]:
        self._watch()
        self.evaluations += 1
        history = simulate(configured(self._config, "growth.time", high))
        times = history.growth_times
        inside = np.flatnonzero(times >= low)
        self._measures = {float(times[index]): measure_state(history, int(index)) for index in inside}
        return [Scanned(time, gi=measures.gi_closing) for time, measures in self._measures.items()]
