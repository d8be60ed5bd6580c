"""One mechanics with one seed: what is known, what it can still reach, and which runs it needs next."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from gyrify.config import Config
from gyrify.errors import ConfigError
from gyrify.paper.cases import STAGES, Case
from gyrify.paper.index import INDICES, Index
from gyrify.paper.reading import Mechanics, Reading, point_of
from gyrify.paper.row import Row
from gyrify.paper.scoreboard import Scoreboard, score
from gyrify.paper.simulations import Simulations
from gyrify.study import Point

_STAGE: Final = {
    case: number for number, stage in reversed(list(enumerate(STAGES.values()))) for case in stage
}
# What an observation that fails is worth to the search at most, by the part of its checks that pass: it tells
# two readings apart that agree in whole observations.
_NEARLY: Final = 0.5
# What an observation is worth that was left open because the reading had fallen behind.
_UNKNOWN: Final = 0.25


class Candidate:
    """A mechanics with one seed and its scoreboards, one for each gyrification index.

    Parameters
    ----------
    base : Config
        Everything that no reading changes.
    mechanics : Mechanics
        The reading, but for its index.
    seed : int
        Seed of the node jitter.
    indices : sequence of Index
        What the reading may call gyrification index.
    """

    def __init__(
        self, base: Config, mechanics: Mechanics, seed: int = 0, indices: Sequence[Index] = INDICES
    ) -> None:
        self._base, self.mechanics, self.seed, self.indices = base, mechanics, seed, tuple(indices)
        self._asked: dict[Case, Point] = {}
        self.rows: dict[Index, dict[Case, Row]] = {gi: {} for gi in self.indices}
        self.impossible = ""
        self._judge()

    @property
    def gi(self) -> Index:
        """The index by which most observations hold, or still can."""
        return max(self.indices, key=lambda gi: (self.boards[gi].passed, self.boards[gi].open))

    @property
    def board(self) -> Scoreboard:
        """The scoreboard by that index."""
        return self.boards[self.gi]

    @property
    def passed(self) -> int:
        """Observations that hold at once, at least."""
        return self.board.passed

    @property
    def bound(self) -> int:
        """Observations that can still hold at once, at most."""
        if self.impossible:
            return self.passed
        return max(board.passed + board.open for board in self.boards.values())

    @property
    def is_open(self) -> bool:
        """Whether more runs could raise it."""
        return self.bound > self.passed

    @property
    def n_runs(self) -> int:
        """Runs that are known."""
        return len(self.rows[self.indices[0]])

    def value(self, gi: Index) -> float:
        """What the search climbs: observations that hold, and a part for those that nearly do."""
        known = {True: 1.0, None: _UNKNOWN}
        return sum(known.get(row.passed, _NEARLY * row.share) for row in self.boards[gi].rows)

    def ask(self, indices: Sequence[Index] = ()) -> list[Point]:
        """The runs it needs next: of those that could decide an open observation, the earliest stage.

        By default for the indices by which most can still hold.
        """
        found = indices or [gi for gi, b in self.boards.items() if b.passed + b.open == self.bound]
        boards = [self.boards[gi] for gi in found]
        missing = {case for board in boards for row in board.rows for case in row.missing}
        first = min((_STAGE.get(case, len(STAGES)) for case in missing), default=0)
        cases = sorted(case for case in missing if _STAGE.get(case, len(STAGES)) == first)
        try:
            points = {case: point_of(self._base, self.mechanics, case, self.seed) for case in cases}
        except ConfigError as fault:
            self.impossible = fault.message
            return []
        self._asked |= points
        return list(points.values())

    def learn(self, simulations: Simulations) -> None:
        """Take in what has become known of the runs it has asked for."""
        for case, point in list(self._asked.items()):
            found = {gi: simulations.row(point, gi) for gi in self.indices}
            for gi, row in found.items():
                if row is not None:
                    self.rows[gi][case] = row
                    self._asked.pop(case, None)
        self._judge()

    def _judge(self) -> None:
        self.boards: dict[Index, Scoreboard] = {
            gi: score(self.rows[gi], str(Reading(self.mechanics, gi))) for gi in self.indices
        }
