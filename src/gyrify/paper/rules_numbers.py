"""Rules of the observations that are formulas or single numbers: P1 to P5, P12, P13."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

from gyrify.metrics import growth_ratio_from_scaling, growth_ratio_from_volumes, length_increase
from gyrify.paper.cases import EQUAL, SOFT, STIFFNESS, Case
from gyrify.paper.checks import Check, Rows, Verdict, check, shown
from gyrify.paper.visible_folds import threshold_verdict

GI_AGREES: Final = 0.05
# A fall of the index that is none, and the least rise that is one.
SAME: Final = 1e-3
SEEN: Final = 5e-3
# Scatter over seeds of the difference of two indices: √2 times the 0.0065 of the standard slice.
SCATTER: Final = 0.01


def p1(rows: Rows) -> Verdict:
    """Growth ratio from the scaling law."""
    del rows
    ours = growth_ratio_from_scaling()
    return Verdict(f"{ours:.3f}", (Check(abs(ours - 3.6) <= 0.05, f"the formula gives {ours:.3f}"),))


def p2(rows: Rows) -> Verdict:
    """Growth ratio from volumes, and the increase in length."""
    del rows
    ratio, length = growth_ratio_from_volumes(), length_increase()
    checks = (
        Check(abs(ratio - 2.8) <= 0.05, f"the volumes give {ratio:.3f}"),
        Check(abs(length - 1.71) <= 0.005, f"the length increases {length:.3f}-fold"),
    )
    return Verdict(f"{ratio:.2f}; {length:.2f}", checks)


def p3(rows: Rows) -> Verdict:
    """Index of the standard slice, soft cortex."""
    return _index(rows, Case(SOFT), 1.29)


def p4(rows: Rows) -> Verdict:
    """Index of the standard slice."""
    return _index(rows, Case(EQUAL), 1.37)


def p5(rows: Rows, fall: float = SCATTER) -> Verdict:
    """Index over the stiffness ratio; a fall within the scatter over seeds is none."""
    cases = [Case(stiffness) for stiffness in STIFFNESS]
    steps = [
        check(
            rows,
            pair,
            lambda a, b: b.gi >= a.gi - fall,
            lambda a, b, pair=pair: f"GI falls from {a.gi:.3f} to {b.gi:.3f} between {pair[0]} and {pair[1]}",
        )
        for pair in pairwise(cases)
    ]
    whole = check(
        rows,
        (cases[0], cases[-1]),
        lambda a, b: b.gi > a.gi + SEEN,
        lambda a, b: f"GI is {a.gi:.3f} at the lowest ratio and {b.gi:.3f} at the highest",
    )
    return Verdict(shown(rows, cases, lambda row: f"{row.gi:.3f}"), (*steps, whole))


def p12(rows: Rows) -> Verdict:
    """Threshold of obvious folding."""
    return threshold_verdict(rows, EQUAL)


def p13(rows: Rows) -> Verdict:
    """Threshold of obvious folding, soft cortex."""
    return threshold_verdict(rows, SOFT)


def _index(rows: Rows, case: Case, paper: float) -> Verdict:
    found = check(
        rows,
        (case,),
        lambda row: abs(row.gi - paper) <= GI_AGREES,
        lambda row: (
            f"GI = {row.gi:.3f} at {case} is {abs(row.gi - paper):.3f} "
            f"{'above' if row.gi > paper else 'below'} {paper}"
        ),
    )
    return Verdict(shown(rows, (case,), lambda row: f"{row.gi:.3f}"), (found,))
