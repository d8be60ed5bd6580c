"""Rules as they were first frozen, where they were corrected since: P5, P8, P16 to P18."""

from __future__ import annotations

from gyrify.paper import rules_numbers
from gyrify.paper.cases import STIFFNESS, Case
from gyrify.paper.checks import Rows, Verdict, shown
from gyrify.paper.rules_numbers import SAME
from gyrify.paper.rules_patterns import VERY_THICK, against_standard, labelled, softer_earlier


def p5(rows: Rows) -> Verdict:
    """Index over the stiffness ratio."""
    return rules_numbers.p5(rows, SAME)


def p8(rows: Rows) -> Verdict:
    """Pachygyria at 1/2."""
    return labelled(rows, (Case(STIFFNESS[2]),), "pachygyria")


def p16(rows: Rows) -> Verdict:
    """A thin cortex."""
    return against_standard(
        rows,
        0.75,
        ("polymicrogyria",),
        lambda thin, one: thin.n_gyri > one.n_gyri,
        lambda thin, one: thin.depth < one.depth,
    )


def p17(rows: Rows) -> Verdict:
    """A thick cortex."""
    return against_standard(
        rows,
        3.0,
        ("pachygyria",),
        lambda thick, one: thick.n_gyri < one.n_gyri and thick.width > one.width,
        lambda thick, one: thick.depth > one.depth,
    )


def p18(rows: Rows) -> Verdict:
    """A very thick cortex."""
    verdict = labelled(rows, VERY_THICK, "lissencephaly")
    text = shown(rows, VERY_THICK, lambda r: f"{r.label} (GI {r.gi:.3f})")
    return Verdict(text, (*verdict.checks, *softer_earlier(rows)))
