"""Every search says when its answer lies on the edge of what it searched."""

from __future__ import annotations

from pathlib import Path

import pytest

from gyrify import Config, critical_growth
from gyrify.convergence.limit import judge
from gyrify.paper import loss_of_stability as stability
from gyrify.paper.reading import Mechanics
from gyrify.paper.space import edges
from gyrify.report.onset_curve import onset_curve
from gyrify.threshold.critical import _edges
from gyrify.threshold.crossings import Crossing, Scanned

CIRCLE = {
    "geometry.shape": "circle",
    "mesh.n_around": 72,
    "mesh.n_layers": 8,
    "mesh.n_cortex_layers": 3,
}


def scanned(*negative: int | None) -> list[Scanned]:
    return [Scanned(1.0 + i, n) for i, n in enumerate(negative)]


def crossing(value: float) -> Crossing:
    return Crossing(value, "unstable", (value, value), 20, 10.0, 500.0)


def test_a_range_that_begins_unstable_may_miss_a_crossing() -> None:
    (note,) = _edges("growth.ratio", scanned(2, 0, 3), [], 1.005, 1e-6)
    assert "unstable already at the lowest value of growth.ratio" in note
    assert "(1)" in note
    assert _edges("growth.ratio", scanned(0, 0, 3), [crossing(2.5)], 1.005, 1e-6) == []
    (note,) = _edges("growth.ratio", scanned(None, 2, 3), [], 1.005, 1e-6)
    assert "(2)" in note
    (note,) = _edges("growth.time", [Scanned(3.0, gi=1.2), Scanned(4.0, gi=1.3)], [], 1.005, 0.01)
    assert "folded already" in note
    assert _edges("growth.ratio", scanned(None, None), [], 1.005, 1e-6) == []


def test_a_crossing_at_an_end_of_the_range_is_told() -> None:
    """Also between the first two values: inside it is an answer like any other, at the end it is not."""
    assert _edges("growth.ratio", scanned(0, 1, 3), [crossing(1.5)], 1.005, 1e-6) == []
    (note,) = _edges("growth.ratio", scanned(0, 1, 3), [crossing(1.000001)], 1.005, 1e-6)
    assert "at the end of the range (growth.ratio = 1)" in note
    (note,) = _edges("growth.ratio", scanned(0, 0, 3), [crossing(2.99)], 1.005, 1e-2)
    assert "growth.ratio = 3" in note


def test_threshold_carries_it() -> None:
    config = Config().with_overrides(CIRCLE)
    found = critical_growth(config, range=(3.0, 4.0), points=2)
    assert found.critical_value is None
    assert found.at_edge
    assert found.as_dict()["at_edge"] is True
    assert any("already at the lowest value" in note for note in found.notes)
    inside = critical_growth(config, range=(1.5, 4.0), points=2, tolerance=1e-2)
    assert inside.critical_value is not None
    assert not inside.at_edge


def test_paper_does_not_call_an_unstable_range_stable(monkeypatch: pytest.MonkeyPatch) -> None:
    config = Config().with_overrides(CIRCLE)
    monkeypatch.setattr(stability, "LOWEST", 3.0)
    assert stability._critical(config, 3.5) == "below 3"
    monkeypatch.setattr(stability, "LOWEST", 1.0)
    assert stability._critical(config, 1.1) == "not up to 1.1"


@pytest.mark.parametrize(("values", "pace"), [((1.0, 1.1, 1.195), 0.074), ((1.0, 1.5, 1.51), 5.64)])
def test_a_pace_outside_of_the_trusted_orders_is_told(values: tuple[float, ...], pace: float) -> None:
    found = judge(values, 0.02)
    assert found.order is None
    assert found.pace == pytest.approx(pace, rel=1e-2)
    assert "outside of 0.5 to 4: no limit is extrapolated" in found.note
    assert found.as_dict()["pace"] == found.pace


def test_an_order_that_is_trusted_has_no_note() -> None:
    assert judge((1.0, 1.2, 1.25), 0.02).note == ""
    assert judge((1.0, 1.2, 1.1), 0.02).note == ""
    assert judge((10.0, 11.0, 12.0), 0.02, is_count=True).note == ""


def test_a_reading_says_what_of_it_is_the_most_that_was_tried() -> None:
    assert edges(Mechanics(number=0.4, imperfection=1e-2)) == []
    assert edges(Mechanics(number=10.0, imperfection=1e-2)) == [
        "dissipation number 10 is the largest that was tried"
    ]
    assert edges(Mechanics(number=0.01, imperfection=0.0)) == [
        "dissipation number 0.01 is the smallest that was tried"
    ]
    assert edges(Mechanics(number=0.4, imperfection=1e-1)) == [
        "imperfection 0.1 is the largest that was tried"
    ]
    assert edges(Mechanics(dissipation="none", number=0.0, imperfection=1e-2)) == []


def test_a_map_says_what_it_is_where_no_curve_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gyrify.report.onset_curve._SECTIONS", 3)
    monkeypatch.setattr("gyrify.report.onset_curve._SCAN", 3)
    config, keys = Config.preset("reference-slice"), ("growth.ratio", "material.stiffness_ratio")
    assert "in this range: unstable throughout." in onset_curve(config, keys, ((3.0, 4.0), (1.0, 1.5))).note
    assert "in this range: stable throughout." in onset_curve(config, keys, ((1.0, 1.2), (0.8, 1.0))).note
    found = onset_curve(config, keys, ((1.0, 1.6), (0.7, 2.0)))
    assert found.note.endswith("no onset in 1 of 3 sections (stable).")


def test_family_notes_tell_it(tmp_path: Path) -> None:
    from gyrify.convergence.levels import Family, Level

    config = Config()
    levels = tuple(
        Level(config, tmp_path, "completed", "", {"gi_hull": gi, "n_gyri": 20.0}, 1.0)
        for gi in (1.0, 1.5, 1.51)
    )
    notes = Family("mesh", levels, 0.02).notes
    assert any(note.startswith("GI, hull: differences fall with order 5.6") for note in notes)
