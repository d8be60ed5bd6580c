"""Rules of the observations that are patterns: P6 to P11, P14 to P18."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Final

from gyrify.paper.cases import BOTH, EQUAL, GROWTH, SOFT, STIFFNESS, THICK, THICKNESS, Case, ratio_text
from gyrify.paper.checks import Check, Rows, Verdict, check, shown
from gyrify.paper.row import Row
from gyrify.paper.rules_numbers import SAME
from gyrify.paper.visible_folds import STATES, growth_series, next_states

# Crown over fundus thickness of a cortex that stays within a tenth of its mean, as for phenotypes.
UNIFORM: Final = 1.222
# Half way between a sine wave, 1, and the cusps of |cos|, about 2.
CUSPED: Final = 1.5
HEALTHY: Final = ("normal", "sinusoidal")
UNFOLDED: Final = ("smooth", "lissencephaly")
# Geometric mean of as many and twice as many; sulci that are very shallow beside others; and gyri that have
# merged: as wide as a whole normal fold, twice as flat as a cosine. The numbers are those of phenotypes.
MORE: Final = 2**0.5
SHALLOW: Final = 0.5
WIDE: Final = 1.0
FLAT: Final = 0.667
VERY_THICK: Final = (Case(SOFT, thickness=THICK[0]), Case(EQUAL, thickness=THICK[1]))


def p6(rows: Rows) -> Verdict:
    """Smooth at 1/3."""
    return labelled(rows, (Case(STIFFNESS[0]),), "smooth")


def p7(rows: Rows) -> Verdict:
    """Lissencephaly at 1/2.61."""
    return labelled(rows, (Case(STIFFNESS[1]),), "lissencephaly")


def p8(rows: Rows) -> Verdict:
    """Pachygyria at 1/2: shallow sulci between gyri that have merged."""
    case, one = Case(STIFFNESS[2]), Case(SOFT)
    checks = (
        _folded(rows, case),
        check(
            rows,
            (case, one),
            lambda a, b: a.depth <= SHALLOW * b.depth,
            lambda a, b: f"mean depth {a.depth:.1f} mm against {b.depth:.1f} at {one}",
        ),
        check(
            rows,
            (case, one),
            lambda a, b: MORE * a.n_gyri <= b.n_gyri or (a.breadth >= WIDE and a.flatness >= FLAT),
            lambda a, b: f"{a.n_gyri} gyri, flat to {a.flatness:.2f}, against {b.n_gyri} at {one}",
        ),
    )
    text = shown(rows, (case,), lambda r: f"{r.n_gyri} gyri, {r.depth:.1f} mm, GI {r.gi:.3f}, {r.label}")
    return Verdict(text, checks)


def p9(rows: Rows) -> Verdict:
    """Cusped sulci and thicker crowns."""
    checks = []
    for case in (Case(SOFT), Case(EQUAL)):
        checks += [
            _one(
                rows, case, lambda r: r.crown_fundus > UNIFORM, lambda r: f"crown/fundus {r.crown_fundus:.2f}"
            ),
            _one(rows, case, lambda r: r.sharpness >= CUSPED, lambda r: f"sharpness {r.sharpness:.2f}"),
        ]
    cases = (Case(SOFT), Case(EQUAL))
    text = shown(rows, cases, lambda r: f"crown/fundus {r.crown_fundus:.2f}, sharpness {r.sharpness:.1f}")
    return Verdict(text, tuple(checks))


def p10(rows: Rows) -> Verdict:
    """Sinusoidal folds of a stiff cortex."""
    cases = tuple(Case(stiffness) for stiffness in STIFFNESS[5:])
    verdict = labelled(rows, cases, "sinusoidal")
    return Verdict(shown(rows, cases, lambda r: f"{r.label} ({r.crown_fundus:.2f})"), verdict.checks)


def p11(rows: Rows) -> Verdict:
    """Index over the growth ratio."""
    checks: list[Check] = []
    for stiffness in BOTH:
        cases = [Case(stiffness, growth) for growth in GROWTH]
        checks += [_rises(rows, pair) for pair in pairwise(cases)]
        checks += [_slows(rows, (a, b, c)) for a, b, c in zip(cases, cases[1:], cases[2:], strict=False)]
        checks.append(_has_label(rows, cases[0], ("smooth",)))
        checks += [_has_label(rows, case, HEALTHY) for case in cases[2:]]
    series = (shown(rows, [Case(e, g) for g in GROWTH], lambda r: f"{r.gi:.3f}") for e in BOTH)
    return Verdict("; ".join(series), tuple(checks))


def p14(rows: Rows) -> Verdict:
    """Four states in order."""
    checks: list[Check] = []
    for stiffness in BOTH:
        checks += _ordered(rows, stiffness)
    texts = (" → ".join(_runs_of(rows, stiffness)) or "–" for stiffness in BOTH)
    return Verdict("; ".join(texts), tuple(checks))


def p15(rows: Rows) -> Verdict:
    """Index largest at the standard thickness."""
    checks = [_lower(rows, stiffness, t) for stiffness in BOTH for t in (0.75, 3.0)]
    series = (shown(rows, [Case(e, thickness=t) for t in THICKNESS], lambda r: f"{r.gi:.3f}") for e in BOTH)
    return Verdict("; ".join(series), tuple(checks))


def p16(rows: Rows) -> Verdict:
    """A thin cortex."""
    return against_standard(
        rows,
        0.75,
        (),
        lambda thin, one: thin.n_gyri >= MORE * one.n_gyri,
        lambda thin, one: thin.depth < one.depth,
    )


def p17(rows: Rows) -> Verdict:
    """A thick cortex."""
    return against_standard(
        rows,
        3.0,
        (),
        lambda thick, one: MORE * thick.n_gyri <= one.n_gyri and thick.width > one.width,
        lambda thick, one: thick.depth > one.depth,
    )


def p18(rows: Rows) -> Verdict:
    """A very thick cortex."""
    checks = [_has_label(rows, case, UNFOLDED) for case in VERY_THICK]
    checks += [_folded(rows, Case(e, thickness=3.0)) for e in BOTH]
    text = shown(rows, VERY_THICK, lambda r: f"{r.label} (GI {r.gi:.3f})")
    return Verdict(text, (*checks, *softer_earlier(rows)))


def softer_earlier(rows: Rows) -> list[Check]:
    """At both thicknesses the softer cortex has no higher index."""
    return [
        check(
            rows,
            (Case(SOFT, thickness=t), Case(EQUAL, thickness=t)),
            lambda soft, equal: soft.gi <= equal.gi + SAME,
            lambda soft, equal, t=t: (
                f"at T = {t} mm the softer cortex has GI {soft.gi:.3f}, the other {equal.gi:.3f}"
            ),
        )
        for t in THICK
    ]


def _folded(rows: Rows, case: Case) -> Check:
    return _one(rows, case, lambda r: r.label not in UNFOLDED, lambda r: f"{r.label} ({r.because})")


def _one(rows: Rows, case: Case, test: Callable[[Row], bool], text: Callable[[Row], str]) -> Check:
    return check(rows, (case,), test, lambda row: f"{text(row)} at {case}")


def _has_label(rows: Rows, case: Case, labels: tuple[str, ...]) -> Check:
    return _one(rows, case, lambda r: r.label in labels, lambda r: f"{r.label} ({r.because})")


def labelled(rows: Rows, cases: tuple[Case, ...], label: str) -> Verdict:
    text = shown(rows, cases, lambda row: f"{row.label} (GI {row.gi:.3f})")
    return Verdict(text, tuple(_has_label(rows, case, (label,)) for case in cases))


def _rises(rows: Rows, pair: tuple[Case, Case]) -> Check:
    return check(
        rows,
        pair,
        lambda a, b: b.gi > a.gi,
        lambda a, b: f"GI goes from {a.gi:.3f} to {b.gi:.3f} between {pair[0]} and G = {pair[1].growth:g}",
    )


def _slows(rows: Rows, three: tuple[Case, Case, Case]) -> Check:
    first, second = (three[i + 1].growth - three[i].growth for i in (0, 1))
    return check(
        rows,
        three,
        lambda a, b, c: (c.gi - b.gi) / second < (b.gi - a.gi) / first,
        lambda a, b, c: f"GI rises faster after {three[1]} ({a.gi:.3f}, {b.gi:.3f}, {c.gi:.3f})",
    )


def _ordered(rows: Rows, stiffness: float) -> list[Check]:
    """Ends of the series, no step back, and no state left out once gaps are searched."""
    ends = [
        _has_label(rows, Case(stiffness, 1.0), ("smooth",)),
        _has_label(rows, Case(stiffness), ("normal",)),
    ]
    labels, at = _runs_of(rows, stiffness), f"at E = {ratio_text(stiffness)}"
    told = f"{at}: {' → '.join(labels)}"
    order = [STATES.index(label) if label in STATES else -1 for label in labels]
    if -1 in order or order != sorted(set(order)):
        return [*ends, Check(False, f"{told} is not the paper's order")]
    if labels == list(STATES):
        return [*ends, Check(True, told)]
    unknown = [case for case in (Case(stiffness, 1.0), Case(stiffness)) if case not in rows]
    todo = tuple(unknown or next_states(rows, stiffness))
    left_out = ", ".join(state for state in STATES if state not in labels)
    return [*ends, Check(None if todo else False, f"{at} no {left_out} is found", todo)]


def _runs_of(rows: Rows, stiffness: float) -> list[str]:
    """Phenotypes along the series, repetitions dropped."""
    labels = [rows[case].label for case in growth_series(rows, stiffness)]
    return [label for i, label in enumerate(labels) if i == 0 or label != labels[i - 1]]


def _lower(rows: Rows, stiffness: float, thickness: float) -> Check:
    return check(
        rows,
        (Case(stiffness, thickness=thickness), Case(stiffness)),
        lambda other, one: other.gi < one.gi,
        lambda other, one: (
            f"GI {other.gi:.3f} at T = {thickness} mm against {one.gi:.3f} at {Case(stiffness)}"
        ),
    )


def against_standard(
    rows: Rows,
    thickness: float,
    labels: tuple[str, ...],
    number: Callable[[Row, Row], bool],
    depth: Callable[[Row, Row], bool],
) -> Verdict:
    """Number, depth and index beside those of the standard thickness; of these labels, or else folded."""
    checks = []
    for stiffness in BOTH:
        case = Case(stiffness, thickness=thickness)
        pair = (case, Case(stiffness))
        checks += [
            check(rows, pair, number, lambda a, b, case=case: _gyri_text(a, b, case)),
            check(
                rows,
                pair,
                depth,
                lambda a, b, case=case: f"mean depth {a.depth:.1f} mm against {b.depth:.1f} at {case}",
            ),
            _lower(rows, stiffness, thickness),
            _has_label(rows, case, labels) if labels else _folded(rows, case),
        ]
    cases = [Case(stiffness, thickness=thickness) for stiffness in BOTH]
    text = shown(rows, cases, lambda r: f"{r.n_gyri} gyri, {r.depth:.1f} mm, GI {r.gi:.3f}, {r.label}")
    return Verdict(text, tuple(checks))


def _gyri_text(a: Row, b: Row, case: Case) -> str:
    return f"{a.n_gyri} gyri of {a.width:.1f} mm against {b.n_gyri} of {b.width:.1f} mm at {case}"
