"""One mechanics of the search, judged on several seeds and given up as soon as it has fallen behind."""

from __future__ import annotations

from statistics import fmean
from typing import Final, Literal

from gyrify.config import Config
from gyrify.paper.candidate import Candidate
from gyrify.paper.cases import EQUAL, SOFT, Case
from gyrify.paper.index import INDICES, Index
from gyrify.paper.reading import Mechanics, Reading
from gyrify.paper.simulations import Simulations
from gyrify.study import Point

Origin = Literal["known", "random", "surrogate", "neighbour"]
# Seeds by which readings are chosen; others stay fresh for the score.
CHOOSING: Final = (0, 1, 2)
# By how many observations another seed may do better than the first, at most, before a reading is given up.
_SLACK: Final = 1.0
_PAPER: Final = {Case(SOFT): 1.29, Case(EQUAL): 1.37}
_WORST: Final = 10.0


class Contender:
    """A mechanics with a candidate for each seed by which readings are chosen.

    Parameters
    ----------
    base : Config
        Everything that no reading changes.
    mechanics : Mechanics
        The reading, but for its index.
    origin : {"known", "random", "surrogate", "neighbour"}
        Who proposed it.
    is_fitted : bool
        Whether fitted constants are allowed, the radius of the index among them.
    level : float
        Mean number of observations that it has to exceed to be among the best; fixed, so that what becomes of
        it depends on no other.
    """

    def __init__(
        self, base: Config, mechanics: Mechanics, origin: Origin, is_fitted: bool, level: float
    ) -> None:
        self._base, self.mechanics, self.origin, self.level = base, mechanics, origin, level
        indices = [gi for gi in INDICES if is_fitted or not gi.is_fitted]
        self.candidates = [Candidate(base, mechanics, CHOOSING[0], indices)]

    @property
    def gi(self) -> Index:
        """The index by which most observations hold in the mean; of equals, one without a fitted radius."""
        return max(self.indices, key=lambda gi: (self._passed(gi), not gi.is_fitted, self.value_of(gi)))

    @property
    def reading(self) -> Reading:
        """Its best reading."""
        return Reading(self.mechanics, self.gi)

    @property
    def indices(self) -> tuple[Index, ...]:
        """The indices by which it may still be judged."""
        return self.candidates[-1].indices

    @property
    def passed(self) -> float:
        """Mean number of observations that hold at once, at least; over the seeds that were begun."""
        return self._passed(self.gi)

    @property
    def is_complete(self) -> bool:
        """Whether all seeds came to their end, so that no index could be better than its own."""
        if len(self.candidates) < len(CHOOSING):
            return False
        best = self.passed
        return self._bound(self.gi) == best and all(self._bound(gi) <= best for gi in self.indices)

    @property
    def impossible(self) -> str:
        """Why it cannot be run; empty where it can."""
        return self.candidates[0].impossible

    @property
    def value(self) -> float:
        """What the search climbs."""
        return max(self.value_of(gi) for gi in self.indices)

    @property
    def misfit(self) -> float:
        """Distance of both standard indices from the paper's with the first seed [-], to rank equals."""
        rows = self.candidates[0].rows[self.gi]
        known = [abs(rows[c].gi - gi) for c, gi in _PAPER.items() if c in rows and rows[c].is_complete]
        return sum(known) if len(known) == len(_PAPER) else _WORST

    @property
    def n_runs(self) -> int:
        """Runs that are known."""
        return sum(candidate.n_runs for candidate in self.candidates)

    def value_of(self, gi: Index) -> float:
        """Mean of the candidates' values by one index."""
        return fmean(candidate.value(gi) for candidate in self.candidates)

    def ask(self) -> list[Point]:
        """The runs it needs next; none once it is complete or has fallen behind."""
        first = self.candidates[0]
        if len(self.candidates) == 1:
            if self.impossible or first.bound < self.level - _SLACK:
                return []
            if first.is_open:
                return first.ask()
            near = [gi for gi in first.indices if self._bound(gi) >= first.passed - _SLACK]
            self.candidates += [Candidate(self._base, self.mechanics, seed, near) for seed in CHOOSING[1:]]
        enough = max(self.level, self.passed)
        hopeful = [gi for gi in self.indices if self._bound(gi) > enough]
        if not hopeful:
            return []
        most = max(self._bound(gi) for gi in hopeful)
        best = [gi for gi in hopeful if self._bound(gi) == most]
        return [point for candidate in self.candidates for point in candidate.ask(best)]

    def learn(self, simulations: Simulations) -> None:
        """Take in what has become known."""
        for candidate in self.candidates:
            candidate.learn(simulations)

    def _passed(self, gi: Index) -> float:
        return fmean(candidate.boards[gi].passed for candidate in self.candidates)

    def _bound(self, gi: Index) -> float:
        return fmean(c.boards[gi].passed + c.boards[gi].open for c in self.candidates)
