"""Gyrification indices of a reading: from the summary where it has them, measured anew where it has not."""

from __future__ import annotations

import itertools
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gyrify.config import Config
from gyrify.errors import ConfigError
from gyrify.metrics import gyrification_index
from gyrify.paper import Case
from gyrify.paper.index import INDICES, PEN, STANDARD_INDEX, Index, picture_index, require_gi
from gyrify.paper.reading import Mechanics, Reading, point_of
from gyrify.paper.simulations import Simulations

COARSE = {
    "mesh.n_around": 96,
    "mesh.n_layers": 8,
    "mesh.n_cortex_layers": 3,
    "solver.increments": 25,
    "dissipation.number": 0.4,
}


def slotted(width: float) -> np.ndarray:
    """A disc of 30 mm with a radial slot 10 mm deep."""
    half = np.arcsin(0.5 * width / 30)
    angle = np.linspace(half, 2 * np.pi - half, 720)
    arc = 30 * np.column_stack([np.cos(angle), np.sin(angle)])
    return np.concatenate([arc, [[20, -0.5 * width], [20, 0.5 * width]]])


def test_what_is_narrower_than_the_line_is_not_seen() -> None:
    wide, narrow = slotted(4 * PEN), slotted(0.5 * PEN)
    assert picture_index(wide, 10.0) == pytest.approx(gyrification_index(wide), rel=2e-3)
    assert gyrification_index(narrow) > 1.1
    assert picture_index(narrow, 10.0) == pytest.approx(1.0, abs=2e-3)
    assert picture_index(narrow, 10.0, 0.1 * PEN) == pytest.approx(gyrification_index(narrow), rel=2e-3)


def test_a_smooth_slice_has_an_index_of_one_by_each() -> None:
    angle = np.arange(400) * (2 * np.pi / 400)
    ellipse = np.column_stack([40 * np.cos(angle), 33 * np.sin(angle)])
    assert picture_index(ellipse, 10.0) == pytest.approx(1.0, abs=1e-4)


def test_other_radii_agree_with_a_run_that_has_them(tmp_path: Path) -> None:
    base = Config().with_overrides(COARSE)
    other = base.with_overrides({"metrics.closing_radius": 7.0})
    mechanics, case = Mechanics.of(base), Case()
    with Simulations(tmp_path) as simulations:
        points = [point_of(each, mechanics, case, 0) for each in (base, other)]
        simulations.run(points)
        rows = {gi: simulations.row(points[0], gi) for gi in INDICES}
        assert rows[Index("closing", 7.0)] is not None
        told = rows[Index("closing", 7.0)], simulations.row(points[1], Index("closing", 7.0))
    assert told[0] is not None
    assert told[1] is not None
    assert (told[0].gi, told[0].depth, told[0].label) == (told[1].gi, told[1].depth, told[1].label)
    gi = {str(index): row.gi for index, row in rows.items() if row is not None}
    assert gi["closing of 6 mm"] < gi["closing of 8 mm"] < gi["closing"] < gi["hull"]
    pens = [index for index in INDICES if index.definition == "picture"]
    drawn = [gi[str(index)] for index in sorted(pens, key=lambda index: -index.pen)]
    assert len(drawn) > 3
    assert all(thick <= thin for thick, thin in itertools.pairwise(drawn))
    assert 1.0 < gi["picture"] == drawn[0] < drawn[-1] <= gi["closing"] * (1.0 + 1e-3)
    assert gi["closing"] > 1.05


def test_names_and_fitted_radii() -> None:
    assert str(STANDARD_INDEX) == "closing"
    assert str(Index("closing", 7.0)) == "closing of 7 mm"
    assert str(Index("picture", pen=0.2)) == "picture with a line of 0.2 mm"
    assert len(set(map(str, INDICES))) == len(INDICES)
    assert Reading(Mechanics(dissipation="none"), Index("picture")).constants == ()
    thin = Index("picture", pen=0.2)
    assert thin.is_fitted
    assert Reading(Mechanics(dissipation="none"), thin).constants == ("width of the line",)
    assert Reading(Mechanics(), Index("closing", 8.0)).constants == ("dissipation number", "closing radius")
    assert Reading(Mechanics(dissipation="none", number=0.0)).constants == ()
    assert Mechanics(exponent=0.3, imperfection=0.05, dissipation="none").constants == (
        "exponent",
        "imperfection",
    )


@pytest.mark.parametrize("word", ["closing", "hull", "exposed", "picture"])
def test_definitions_of_the_index(word: str) -> None:
    assert require_gi(word) == Index(word)  # type: ignore[arg-type]
    assert require_gi(word, 8.0).radius == 8.0
    with pytest.raises(ConfigError, match="gi = 'convex'"):
        require_gi("convex")


@pytest.mark.parametrize("word", ["picture:0.2", "picture:1/5"])
def test_the_width_of_the_line_is_part_of_the_name(word: str) -> None:
    assert require_gi(word) == Index("picture", pen=0.2)
    assert require_gi("picture") == Index("picture", pen=PEN)


@pytest.mark.parametrize(
    "word", ["picture:", "picture:0", "picture:-1", "picture:wide", "picture:10", "picture:1e999"]
)
def test_a_line_needs_a_width_that_can_be_drawn(word: str) -> None:
    with pytest.raises(ConfigError, match=r"must be above 0 and below 10 mm") as fault:
        require_gi(word)
    assert require_gi(fault.value.advice.removeprefix("Try ").rstrip(".")) == Index("picture")


@pytest.mark.parametrize("word", ["closing:0.2", "hull:", "exposed:1"])
def test_only_a_picture_has_a_line(word: str) -> None:
    with pytest.raises(ConfigError, match="is not known"):
        require_gi(word)


def test_a_branch_that_the_configuration_follows_is_followed() -> None:
    """Else a slice without jitter stays on its smooth, unstable branch, and no word is said."""
    base = Config.preset("converged-slice")
    assert point_of(base, Mechanics.of(base), Case(), 0).config.stability.follow_branch
    dragged = replace(Mechanics.of(base), dissipation="drag", number=1.3)
    assert not point_of(base, dragged, Case(), 0).config.stability.follow_branch
    assert not point_of(Config(), Mechanics(), Case(), 0).config.stability.detect
