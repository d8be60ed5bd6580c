"""A reading with several seeds: the folded state is not unique, and this is how far it spreads."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from statistics import fmean, stdev

from gyrify.config import Config
from gyrify.paper.cases import BOTH, Case, ratio_text
from gyrify.paper.contender import CHOOSING
from gyrify.paper.reading import Reading
from gyrify.paper.reproduce import Reproduction, reproduce
from gyrify.paper.row import Row
from gyrify.paper.simulations import Simulations
from gyrify.paper.visible_folds import visible_bracket

SEEDS = (0, 1, 2, 3, 4)


@dataclass(frozen=True)
class Spread:
    """A quantity over the seeds.

    Attributes
    ----------
    name : str
        What it is.
    mean, deviation : float
        Mean and sample standard deviation; the latter 0 for a single value.
    n : int
        Seeds that have it.
    """

    name: str
    mean: float
    deviation: float
    n: int

    def __str__(self) -> str:
        return f"{self.mean:.3f} ± {self.deviation:.3f}" + (
            "" if self.n == len(SEEDS) else f" ({self.n} seeds)"
        )


@dataclass(frozen=True, eq=False)
class Ensemble:
    """One reading, several seeds.

    Attributes
    ----------
    reading : Reading
        The reading.
    members : tuple of Reproduction
        One per seed.
    """

    reading: Reading
    members: tuple[Reproduction, ...]

    @property
    def passes(self) -> dict[str, int]:
        """Seeds with which each observation holds, by its id."""
        boards = [member.scoreboard for member in self.members]
        return {
            row.id: sum(board.rows[i].passed is True for board in boards)
            for i, row in enumerate(boards[0].rows)
        }

    @property
    def score(self) -> Spread:
        """Number of observations that hold at once."""
        return spread("observations that hold", [float(m.scoreboard.passed) for m in self.members])

    @property
    def first_score(self) -> Spread:
        """The same by the rules that were frozen first."""
        told = [float(m.scoreboard.first_passed) for m in self.members]
        return spread("observations that hold by the first rules", told)

    @property
    def fresh(self) -> Spread:
        """Number of observations that hold with the seeds that no reading was chosen by."""
        boards = [m.scoreboard for m in self.members if m.seed not in CHOOSING]
        return spread("observations that hold with fresh seeds", [float(b.passed) for b in boards])

    @property
    def scores(self) -> tuple[Spread, ...]:
        """All three."""
        return self.score, self.first_score, self.fresh

    @property
    def told(self) -> str:
        """Its scores and its fitted constants, in words."""
        by_seed = ", ".join(str(m.scoreboard.passed) for m in self.members)
        first = ", ".join(str(m.scoreboard.first_passed) for m in self.members)
        fitted = self.reading.constants
        return (
            f"With seeds {', '.join(str(m.seed) for m in self.members)} {by_seed} observations hold, mean "
            f"{self.score.mean:.3g}; with those that it was not chosen by {self.fresh.mean:.3g}. By the "
            f"first rules {first}, mean {self.first_score.mean:.3g}. Fitted constants: {len(fitted)}"
            + (f" ({', '.join(fitted)})." if fitted else ".")
        )

    def spreads(self) -> list[Spread]:
        """Index and gyri of every case of the paper's figures, and both thresholds."""
        found = []
        common = set.intersection(*(set(member.rows) for member in self.members))
        for case in sorted(common):
            rows = [member.rows[case] for member in self.members if member.rows[case].is_complete]
            found += _of_case(case, rows) if rows else []
        for stiffness in BOTH:
            brackets = [visible_bracket(member.rows, stiffness) for member in self.members]
            values = [bracket.value for bracket in brackets if bracket is not None]
            name = f"growth ratio of visible folds, E = {ratio_text(stiffness)}"
            found += [spread(name, values)] if values else []
        return found


def repeat(
    simulations: Simulations,
    base: Config,
    reading: Reading,
    seeds: Sequence[int] = SEEDS,
    *,
    stability: bool = True,
) -> Ensemble:
    """Reproduce the paper with several seeds.

    Parameters
    ----------
    simulations : Simulations
        Who computes.
    base : Config
        Everything that no reading changes.
    reading : Reading
        The reading.
    seeds : sequence of int
        Seeds of the node jitter.
    stability : bool
        Whether the loss of stability is located too, which no seed changes.

    Returns
    -------
    Ensemble
    """
    members = [reproduce(simulations, base, reading, seed=seed, stability=stability) for seed in seeds]
    return Ensemble(reading, tuple(members))


def best_first(ensembles: Iterable[Ensemble]) -> list[Ensemble]:
    """By the mean number of observations that hold; equals stay in their order."""
    return sorted(ensembles, key=lambda ensemble: -ensemble.score.mean)


def spread(name: str, values: Sequence[float]) -> Spread:
    """Mean and sample standard deviation of finite values."""
    finite = [value for value in values if math.isfinite(value)]
    if not finite:
        return Spread(name, math.nan, math.nan, 0)
    return Spread(name, fmean(finite), stdev(finite) if len(finite) > 1 else 0.0, len(finite))


def _of_case(case: Case, rows: Sequence[Row]) -> list[Spread]:
    gi = spread(f"GI, {case}", [row.gi for row in rows])
    return [gi, spread(f"gyri, {case}", [float(row.n_gyri) for row in rows])]
