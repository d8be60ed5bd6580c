"""The screen gives up readings only where that cannot change the best three."""

from __future__ import annotations

import time
from collections.abc import Iterator
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import pytest
from fake_bench import FakeBench

from gyrify.config import Config
from gyrify.paper.candidate import Candidate
from gyrify.paper.cases import EQUAL, SOFT, Case
from gyrify.paper.reading import Mechanics, Reading, grid, variants
from gyrify.paper.reproduce import reproduce
from gyrify.paper.row import GI_DEFINITIONS
from gyrify.paper.screen import BEST, ScreenProgress, _live, ranked, screen

BASE = Config()


def some(step: int, start: int = 0) -> list[Mechanics]:
    return grid()[start::step]


def candidates(mechanics: list[Mechanics]) -> list[Candidate]:
    return [Candidate(BASE, one) for one in mechanics]


def exhaustive(mechanics: list[Mechanics]) -> list[int]:
    """Observations that hold at once in each, with everything run; 0 where a reading is impossible."""
    found = []
    for one in mechanics:
        if not candidate_is_possible(one):
            continue
        bench = FakeBench()
        boards = [
            reproduce(bench, BASE, Reading(one, gi), stability=False).scoreboard for gi in GI_DEFINITIONS
        ]
        assert all(board.open == 0 for board in boards)
        found.append(max(board.passed for board in boards))
    return sorted(found, reverse=True)


def candidate_is_possible(mechanics: Mechanics) -> bool:
    one = Candidate(BASE, mechanics)
    return bool(one.ask())


@pytest.mark.parametrize("start", range(4))
def test_the_best_three_are_those_of_an_exhaustive_search(start: int) -> None:
    mechanics = some(9, start)
    bench = FakeBench(workers=2)
    found = screen(bench, BASE, candidates=candidates(mechanics))
    assert found.is_complete
    assert found.live == 0
    assert [c.passed for c in found.candidates[:BEST]] == exhaustive(mechanics)[:BEST]
    assert not any(c.is_open for c in found.candidates[:BEST])
    worst = found.candidates[BEST - 1].passed
    assert all(c.bound <= worst for c in found.candidates[BEST:] if c.is_open)


def test_it_takes_fewer_runs_than_all() -> None:
    mechanics = some(3)
    bench = FakeBench(workers=2)
    screen(bench, BASE, candidates=candidates(mechanics))
    everything = FakeBench()
    for one in mechanics:
        if candidate_is_possible(one):
            reproduce(everything, BASE, Reading(one), stability=False)
    assert 2 * len(mechanics) < len(bench.asked) < 0.8 * len(everything.asked)


def test_both_standard_slices_are_run_for_every_reading() -> None:
    bench = FakeBench(workers=1)
    mechanics = [one for one in some(10) if candidate_is_possible(one)]
    found = screen(bench, BASE, candidates=candidates(mechanics))
    assert bench.asked[0].parameters["material.stiffness_ratio"] in (SOFT, EQUAL)
    for candidate in found.candidates:
        assert {Case(SOFT), Case(EQUAL)} <= set(candidate.rows["closing"])


def test_it_stops_in_time_and_goes_on() -> None:
    mechanics = some(8)
    bench = FakeBench(workers=1)
    seen: list[ScreenProgress] = []

    def tell(progress: ScreenProgress) -> None:
        seen.append(progress)

    stopped = screen(bench, BASE, until=time.perf_counter(), candidates=candidates(mechanics))
    assert not stopped.is_complete
    assert stopped.live == len(mechanics)
    assert not bench.asked
    done = screen(bench, BASE, candidates=candidates(mechanics), tell=tell)
    n_asked = len(bench.asked)
    again = screen(bench, BASE, candidates=candidates(mechanics))
    assert len(bench.asked) == n_asked
    assert [c.reading for c in again.candidates] == [c.reading for c in done.candidates]
    assert seen[-1].live == 0
    assert seen[-1].best == done.candidates[0].passed


def test_impossible_readings_are_named() -> None:
    impossible = [one for one in grid() if not candidate_is_possible(one)]
    assert impossible
    assert {one.out_of_plane for one in impossible} == {"generalised"}
    found = screen(FakeBench(), BASE, candidates=candidates([*some(20), impossible[0]]))
    (named,) = [c for c in found.candidates if c.mechanics == impossible[0]]
    assert "generalised" in named.impossible
    assert not named.is_open


def test_a_failed_run_fails_what_it_decides() -> None:
    bench = FakeBench()
    one = Candidate(BASE, Mechanics(number=5.0))
    while points := one.ask():
        bench.run(points)
        one.learn(bench)
    rows = {row.id: row for row in one.boards["closing"].rows}
    assert rows["P11"].passed is False
    assert "Stalled." in rows["P11"].note


def test_all_that_differs_in_one_thing_is_tried_about_the_best(monkeypatch: pytest.MonkeyPatch) -> None:
    def few() -> Iterator[Mechanics]:
        return iter(some(12))

    monkeypatch.setattr("gyrify.paper.screen.grid", few)
    found = screen(FakeBench(), BASE)
    tried = {c.mechanics for c in found.candidates}
    assert len(tried) == len(found.candidates)
    assert set(some(12)) < tried
    for candidate in found.candidates[:BEST]:
        assert set(variants(candidate.mechanics)) < tried
    assert found.is_complete


def test_equals_are_ranked_by_the_standard_indices() -> None:
    bench, pool = FakeBench(), candidates(some(6))
    found = screen(bench, BASE, candidates=pool).candidates
    assert list(found) == ranked(pool)
    for one, other in pairwise(found):
        assert (-one.passed, -one.bound, one.misfit) <= (-other.passed, -other.bound, other.misfit)
    assert found[0].misfit == pytest.approx(
        abs(found[0].rows[found[0].gi][Case(SOFT)].gi - 1.29)
        + abs(found[0].rows[found[0].gi][Case(EQUAL)].gi - 1.37)
    )


def made_up(name: str, passed: int, bound: int, misfit: float = 1.0) -> Any:
    return SimpleNamespace(
        mechanics=name, passed=passed, bound=bound, misfit=misfit, is_open=bound > passed, reading=name
    )


@pytest.mark.parametrize(("bound", "is_live"), [(4, False), (5, False), (6, True), (9, True)])
def test_a_reading_is_given_up_once_it_cannot_pass_the_third_best(bound: int, is_live: bool) -> None:
    """The best three hold 8, 7 and 5, and are decided; to reach 5 changes nothing, to reach 6 does."""
    best = [made_up("a", 8, 8), made_up("b", 7, 7), made_up("c", 5, 5)]
    last = made_up("d", 2, bound)
    assert (last in _live([*best, last])) is is_live
    assert _live(best) == []


def test_an_open_reading_among_the_best_is_run_to_its_end_and_fewer_than_three_give_nobody_up() -> None:
    best = [made_up("a", 8, 8), made_up("b", 7, 9), made_up("c", 5, 6)]
    low = made_up("d", 1, 5)
    assert [c.mechanics for c in _live([*best, low])] == ["b", "c"]
    assert [c.mechanics for c in _live([made_up("a", 8, 8), low])] == ["d"]


def test_the_rank_is_by_what_holds_then_what_can_then_the_indices_then_the_name() -> None:
    order = [
        made_up("z", 3, 3), made_up("y", 2, 5), made_up("x", 2, 4, 0.1), made_up("u", 2, 4, 0.2),
        made_up("v", 2, 4, 0.2),
    ]  # fmt: skip
    assert ranked(reversed(order)) == order
