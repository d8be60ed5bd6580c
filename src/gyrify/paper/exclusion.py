"""Which observations were never seen to hold together, over everything that a search has run."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import combinations

from gyrify.paper.scoreboard import Scoreboard


@dataclass(frozen=True)
class Exclusion:
    """Two observations, and how often they held.

    Attributes
    ----------
    one, other : str
        Their ids.
    decided : int
        Scoreboards in which both are decided.
    together, only_one, only_other : int
        Of these, those in which both hold, the first alone, and the second alone.
    """

    one: str
    other: str
    decided: int
    together: int
    only_one: int
    only_other: int

    @property
    def is_exclusive(self) -> bool:
        """Whether each was seen to hold, and never both."""
        return self.together == 0 < min(self.only_one, self.only_other)


def exclusions(boards: Iterable[Scoreboard]) -> list[Exclusion]:
    """Every pair of observations, in the order of the paper.

    Parameters
    ----------
    boards : iterable of Scoreboard
        What has been judged; one mechanics may give several, by seed and by index.

    Returns
    -------
    list of Exclusion
    """
    counts: dict[tuple[str, str], Counter[tuple[bool, bool]]] = {}
    for board in boards:
        for a, b in combinations(board.rows, 2):
            if a.passed is not None and b.passed is not None:
                counts.setdefault((a.id, b.id), Counter())[a.passed, b.passed] += 1
    return [
        Exclusion(a, b, found.total(), found[True, True], found[True, False], found[False, True])
        for (a, b), found in counts.items()
    ]
