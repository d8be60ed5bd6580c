"""Growth ratio from which folds are seen, read off the runs there are, and which runs would tell more."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Final

from gyrify.paper.cases import AGREES, LOCATED, PAPER_THRESHOLD, STANDARD_GROWTH, Case, threshold_ends
from gyrify.paper.checks import Check, Rows, Verdict

# Gyrification index above which folding is obvious.
VISIBLE: Final = 1.005
# Higher levels at which the growth ratio is told beside it, since no sentence of the paper has a number.
HIGHER: Final = (1.01, 1.02)
STATES: Final = ("smooth", "lissencephaly", "pachygyria", "normal")


@dataclass(frozen=True)
class Bracket:
    """Growth ratios between which folds begin to be seen.

    Attributes
    ----------
    low, high : float
        The highest that is known to be smooth below the first folded one, and that one [-].
    """

    low: float
    high: float

    @property
    def value(self) -> float:
        """Their middle [-]."""
        return 0.5 * (self.low + self.high)

    @property
    def is_narrow(self) -> bool:
        """Whether the threshold counts as located."""
        return self.high - self.low <= LOCATED * self.value


def growth_series(rows: Rows, stiffness: float) -> list[Case]:
    """Cases of the standard thickness up to the standard growth ratio that came to their end, in order."""
    return sorted(
        case
        for case, row in rows.items()
        if case == Case(stiffness, case.growth) and case.growth <= STANDARD_GROWTH and row.is_complete
    )


def visible_bracket(rows: Rows, stiffness: float, level: float = VISIBLE) -> Bracket | None:
    """Where the index first passes a level; None where it does so nowhere, or everywhere.

    Parameters
    ----------
    rows : mapping
        What is known.
    stiffness : float
        Stiffness ratio [-].
    level : float
        Gyrification index from which folds count as seen [-].

    Returns
    -------
    Bracket or None
    """
    for below, above in pairwise(growth_series(rows, stiffness)):
        if rows[below].gi <= level < rows[above].gi:
            return Bracket(below.growth, above.growth)
    return None


def threshold_verdict(rows: Rows, stiffness: float) -> Verdict:
    """Whether folds begin to be seen where the paper sees them.

    Decided as soon as the whole bracket lies inside, or outside, what agrees.

    Parameters
    ----------
    rows : mapping
        What is known.
    stiffness : float
        Stiffness ratio [-].

    Returns
    -------
    Verdict
    """
    paper = PAPER_THRESHOLD[stiffness]
    least, most = paper * (1 - AGREES), paper * (1 + AGREES)
    known = growth_series(rows, stiffness)
    smooth = [case.growth for case in known if rows[case].gi <= VISIBLE]
    folded = [case.growth for case in known if rows[case].gi > VISIBLE]
    low = max((growth for growth in smooth if growth < min(folded, default=float("inf"))), default=0.0)
    high = min(folded, default=float("inf"))
    ours = _ours(low, high, bool(known))
    if high <= least or low >= most:
        return Verdict(ours, (Check(False, f"{ours}, not within 5 % of {paper}"),))
    inside = least <= low * (1 + 1e-9) and high <= most * (1 + 1e-9)
    if inside:
        return Verdict(ours, (Check(True, ours),))
    ends = tuple(case for case in threshold_ends(stiffness) if case not in rows)
    missing = ends or tuple(next_thresholds(rows, stiffness))
    return Verdict(ours, (Check(None, f"not yet located: {ours}", missing),))


def next_thresholds(rows: Rows, stiffness: float, level: float = VISIBLE) -> list[Case]:
    """The one case that would locate the threshold better; none where it is located, or not there."""
    bracket = visible_bracket(rows, stiffness, level)
    return [] if bracket is None or bracket.is_narrow else [Case(stiffness, bracket.value)]


def next_higher(rows: Rows, stiffness: float) -> list[Case]:
    """The same at the higher levels, each case once."""
    return list(dict.fromkeys(c for level in HIGHER for c in next_thresholds(rows, stiffness, level)))


def higher_levels(rows: Rows, stiffness: float) -> str:
    """Growth ratios at the higher levels and whether they would agree, in words."""
    paper, told = PAPER_THRESHOLD[stiffness], []
    for level in HIGHER:
        bracket = visible_bracket(rows, stiffness, level)
        if bracket is not None:
            agrees = abs(bracket.value - paper) <= AGREES * paper
            told.append(f"{level:g} is passed at {bracket.value:.3f} ({'' if agrees else 'not '}within 5 %)")
    return f"GI {' and '.join(told)}" if told else ""


def next_states(rows: Rows, stiffness: float) -> list[Case]:
    """Cases between neighbours, more than 1 % apart, whose phenotypes leave a state of the paper out."""
    found = []
    for below, above in pairwise(growth_series(rows, stiffness)):
        labels = rows[below].label, rows[above].label
        if not set(labels) <= set(STATES) or STATES.index(labels[1]) - STATES.index(labels[0]) < 2:
            continue
        if above.growth - below.growth > LOCATED * above.growth:
            found.append(Case(stiffness, 0.5 * (below.growth + above.growth)))
    return found


def _ours(low: float, high: float, is_known: bool) -> str:
    if not is_known:
        return "–"
    if high == float("inf"):
        return f"nothing is seen up to {low:.3g}"
    return f"{0.5 * (low + high):.3f} ({low:.3f} to {high:.3f})" if low else f"below {high:.3f}"
