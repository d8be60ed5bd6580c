"""Thresholds read off runs, and the runs that are asked for next."""

from __future__ import annotations

import pytest

from gyrify.paper import Case, Row
from gyrify.paper.cases import EQUAL, PAPER_THRESHOLD, SOFT, threshold_ends
from gyrify.paper.visible_folds import (
    VISIBLE,
    next_states,
    next_thresholds,
    threshold_verdict,
    visible_bracket,
)


def model(case: Case, onset: float) -> Row:
    """A slice that folds gradually from some growth ratio on."""
    beyond = case.growth - onset
    names = ((0.0, "smooth"), (0.1, "lissencephaly"), (0.4, "pachygyria"), (10.0, "normal"))
    label = next(name for end, name in names if beyond <= end)
    return Row(gi=1.0 + max(beyond, 0.0), label=label)


@pytest.mark.parametrize("onset", [1.31, 1.71, 2.4, 3.5])
def test_bisection_locates_a_threshold(onset: float) -> None:
    rows = {case: model(case, onset) for case in (Case(SOFT, 1.0), Case(SOFT))}
    while todo := next_thresholds(rows, SOFT):
        assert len(todo) == 1
        rows |= {case: model(case, onset) for case in todo}
    bracket = visible_bracket(rows, SOFT)
    assert bracket is not None
    assert bracket.low <= onset + VISIBLE - 1 <= bracket.high
    assert bracket.high - bracket.low <= 0.01 * bracket.value
    assert len(rows) < 12


@pytest.mark.parametrize(
    ("onset", "passed"), [(1.5, False), (1.65, True), (1.7, True), (1.9, False), (9.0, False)]
)
def test_two_runs_at_the_ends_decide_agreement(onset: float, passed: bool) -> None:
    rows = {case: model(case, onset) for case in threshold_ends(EQUAL)}
    assert threshold_verdict(rows, EQUAL).passed is passed


@pytest.mark.parametrize(
    ("smooth", "folded", "passed"),
    [
        ([1.6], [1.62], False),
        ([1.8], [1.85], False),
        ([1.63], [1.79], True),
        ([1.6], [1.7], None),
        ([1.7], [1.81], None),
        ([1.0], [], None),
        ([3.6], [], False),
        # what is smooth again beyond the first folds tells nothing of them
        ([1.65, 1.9], [1.75, 2.5], True),
        ([1.0, 1.9], [1.75, 2.5], None),
    ],
)
def test_a_bracket_decides_only_if_it_lies_inside_or_outside_of_what_agrees(
    smooth: list[float], folded: list[float], passed: bool | None
) -> None:
    """5 % about 1.71 are 1.6245 to 1.7955."""
    rows = {Case(EQUAL, growth): Row(gi=VISIBLE) for growth in smooth}
    rows |= {Case(EQUAL, growth): Row(gi=VISIBLE + 1e-3) for growth in folded}
    assert threshold_verdict(rows, EQUAL).passed is passed


def test_folds_are_seen_above_an_index_of_1005_and_first_where_they_first_are() -> None:
    gi = {1.0: 1.005, 1.5: 1.0051, 2.0: 1.0, 2.5: 1.4}
    rows = {Case(EQUAL, growth): Row(gi=index) for growth, index in gi.items()}
    bracket = visible_bracket(rows, EQUAL)
    assert bracket is not None
    assert (bracket.low, bracket.high) == (1.0, 1.5)
    assert visible_bracket({Case(EQUAL, 1.0): Row(gi=1.2), Case(EQUAL, 2.0): Row(gi=1.3)}, EQUAL) is None
    above = {Case(EQUAL, 3.0): Row(gi=1.0), Case(EQUAL, 36.0): Row(gi=1.4)}
    assert visible_bracket(above, EQUAL) is None


def test_a_wide_bracket_decides_nothing() -> None:
    rows = {Case(EQUAL, 1.0): Row(), Case(EQUAL): Row(gi=1.4)}
    assert threshold_verdict(rows, EQUAL).passed is None


def test_failed_runs_and_other_tissues_do_not_count() -> None:
    rows = {case: model(case, 1.7) for case in threshold_ends(EQUAL)}
    rows |= {
        Case(EQUAL, 1.65): Row("failed"),
        Case(SOFT, 1.66): Row(gi=2.0),
        Case(EQUAL, 1.67, 3.0): Row(gi=2.0),
    }
    assert threshold_verdict(rows, EQUAL).passed is True
    bracket = visible_bracket(rows, EQUAL)
    assert bracket is not None
    assert bracket.value == pytest.approx(PAPER_THRESHOLD[EQUAL])


def test_states_that_are_jumped_over_are_searched_for() -> None:
    rows = {case: model(case, 1.7) for case in (Case(EQUAL, 1.0), Case(EQUAL))}
    found = set()
    while todo := next_states(rows, EQUAL):
        rows |= {case: model(case, 1.7) for case in todo}
        found |= {rows[case].label for case in todo}
    assert found >= {"lissencephaly", "pachygyria"}
    labels = [rows[case].label for case in sorted(rows)]
    assert [label for i, label in enumerate(labels) if label not in labels[:i]] == [
        "smooth",
        "lissencephaly",
        "pachygyria",
        "normal",
    ]


def test_the_search_ends_where_a_state_is_not_there() -> None:
    """A jump from smooth to normal: halved until the neighbours are a per cent apart."""
    rows = {Case(EQUAL, 1.0): Row(), Case(EQUAL): Row(gi=1.4, label="normal")}
    while todo := next_states(rows, EQUAL):
        rows |= {case: Row() if case.growth < 2 else Row(gi=1.4, label="normal") for case in todo}
    assert len(rows) == 10
