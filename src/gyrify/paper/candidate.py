"""One mechanics of the screen: what is known of it, what it can still reach, and which runs it needs next."""

from __future__ import annotations

from typing import Final

from gyrify.config import Config
from gyrify.errors import ConfigError
from gyrify.paper.bench import Bench
from gyrify.paper.cases import EQUAL, SOFT, STAGES, Case
from gyrify.paper.reading import Mechanics, Reading, point_of
from gyrify.paper.row import GI_DEFINITIONS, GiDefinition, Row, row_of
from gyrify.paper.scoreboard import Scoreboard, score
from gyrify.study import Point

_STAGE: Final = {
    case: number for number, stage in reversed(list(enumerate(STAGES.values()))) for case in stage
}
_WORST: Final = 10.0


class Candidate:
    """A mechanics with its scoreboards, one for each definition of the gyrification index.

    Parameters
    ----------
    base : Config
        Everything that no reading changes.
    mechanics : Mechanics
        The reading, but for its index.
    seed : int
        Seed of the node jitter.
    """

    def __init__(self, base: Config, mechanics: Mechanics, seed: int = 0) -> None:
        self._base, self.mechanics, self._seed = base, mechanics, seed
        self._asked: dict[Case, Point] = {}
        self.rows: dict[GiDefinition, dict[Case, Row]] = {gi: {} for gi in GI_DEFINITIONS}
        self.impossible = ""
        self._judge()

    @property
    def gi(self) -> GiDefinition:
        """The definition by which most observations hold, or still can."""
        return max(GI_DEFINITIONS, key=lambda gi: (self.boards[gi].passed, self.boards[gi].open))

    @property
    def reading(self) -> Reading:
        """Its best reading so far."""
        return Reading(self.mechanics, self.gi)

    @property
    def passed(self) -> int:
        """Observations that hold at once, at least."""
        return self.boards[self.gi].passed

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
    def misfit(self) -> float:
        """Distance of both standard indices from the paper's [-], to rank equals."""
        rows, paper = self.rows[self.gi], {Case(SOFT): 1.29, Case(EQUAL): 1.37}
        known = [
            abs(rows[case].gi - gi) for case, gi in paper.items() if case in rows and rows[case].is_complete
        ]
        return sum(known) if len(known) == len(paper) else _WORST

    @property
    def n_runs(self) -> int:
        """Runs that are known."""
        return len(self.rows[self.gi])

    def ask(self) -> list[Point]:
        """The runs it needs next: of those that could decide an open observation, the earliest stage."""
        boards = [board for board in self.boards.values() if board.passed + board.open == self.bound]
        missing = {case for board in boards for row in board.rows for case in row.missing}
        first = min((_STAGE.get(case, len(STAGES)) for case in missing), default=0)
        cases = sorted(case for case in missing if _STAGE.get(case, len(STAGES)) == first)
        try:
            points = {case: point_of(self._base, self.mechanics, case, self._seed) for case in cases}
        except ConfigError as fault:
            self.impossible = fault.message
            return []
        self._asked |= points
        return list(points.values())

    def learn(self, bench: Bench) -> None:
        """Take in what has become known of the runs it has asked for."""
        for case, point in list(self._asked.items()):
            record = bench.record(point)
            if record is None:
                continue
            del self._asked[case]
            reason = f"{record.reason} {record.advice}".strip()
            for gi in GI_DEFINITIONS:
                told = (record.status, reason, record.summary, gi)
                self.rows[gi][case] = row_of(point.config, point.key, *told)
        self._judge()

    def _judge(self) -> None:
        self.boards: dict[GiDefinition, Scoreboard] = {
            gi: score(self.rows[gi], str(Reading(self.mechanics, gi))) for gi in GI_DEFINITIONS
        }
