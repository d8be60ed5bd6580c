"""Roots, brackets and branches of onset and thresholds, on curves that are known."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import gyrify.run.onset.smooth as smooth
from gyrify.config import Config
from gyrify.errors import SolveError
from gyrify.metrics import Measures
from gyrify.metrics.quantities import measured_in
from gyrify.run.onset.crossing import LowestEigenvalue, Root
from gyrify.run.onset.smooth import SmoothBranch, SmoothState
from gyrify.solve.result import Result, Solution, Stats
from gyrify.solve.stability import Eigenpair
from gyrify.threshold.critical import _is_beyond
from gyrify.threshold.crossings import Crossing, Scanned, main_crossing
from gyrify.threshold.visible_scan import VisibleScan

Curve = Callable[[float], float]


def found(
    eigenvalue: Curve, low: float, high: float, *, was_unstable: bool = False
) -> tuple[Root, list[float]]:
    """Root of a curve to a millionth, and where it was asked for."""
    asked: list[float] = []

    def at(value: float) -> Any:
        def tangent(_: object) -> Any:
            asked.append(value)
            return SimpleNamespace(lowest=lambda: Eigenpair(eigenvalue(value), np.zeros((1, 2)), 0.0))

        return SimpleNamespace(value=value, tangent=tangent)

    lowest = LowestEigenvalue(SimpleNamespace(at=at), None)  # type: ignore[arg-type]
    return lowest.root(low, high, 1e-6, was_unstable), asked


CURVES = {
    "a line": (lambda t: 1.0 - t, 1.0),
    "an exponential": (lambda t: 2.0 - np.exp(t), np.log(2.0)),
    "stiff before": (lambda t: np.where(t < 0.5, 1e6 * (0.5 - t), 0.0) + 0.8 - t, 0.8),
    "soft before": (lambda t: np.where(t < 0.9, 1e-6 * (0.9 - t), 0.9 - t), 0.9),
}


@pytest.mark.parametrize("name", CURVES)
@pytest.mark.parametrize("was_unstable", [False, True])
def test_the_root_lies_in_its_bracket_and_its_bracket_on_both_sides_of_the_exact_one(
    name: str, was_unstable: bool
) -> None:
    curve, exact = CURVES[name]
    sign = -1.0 if was_unstable else 1.0
    root, asked = found(lambda t: sign * float(curve(t)), 0.0, 1.5, was_unstable=was_unstable)
    assert root.is_refined
    low, high = root.bracket
    assert low <= exact <= high
    assert low <= root.value <= high
    assert {low, high} <= set(asked)
    assert root.value == pytest.approx(exact, abs=3e-4)
    # singular to a thousandth of the smaller eigenvalue at the ends, or bracketed as closely as asked for
    ends = min(abs(float(curve(at))) for at in (0.0, 1.5))
    assert abs(root.pair.eigenvalue) <= 1e-3 * ends or high - low <= 2e-6
    # the state that is kept is the computed one closest to singular
    assert abs(curve(root.state.value)) == min(abs(curve(value)) for value in asked)
    assert root.pair.eigenvalue == sign * float(curve(root.state.value))


@pytest.mark.parametrize("was_unstable", [False, True])
@pytest.mark.parametrize("ahead", [0.0, 0.2, 0.3])
def test_a_root_that_cannot_be_reached_is_approached_from_the_stable_end(
    was_unstable: bool, ahead: float
) -> None:
    """Newton's method has no answer from 0.05 before the root to some way beyond it."""
    sign = -1.0 if was_unstable else 1.0
    exact = 0.4 if was_unstable else 0.6

    def curve(t: float) -> float:
        if -ahead - 0.05 < sign * (exact - t) < 0.05:
            raise SolveError("next to singular")
        return sign * (exact - t)

    root, asked = found(curve, 0.0, 1.0, was_unstable=was_unstable)
    assert not root.is_refined
    known = root.bracket[was_unstable]
    assert sign * (exact - known) == pytest.approx(0.05, abs=0.01)
    assert root.value == pytest.approx(exact, abs=1e-9)
    assert root.pair.eigenvalue < 0.0
    assert set(root.bracket) <= set(asked)


def test_the_line_through_stable_states_that_leads_out_of_the_bracket_gives_its_middle() -> None:
    """The lowest mode of the states that are found hardly changes; another one turns."""

    def curve(t: float) -> float:
        if 0.5 < t < 0.9:
            raise SolveError("next to singular")
        return 1.0 - 0.01 * t if t <= 0.5 else -1.0

    root, _ = found(curve, 0.0, 1.0)
    assert root.value == pytest.approx(0.5 * sum(root.bracket))
    assert 0.45 < root.bracket[0] <= 0.5
    assert root.pair.eigenvalue < 0.0


@pytest.mark.parametrize("was_unstable", [False, True])
def test_of_several_changes_between_the_ends_one_of_the_right_kind_is_bracketed(was_unstable: bool) -> None:
    """Stability is lost, won and lost again."""
    sign = -1.0 if was_unstable else 1.0
    for shift in np.linspace(0.0, 0.15, 7):
        exact = np.array([0.2, 0.5, 0.8]) + shift

        def curve(t: float, exact: np.ndarray = exact) -> float:
            return -sign * float(np.prod(t - exact)) * (1.0 + 20.0 * t)

        root, _ = found(curve, 0.0, 1.2, was_unstable=was_unstable)
        low, high = root.bracket
        assert low < high
        assert (curve(low) < 0.0) is was_unstable
        assert (curve(high) < 0.0) is not was_unstable
        assert low <= root.value <= high


def test_the_main_crossing_is_the_first_into_instability_or_folds_else_the_first() -> None:
    def crossing(value: float, becomes: Any) -> Crossing:
        return Crossing(value, becomes, (value, value), None, None, 1.0)

    stable, one, two = crossing(1.0, "stable"), crossing(2.0, "unstable"), crossing(3.0, "unstable")
    assert main_crossing((stable, one, two)) is one
    assert main_crossing((stable, crossing(4.0, "stable"))) is stable
    assert main_crossing((crossing(0.5, "smooth"), crossing(0.7, "folded"))).value == 0.7  # type: ignore[union-attr]
    assert main_crossing(()) is None


def test_an_index_at_the_level_is_not_above_it() -> None:
    assert not _is_beyond(Scanned(1.0, gi=1.005), 1.005)
    assert _is_beyond(Scanned(1.0, gi=np.nextafter(1.005, 2.0)), 1.005)
    assert _is_beyond(Scanned(1.0, n_negative=1), 1.005)
    assert not _is_beyond(Scanned(1.0, n_negative=0), 1.005)


def visible(index: Curve, parameter: str = "growth.ratio") -> tuple[VisibleScan, list[float]]:
    """Scan of an index that is known; its gyri are the hundredfold of the value."""
    scan = VisibleScan(Config(), parameter, 1.1)
    asked: list[float] = []
    measured = dict.fromkeys((quantity.attribute for quantity in measured_in(2)), 0.0)

    def run(value: float) -> Measures:
        asked.append(value)
        told = {"gi_closing": index(value), "n_gyri": round(100 * value), "contour_length": 600.0}
        scan._measures[value] = Measures(**(measured | told))
        return scan._measures[value]

    scan._run = run  # type: ignore[method-assign]
    return scan, asked


@pytest.mark.parametrize(("slope", "becomes"), [(0.1, "folded"), (-0.1, "smooth")])
@pytest.mark.parametrize("exact", [1.2, 1.51, 1.93])
@pytest.mark.parametrize("tolerance", [0.1, 0.01, 1e-4])
def test_bisection_keeps_the_half_in_which_folds_begin_to_be_seen(
    slope: float, becomes: str, exact: float, tolerance: float
) -> None:
    scan, asked = visible(lambda value: 1.1 + slope * (value - exact))
    below, above = (Scanned(value, gi=scan._run(value).gi_closing) for value in (1.0, 2.0))
    found = scan.crossing(below, above, tolerance)
    low, high = found.bracket
    assert low <= exact <= high
    assert {low, high} <= set(asked)
    assert found.value == 0.5 * (low + high)
    assert found.becomes == becomes
    # as narrow as asked for, and no run more
    assert high - low <= tolerance * high
    assert 2.0 * (high - low) > tolerance * 1.0
    # the gyri are those of the folded end
    assert found.mode_number == round(100 * (high if slope > 0.0 else low))


def test_an_index_at_the_level_is_smooth_in_the_bisection_too() -> None:
    scan, _ = visible(lambda value: 1.1 if value < 1.75 else 1.2)
    ends = (Scanned(value, gi=scan._run(value).gi_closing) for value in (1.0, 2.0))
    found = scan.crossing(*ends, 0.05)
    assert found.bracket[0] < 1.75 <= found.bracket[1]


def test_over_growth_time_the_level_is_passed_where_a_line_between_two_increments_passes_it() -> None:
    scan, _ = visible(lambda time: 1.0 + 0.01 * time, "growth.time")
    scan._run(8.0), scan._run(16.0)
    found = scan.crossing(Scanned(8.0, gi=1.08), Scanned(16.0, gi=1.16), 1e-9)
    assert found.value == pytest.approx(10.0)
    assert found.growth_time == found.value
    assert found.bracket == (8.0, 16.0)


THICKNESS = 2.0


def branch(
    monkeypatch: pytest.MonkeyPatch, equilibrium: Callable[[np.ndarray, float], Solution]
) -> SmoothBranch:
    """Branch of one point through u = 0 at 0; a test says what is found of a guess at a parameter."""
    problem: Any = SimpleNamespace(
        stepping=SimpleNamespace(criterion=SimpleNamespace(force=1e-3)),
        tissue_energy=lambda fraction, _: fraction,
        candidates=None,
        config=SimpleNamespace(geometry=SimpleNamespace(cortical_thickness=THICKNESS)),
    )

    def find(total: float, guess: np.ndarray, _system: Any, criterion: Any, *_: Any) -> Solution:
        assert (criterion.force, criterion.max_iterations) == (1e-3, 10)
        return equilibrium(guess, total)

    monkeypatch.setattr(smooth, "find_equilibrium", find)
    start = SmoothState(0.0, problem, 0.0, np.zeros((1, 2)))
    return SmoothBranch(lambda value: (problem, value), start, None)  # type: ignore[arg-type]


def solution(u: float, result: Result = Result.CONVERGED) -> Solution:
    return Solution(np.array([[u, 0.0]]), result, 0.0, Stats())


@pytest.mark.parametrize(("jump", "is_same"), [(0.49, True), (0.51, False), (5.0, False)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_state_half_a_step_from_its_prediction_is_on_another_branch(
    monkeypatch: pytest.MonkeyPatch, jump: float, is_same: bool, sign: float
) -> None:
    """The branch is u = 10 t up to t = 1, and off by a part of the step of 10 after it."""
    known = branch(monkeypatch, lambda _, t: solution(10.0 * t + (sign * 10.0 * jump if t > 1.0 else 0.0)))
    known.at(1.0)
    if is_same:
        assert known.at(2.0, 0).u[0, 0] == pytest.approx(20.0 + sign * 10.0 * jump)
    else:
        with pytest.raises(SolveError, match="lost between 1 and 2"):
            known.at(2.0, 0)
        assert set(known.known) == {0.0, 1.0}


@pytest.mark.parametrize(("jump", "is_same"), [(0.049, True), (0.051, False)])
def test_a_twentieth_of_the_cortex_is_no_other_branch_however_short_the_step(
    monkeypatch: pytest.MonkeyPatch, jump: float, is_same: bool
) -> None:
    known = branch(monkeypatch, lambda _, t: solution(1e-6 * t + (jump * THICKNESS if t > 1.0 else 0.0)))
    known.at(1.0)
    if is_same:
        known.at(2.0, 0)
    else:
        with pytest.raises(SolveError, match="lost"):
            known.at(2.0, 0)


@pytest.mark.parametrize("result", [result for result in Result if result is not Result.CONVERGED])
def test_a_state_that_has_not_converged_is_on_no_branch(
    monkeypatch: pytest.MonkeyPatch, result: Result
) -> None:
    known = branch(monkeypatch, lambda guess, _: replace(solution(guess[0, 0]), result=result))
    with pytest.raises(SolveError, match="lost between 0 and 1"):
        known.at(1.0, 0)
    assert set(known.known) == {0.0}


def test_a_lost_state_is_approached_by_halves_as_often_as_allowed_and_no_more(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: list[float] = []

    def ends(_: np.ndarray, t: float) -> Solution:
        asked.append(t)
        return solution(10.0 * t, Result.CONVERGED if t <= 0.6 else Result.LINE_SEARCH)

    known = branch(monkeypatch, ends)
    with pytest.raises(SolveError, match=r"lost between 0\.5 and 0\.75|lost between 0\.5 and 1"):
        known.at(1.0, 2)
    assert max(known.known) == 0.5
    assert len(asked) <= 7


@pytest.mark.parametrize("degree", [0, 1, 2, 3])
def test_a_prediction_is_the_polynomial_through_the_nearest_states(
    monkeypatch: pytest.MonkeyPatch, degree: int
) -> None:
    guesses: dict[float, float] = {}

    def follow(guess: np.ndarray, t: float) -> Solution:
        guesses[t] = float(guess[0, 0])
        return solution(t**degree if degree else 0.0)

    known = branch(monkeypatch, follow)
    for t in (1.0, 2.0, 3.0):
        known.known[t] = replace(known.known[0.0], value=t, u=solution(t**degree if degree else 0.0).u)
    known.at(4.0)
    assert guesses[4.0] == pytest.approx(4.0**degree if degree else 0.0)
    known.at(2.5)
    assert guesses[2.5] == pytest.approx(2.5**degree if degree else 0.0)
