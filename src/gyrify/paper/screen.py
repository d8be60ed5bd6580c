"""The screen of readings: best first, and a reading is given up once it cannot reach the third place.

Every observation is decided as soon as the runs there are decide it, so that each reading has a number of
observations that hold and a number that can still hold. Runs are made for the readings that can reach most.
A reading whose bound does not exceed what the third best has already reached is left as it is, its other
observations open: no run of it could change who the best three are. That is exact.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Final

from gyrify.config import Config
from gyrify.paper.bench import Bench
from gyrify.paper.candidate import Candidate
from gyrify.paper.reading import edges, grid, variants
from gyrify.study import Point

BEST: Final = 3
# Mechanics about which others are tried.
_REFINED: Final = 3
# Runs per batch and worker: enough to keep all at work, few enough to learn from.
_BATCH: Final = 8


@dataclass(frozen=True)
class ScreenProgress:
    """What an observer of the screen sees after each batch.

    Attributes
    ----------
    runs : int
        Runs that are known.
    live, total : int
        Mechanics that can still reach the best three, and all.
    best : int
        Observations that hold at once in the best.
    reading : str
        The best so far.
    """

    runs: int
    live: int
    total: int
    best: int
    reading: str


@dataclass(frozen=True, eq=False)
class Screening:
    """Result of a screen.

    Attributes
    ----------
    candidates : tuple of Candidate
        Best first.
    is_complete : bool
        Whether the best three are certain; else time ran out, and the same call goes on.
    live : int
        Mechanics that could still reach them.
    """

    candidates: tuple[Candidate, ...]
    is_complete: bool
    live: int

    @property
    def note(self) -> str:
        """What of the best reading lies on the edge of what was tried; empty where nothing does."""
        found = edges(self.candidates[0].mechanics) if self.candidates else []
        return f"In the best reading {' and '.join(found)}: a better one may lie beyond." if found else ""


def screen(
    bench: Bench,
    base: Config,
    *,
    seed: int = 0,
    until: float = float("inf"),
    tell: Callable[[ScreenProgress], None] = lambda _: None,
    candidates: Iterable[Candidate] | None = None,
) -> Screening:
    """Rank readings by the number of observations that hold at once.

    All mechanics are screened with linear triangles, the paper's, a small imperfection, and coarse steps of
    dissipation; then what differs from the best in its element, its number or its imperfection, until nothing
    that does is left untried.

    Parameters
    ----------
    bench : Bench
        Who computes.
    base : Config
        Everything that no reading changes.
    seed : int
        Seed of the node jitter.
    until : float
        Time of `time.perf_counter` from which no batch is begun [s].
    tell : callable
        Called after each batch.
    candidates : iterable of Candidate, optional
        What to screen; by default the whole grid.

    Returns
    -------
    Screening
    """
    given = candidates is not None
    pool = list(candidates or (Candidate(base, mechanics, seed) for mechanics in grid()))
    live = _search(bench, pool, until, tell)
    while not live and not given:
        tried = {c.mechanics for c in pool}
        near = dict.fromkeys(other for c in ranked(pool)[:_REFINED] for other in variants(c.mechanics))
        new = [Candidate(base, mechanics, seed) for mechanics in near if mechanics not in tried]
        if not new:
            break
        pool += new
        live = _search(bench, pool, until, tell)
    return Screening(tuple(ranked(pool)), not live, len(live))


def ranked(candidates: Iterable[Candidate]) -> list[Candidate]:
    """Candidates, best first: by what holds, what can still hold, closeness of both indices, and name."""
    return sorted(candidates, key=lambda c: (-c.passed, -c.bound, c.misfit, c.mechanics))


def _search(
    bench: Bench, pool: list[Candidate], until: float, tell: Callable[[ScreenProgress], None]
) -> list[Candidate]:
    """Run batches until the best three are certain, or time is over; return what could still reach them."""
    while live := _live(pool):
        if time.perf_counter() >= until:
            return live
        asked: dict[str, Candidate] = {}
        points: list[Point] = []
        for candidate in live:
            if len(points) >= _BATCH * bench.workers:
                break
            new = candidate.ask()
            points += new
            asked[str(candidate.mechanics)] = candidate
        bench.run(points)
        for candidate in asked.values():
            candidate.learn(bench)
        best = ranked(pool)[0]
        tell(ScreenProgress(len(bench.records), len(_live(pool)), len(pool), best.passed, str(best.reading)))
    return []


def _live(pool: list[Candidate]) -> list[Candidate]:
    """Those that can still change who is among the best, the most promising first."""
    best = ranked(pool)[:BEST]
    enough = best[-1].passed if len(best) == BEST else -1
    live = [c for c in pool if c.is_open and (c.bound > enough or c in best)]
    return sorted(live, key=lambda c: (-c.bound, -c.passed, c.mechanics))
