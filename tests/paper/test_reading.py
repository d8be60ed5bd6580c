"""Readings as data, their points, and a reading with several seeds."""

from __future__ import annotations

from statistics import fmean, stdev
from typing import get_args

import pytest
from fake_simulations import FakeSimulations

from gyrify.config import Config
from gyrify.paper import Case, all_cases
from gyrify.paper.cases import EQUAL, SOFT
from gyrify.paper.ensemble import SEEDS, best_first, repeat, spread
from gyrify.paper.index import GiDefinition, Index
from gyrify.paper.reading import Mechanics, Reading, point_of
from gyrify.paper.reproduce import reproduce
from gyrify.paper.search import KNOWN

SEVERAL = [Mechanics(plane, number=c) for plane in ("blocked", "none") for c in (0.13, 1.3, 2.6)]


def test_a_mechanics_is_read_from_a_configuration_and_written_back() -> None:
    for one in (*KNOWN, Mechanics("none", dissipation="kelvin_voigt", grading="uniform", split="random")):
        assert Mechanics.of(Config().with_overrides(one.overrides)) == one
    assert Mechanics.of(Config()) == Mechanics()


def test_points_tell_what_differs_and_leave_the_rest() -> None:
    base = Config().with_overrides({"mesh.n_around": 96})
    point = point_of(base, Mechanics(number=0.13), Case(SOFT, 2.0, 3.0), seed=2)
    assert point.parameters == {
        "dissipation.number": 0.13,
        "material.stiffness_ratio": SOFT,
        "growth.ratio": 2.0,
        "geometry.cortical_thickness": 3.0,
        "seed": 2,
    }
    assert point.config.mesh.n_around == 96
    assert point.config.seed == 2
    assert not point.config.stability.detect


def test_quadratic_triangles_have_as_many_nodes_around() -> None:
    mesh = point_of(Config(), Mechanics(element="quadratic"), Case(), 0).config.mesh
    assert (mesh.n_around, mesh.n_layers, mesh.n_cortex_layers) == (108, 9, 3)
    base = Config().with_overrides({"mesh.element": "quadratic", "mesh.n_around": 54})
    assert point_of(base, Mechanics.of(base), Case(), 0).config.mesh.n_around == 54


def test_every_case_is_another_run() -> None:
    keys = {point_of(Config(), Mechanics(), case, 0).key for case in all_cases()}
    assert len(keys) == len(all_cases())


def test_the_index_of_the_reading_is_used_in_every_row() -> None:
    simulations = FakeSimulations()
    closing, hull = (
        reproduce(simulations, Config(), Reading(Mechanics(), Index(gi)), stability=False)
        for gi in get_args(GiDefinition)[:2]
    )
    case = Case(EQUAL)
    assert hull.rows[case].gi - 1 == pytest.approx(1.2 * (closing.rows[case].gi - 1))
    assert hull.rows[case].label == closing.rows[case].label


def test_several_seeds() -> None:
    simulations = FakeSimulations()
    found = repeat(simulations, Config(), Reading(), stability=False)
    names = {entry.name: entry for entry in found.spreads()}
    gi = [member.rows[Case(EQUAL)].gi for member in found.members]
    assert len(set(gi)) == len(SEEDS)
    assert names["GI, E = 1"].mean == pytest.approx(fmean(gi))
    assert names["GI, E = 1"].deviation == pytest.approx(stdev(gi))
    assert "growth ratio of visible folds, E = 1" in names
    assert set(found.passes.values()) <= set(range(len(SEEDS) + 1))
    assert found.passes["P1"] == len(SEEDS)
    assert found.score.n == len(SEEDS)
    fresh = [m.scoreboard.passed for m in found.members if m.seed in (3, 4)]
    assert (found.fresh.n, found.fresh.mean) == (2, fmean(fresh))
    first = [m.scoreboard.first_passed for m in found.members]
    assert found.first_score.mean == fmean(first)
    assert "Fitted constants: 1 (dissipation number)." in found.told
    assert ", ".join(str(m.scoreboard.passed) for m in found.members) in found.told


def test_ensembles_are_put_in_order_by_their_mean() -> None:
    simulations = FakeSimulations()
    found = [repeat(simulations, Config(), Reading(one), stability=False) for one in SEVERAL]
    ordered = best_first(found)
    means = [one.score.mean for one in ordered]
    assert means == sorted(means, reverse=True)
    assert len(set(means)) > 1
    equal = [one for one in found if one.score.mean == means[0]]
    assert ordered[: len(equal)] == equal


def test_spread_of_few_values() -> None:
    assert spread("x", [1.0, 3.0, float("inf")]) == spread("x", [1.0, 3.0])
    assert (spread("x", [2.0]).mean, spread("x", [2.0]).deviation) == (2.0, 0.0)
    assert spread("x", []).n == 0


def test_growth_along_z_and_the_course_of_dissipation_are_part_of_a_reading() -> None:
    base = Config.preset("reference-slice")
    own = Mechanics(out_of_plane="generalised", number=2.6, exponent=0.13, course="reduced")
    point = point_of(base, own, all_cases()[0], 0)
    assert point.config.growth.out_of_plane_exponent == 0.13
    assert point.config.dissipation.course == "reduced"
    assert Mechanics.of(point.config) == own
    assert str(own).startswith("generalised to the power 0.13, linear, grown, drag 2.6 reduced over growth, ")
    assert "power" not in str(Mechanics())


def test_the_mesh_is_part_of_a_reading() -> None:
    own = Mechanics(grading="uniform", split="one", imperfection=0.0)
    point = point_of(Config(), own, Case(), 0)
    mesh = point.config.mesh
    assert (mesh.grading, mesh.split, mesh.node_jitter) == ("uniform", "one", 0.0)
    assert "linear triangles in uniform layers with one diagonal, imperfection 0" in str(own)
