"""The search of readings: chance and two guides propose, and what has fallen behind is given up.

Readings are chosen by seeds 0 to 2. Half of the proposals are random, so that what guidance brings is seen,
and readings with and without fitted constants are ranked apart. What becomes of a reading depends on its own
runs and on the ranking before its round: the same versions give the same search with any number of workers,
and the same call goes on where another ended.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

import numpy as np

from gyrify.base.extras import require
from gyrify.config import Config
from gyrify.paper.contender import Contender, Origin
from gyrify.paper.neighbour import neighbour
from gyrify.paper.reading import Mechanics
from gyrify.paper.simulations import Simulations
from gyrify.paper.space import edges, mechanics_of, parameters_of
from gyrify.study import Point

BEST: Final = 3
ROUNDS: Final = 16
# Mean number of observations that the first readings have to exceed.
FLOOR: Final = 8.0
# Proposals of a round with fitted constants: as many by chance as by the others together.
_FITTED: Final[tuple[Origin, ...]] = (*("random",) * 4, *("surrogate",) * 2, *("neighbour",) * 2)
# Those without, in every second round: they are few.
_FREE: Final[tuple[Origin, ...]] = ("random", "random", "surrogate")
_STARTUP: Final = 12
# Known before the search: the preset of before, the frozen reading, growth between none and full along z, and
# the same in equilibrium.
KNOWN: Final = (
    Mechanics("generalised", number=2.6, imperfection=1e-2),
    Mechanics(),
    Mechanics("generalised", "exponential", number=2.6, imperfection=0.1, exponent=0.13, course="reduced"),
    Mechanics("generalised", "exponential", "grown", "none", 0.0, imperfection=0.076, exponent=0.17),
)


@dataclass(frozen=True)
class SearchProgress:
    """What an observer sees after each batch of runs.

    Attributes
    ----------
    round, rounds : int
        The round, and how many there are; round 0 is what was known before.
    runs, readings : int
        Runs that are known, and mechanics that were proposed.
    best : float
        Mean number of observations that hold in the best so far.
    reading : str
        That reading.
    """

    round: int
    rounds: int
    runs: int
    readings: int
    best: float
    reading: str


class League:
    """Readings that are ranked together: with fitted constants, or without."""

    def __init__(self, base: Config, is_fitted: bool, seed: int = 0) -> None:
        optuna = require("optuna", "search", "The search of readings")
        optuna.logging.set_verbosity(optuna.logging.WARNING)
        self._base, self.is_fitted, self._optuna = base, is_fitted, optuna
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
            guided = optuna.samplers.TPESampler(
                n_startup_trials=_STARTUP, multivariate=True, group=True, constant_liar=True, seed=seed
            )
        self._guided = optuna.create_study(sampler=guided, direction="maximize")
        self._random, self._drawn = (
            optuna.create_study(sampler=optuna.samplers.RandomSampler(seed=seed + i)) for i in (1, 2)
        )
        self._rng = np.random.default_rng(seed)
        self.contenders: list[Contender] = []

    @property
    def ranked(self) -> list[Contender]:
        """Best first: those that came to their end, then by what holds, nearly holds, and by the indices."""
        return sorted(
            {c.mechanics: c for c in reversed(self.contenders)}.values(),
            key=lambda c: (not c.is_complete, -c.passed, -c.value, c.misfit, c.mechanics),
        )

    @property
    def level(self) -> float:
        """Mean number of observations that hold in the third best, or what is asked of the first ones."""
        best = [c for c in self.ranked if c.is_complete][:BEST]
        return best[-1].passed if len(best) == BEST else FLOOR

    def begin(self) -> list[tuple[Contender, Any]]:
        """What was known before as contenders, each with the trial that takes its value."""
        known = KNOWN if self.is_fitted else ()
        return [self._contender(self._known(mechanics), "known") for mechanics in known]

    def propose(self, number: int) -> list[tuple[Contender, Any]]:
        """Contenders of a round of this number."""
        if not self.is_fitted and number % 2:
            return []
        return [self._contender(self._trial(o), o) for o in (_FITTED if self.is_fitted else _FREE)]

    def _trial(self, origin: Origin) -> Any:
        parents = [c.mechanics for c in self.ranked if c.is_complete][:BEST]
        if origin == "neighbour" and parents:
            parent = parents[int(self._rng.integers(len(parents)))]
            drawn = mechanics_of(self._drawn.ask(), is_fitted=True)
            return self._known(neighbour(parent, drawn, self._rng))
        return self._random.ask() if origin == "random" else self._guided.ask()

    def learn(self, found: Iterable[tuple[Contender, Any]]) -> None:
        """Take in what has become of a round's contenders."""
        for contender, trial in found:
            self.contenders.append(contender)
            if contender.origin == "random":
                told = self._optuna.trial.create_trial(
                    params=trial.params, distributions=trial.distributions, value=contender.value
                )
                self._guided.add_trial(told)
            else:
                self._guided.tell(trial, contender.value)

    def _known(self, mechanics: Mechanics) -> Any:
        self._guided.enqueue_trial(parameters_of(mechanics))
        return self._guided.ask()

    def _contender(self, trial: Any, origin: Origin) -> tuple[Contender, Any]:
        mechanics = mechanics_of(trial, is_fitted=self.is_fitted)
        return Contender(self._base, mechanics, origin, self.is_fitted, self.level), trial


@dataclass(frozen=True, eq=False)
class Search:
    """Result of a search.

    Attributes
    ----------
    fitted, free : League
        Readings with fitted constants, and without.
    rounds : int
        Rounds that came to their end.
    is_complete : bool
        Whether all did; else time ran out, and the same call goes on.
    core_minutes : float
        Time that all runs took, on one core each [min].
    """

    fitted: League
    free: League
    rounds: int
    is_complete: bool
    core_minutes: float

    @property
    def note(self) -> str:
        """What of the best reading lies on the edge of what was tried; empty where nothing does."""
        best = self.fitted.ranked[:1]
        found = edges(best[0].mechanics) if best else []
        return f"In the best reading {' and '.join(found)}: a better one may lie beyond." if found else ""


def search(
    simulations: Simulations,
    base: Config,
    *,
    rounds: int = ROUNDS,
    until: float = float("inf"),
    tell: Callable[[SearchProgress], None] = lambda _: None,
) -> Search:
    """Look for the readings by which most observations hold at once.

    Parameters
    ----------
    simulations : Simulations
        Who computes.
    base : Config
        Everything that no reading changes.
    rounds : int
        Rounds of proposals.
    until : float
        Time of `time.perf_counter` from which no batch is begun [s].
    tell : callable
        Called with a `SearchProgress` after each batch.

    Returns
    -------
    Search

    Raises
    ------
    ConfigError
        If optuna, which proposes, is not installed.
    """
    fitted, free = League(base, True), League(base, False)
    for number in range(rounds + 1):
        news = (fitted.propose(number), free.propose(number)) if number else (fitted.begin(), free.begin())
        group = [contender for new in news for contender, _ in new]
        say = partial(_say, tell, simulations, (number, rounds), fitted, free, group)
        if not _race(simulations, group, until, say):
            return Search(fitted, free, max(number - 1, 0), False, simulations.core_minutes)
        for league, new in zip((fitted, free), news, strict=True):
            league.learn(new)
    return Search(fitted, free, rounds, True, simulations.core_minutes)


def _say(
    tell: Callable[[SearchProgress], None],
    simulations: Simulations,
    at: tuple[int, int],
    fitted: League,
    free: League,
    group: list[Contender],
) -> None:
    best = (fitted.ranked or group)[0]
    readings = len(fitted.contenders) + len(free.contenders) + len(group)
    tell(SearchProgress(*at, len(simulations.records), readings, best.passed, str(best.reading)))


def _race(simulations: Simulations, group: list[Contender], until: float, say: Callable[[], None]) -> bool:
    """Run a round's contenders to their ends, or until they have fallen behind; false where time is over."""
    while True:
        points: dict[str, Point] = {}
        asking = []
        for contender in group:
            new = contender.ask()
            points |= {point.key: point for point in new}
            asking += [contender] if new else []
        if not asking:
            return True
        if time.perf_counter() >= until:
            return False
        simulations.run(list(points.values()))
        for contender in asking:
            contender.learn(simulations)
        say()
