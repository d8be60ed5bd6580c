"""Designs: what each kind draws, as laws that hold for all of them."""

from __future__ import annotations

import itertools
import math
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_study import BASE, GROWTH, STIFFNESS, study

from gyrify.errors import ConfigError
from gyrify.study import Study
from gyrify.study.design import read_design
from gyrify.study.parameter import read_parameter

finite = st.floats(0.2, 50.0, allow_nan=False)
lists = st.lists(finite, min_size=1, max_size=5, unique=True)


@given(st.lists(lists, min_size=1, max_size=3))
@settings(max_examples=50)
def test_a_grid_has_every_combination_once_and_the_last_parameter_changes_fastest(columns: Any) -> None:
    keys = ["growth.ratio", "material.stiffness_ratio", "dissipation.number"]
    parameters = [{"key": key, "values": values} for key, values in zip(keys, columns, strict=False)]
    points = read_design({"kind": "grid", "parameter": parameters}).combinations()
    assert len(points) == math.prod(map(len, columns))
    assert len({tuple(point.values()) for point in points}) == len(points)
    last = keys[len(columns) - 1]
    assert [point[last] for point in points[: len(columns[-1])]] == columns[-1]


@given(finite, st.floats(0.5, 30.0), st.integers(2, 40), st.sampled_from(["linear", "log"]))
def test_a_range_is_spread_between_its_ends_in_order(low: float, more: float, n: int, scale: str) -> None:
    table = {"key": "growth.ratio", "range": [low, low + more], "scale": scale}
    values = read_parameter(table, "it").spread(n)
    assert len(values) == n
    assert (values[0], values[-1]) == (low, low + more)
    steps = [b / a if scale == "log" else b - a for a, b in itertools.pairwise(values)]
    assert min(steps) == pytest.approx(max(steps), rel=1e-6)


@given(st.sampled_from(["random", "latin_hypercube"]), st.integers(1, 60), st.integers(0, 2**32 - 1))
@settings(max_examples=40, deadline=None)
def test_drawn_points_lie_in_range_and_depend_on_the_seed_alone(kind: str, n: int, seed: int) -> None:
    parameters = [
        {"key": "growth.ratio", "range": ["1/2", 4.0]},
        {"key": "dissipation.number", "range": [0.01, 100.0], "scale": "log"},
        {"key": "mesh.n_around", "range": [24, 48]},
    ]
    table = {"kind": kind, "n": n, "seed": seed, "parameter": parameters}
    points = read_design(table).combinations()
    assert len(points) == n
    assert points == read_design(table).combinations()
    assert n < 2 or points != read_design({**table, "seed": (seed + 1) % 2**32}).combinations()
    for point in points:
        assert 0.5 <= point["growth.ratio"] <= 4.0
        assert 0.01 <= point["dissipation.number"] <= 100.0
        assert isinstance(point["mesh.n_around"], int)
        assert 24 <= point["mesh.n_around"] <= 48


@given(st.integers(2, 50), st.integers(0, 1000))
@settings(max_examples=30, deadline=None)
def test_a_latin_hypercube_has_one_point_in_every_slice(n: int, seed: int) -> None:
    parameters = [
        {"key": "growth.ratio", "range": [1.0, 3.0]},
        {"key": "geometry.cortical_thickness", "range": [1.0, 2.0]},
    ]
    design = read_design({"kind": "latin_hypercube", "n": n, "seed": seed, "parameter": parameters})
    for key, low, width in (("growth.ratio", 1.0, 2.0), ("geometry.cortical_thickness", 1.0, 1.0)):
        slices = sorted(int((point[key] - low) / width * n) for point in design.combinations())
        assert slices == list(range(n))


def test_whole_numbers_of_a_range_are_drawn_up_to_its_end() -> None:
    design = read_design({"kind": "random", "n": 400, "parameter": [{"key": "seed", "range": [0, 3]}]})
    assert {point["seed"] for point in design.combinations()} == {0, 1, 2, 3}


def test_values_side_by_side() -> None:
    points = study(GROWTH, STIFFNESS, kind="zip").points()
    assert [tuple(point.parameters.values()) for point in points] == [(1.0, 1 / 1.36), (3.6, 1.0)]


def test_points_written_out_may_differ_in_what_they_set() -> None:
    rows = [{"growth": {"ratio": 2}, "seed": 3}, {"material.stiffness_ratio": "1/3"}]
    points = Study.from_mapping({"base": BASE, "design": {"kind": "list", "point": rows}}).points()
    assert points[0].parameters == {"growth.ratio": 2.0, "seed": 3}
    assert points[1].parameters == {"material.stiffness_ratio": pytest.approx(1 / 3)}
    assert points[1].config.growth.ratio == 3.6


def test_a_point_is_its_base_with_its_values_and_known_by_the_hash() -> None:
    point = study(GROWTH, STIFFNESS).points()[0]
    config = study(GROWTH).base.replace(**{"growth.ratio": 1.0, "material.stiffness_ratio": "1/1.36"})
    assert point.config == config
    assert point.key == config.config_hash[:12]


@pytest.mark.parametrize("kind", ["grid", "random", "latin_hypercube", "zip"])
def test_a_study_written_and_read_back_has_equal_points(kind: str, tmp_path: Any) -> None:
    ranged = {"key": "dissipation.number", "range": [0.1, 1.0], "scale": "log"}
    found = study(ranged, {"key": "growth.ratio", "range": [2, "7/2"]}, kind=kind, n=3, seed=5)
    (tmp_path / "study.toml").write_text(found.to_toml(), encoding="utf-8")
    assert Study.from_toml(tmp_path / "study.toml").points() == found.points()


@pytest.mark.parametrize("n", [10, 1_000_000])
def test_a_design_without_end_is_refused(n: int) -> None:
    many = [{"key": f"growth.{key}", "range": [0.1, 0.2], "n": 100} for key in ("ratio", "rate", "duration")]
    with pytest.raises(ConfigError, match=r"more than 100000 points|whole number from 1"):
        read_design({"kind": "grid", "n": n, "parameter": many}).combinations()
