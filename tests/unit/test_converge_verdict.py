"""Orders, limits and verdicts of `gyrify converge`, against sequences whose limit is known."""

from __future__ import annotations

import math

import pytest

from gyrify.config import Config
from gyrify.convergence.limit import judge
from gyrify.convergence.plan import contour_nodes, plan, resolution
from gyrify.errors import ConfigError
from gyrify.model.meshing import build_mesh


@pytest.mark.parametrize("order", [0.6, 1.0, 2.0, 3.0])
@pytest.mark.parametrize("slope", [0.4, -0.4])
def test_a_power_law_gives_its_order_and_its_limit(order: float, slope: float) -> None:
    found = judge([1.5 + slope * 0.5 ** (order * level) for level in range(3)], 0.02)
    assert found.order == pytest.approx(order)
    assert found.limit == pytest.approx(1.5)
    assert found.error == pytest.approx(1.25 * 0.4 * 0.25**order)
    assert found.converged is (found.error / found.values[-1] <= 0.02)  # type: ignore[operator]


def test_only_the_three_finest_levels_count() -> None:
    power = [2.0 + 0.1 * 0.25**level for level in range(3)]
    assert judge([7.0, *power], 0.02).order == pytest.approx(2.0)
    wild = [1.0, 1.2, 1.1]
    assert judge([7.0, *wild], 0.02).error == judge(wild, 0.02).error


@pytest.mark.parametrize(
    "values",
    [
        (1.0, 1.2, 1.1),
        (1.0, 1.1, 1.3),
        (1.0, 1.1, 1.195),
        (1.0, 1.0, 1.2),
        (1.0, 1.2, 1.2),
        (1.0, 1.2, 1.201),
    ],
)
def test_without_a_monotone_approach_there_is_no_order_and_the_spread_is_the_error(
    values: tuple[float, float, float],
) -> None:
    found = judge(values, 0.02)
    assert found.order is None
    assert found.limit is None
    assert found.error == pytest.approx(max(values) - min(values))
    assert found.converged is False
    assert found.sentence.startswith("not converged (")


def test_two_levels_get_a_larger_margin() -> None:
    found = judge([1.0, 1.01], 0.02)
    assert found.error == pytest.approx(0.03)
    assert found.converged is False
    assert judge([None, 1.0, 1.01], 0.04).converged is True


@pytest.mark.parametrize(("values", "word"), [((1.0, 1.1, None), "finest"), ((1.0, None, 1.2), "before")])
def test_a_gap_next_to_the_finest_level_leaves_it_unknown(
    values: tuple[float | None, ...], word: str
) -> None:
    found = judge(values, 0.02)
    assert (found.converged, found.error) == (None, None)
    assert word in found.sentence
    assert "no level" in judge([None, None], 0.02).sentence


def test_a_count_is_converged_when_it_repeats() -> None:
    assert judge([19.0, 23.0, 23.0], 0.02, is_count=True).converged is True
    found = judge([20.0, 21.0, 23.0], 0.02, is_count=True)
    assert (found.converged, found.error, found.order) == (False, 2.0, None)
    assert judge([0.0, 0.0], 0.02, is_count=True).converged is True


@pytest.mark.parametrize(("tolerance", "converged"), [(0.03 / 1.01 * (1 + 1e-12), True), (0.0297, False)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_converged_is_an_error_of_at_most_the_tolerance(
    tolerance: float, converged: bool, sign: float
) -> None:
    """Three times a difference of 0.01, over 1.01; the size of a negative value is that of its opposite."""
    assert judge([sign * 1.0, sign * 1.01], tolerance).converged is converged
    assert judge([1.0, 1.0], 0.0).converged is True


@pytest.mark.parametrize(("step", "has_order"), [(0.9e-9, False), (1.1e-9, True)])
def test_differences_below_a_billionth_are_rounding_and_have_no_order(step: float, has_order: bool) -> None:
    found = judge([100.0 - 300.0 * step, 100.0 - 100.0 * step, 100.0], 0.02)
    assert (found.order is not None) is has_order


@pytest.mark.parametrize(
    ("order", "is_credible"), [(0.499, False), (0.501, True), (3.999, True), (4.001, False)]
)
def test_orders_from_a_half_to_four_are_credible(order: float, is_credible: bool) -> None:
    found = judge([2.0 + 0.5 ** (order * level) for level in range(3)], 0.02)
    assert (found.order is not None) is is_credible


def test_a_count_that_differs_by_one_is_not_converged() -> None:
    assert judge([22.0, 23.0], 0.5, is_count=True).converged is False


def test_rounding_is_no_difference() -> None:
    found = judge([1.0, 1.0 + 1e-15, 1.0 + 1.5e-15], 0.02)
    assert found.order is None
    assert found.converged is True
    assert found.sentence == "converged to 0.01 %"
    assert judge([0.0, 0.0, 0.0], 0.02).converged is True
    assert judge([1e-15, 3e-15, 0.0], 0.02).converged is False
    assert judge([1e-15, 3e-15, 0.0], 0.02, least=0.1).converged is True


def test_families_start_at_the_configuration_and_halve_one_thing(tiny: Config) -> None:
    families = plan(tiny, ("mesh", "increments", "contact"), 3)
    for subject, group in families.items():
        assert group[0] == tiny
        sizes = [resolution(config, subject) for config in group]
        assert sizes == pytest.approx([sizes[0], sizes[0] / 2, sizes[0] / 4])
        others = [other for other in families if other != subject]
        assert len({resolution(config, other) for config in group for other in others}) == 2
    assert len({config.config_hash for group in families.values() for config in group}) == 7
    assert list(plan(tiny, ("contact", "contact"), 2)) == ["contact"]


@pytest.mark.parametrize("element", ["linear", "quadratic", "mean_dilatation"])
def test_resolution_is_that_of_the_mesh(tiny: Config, element: str) -> None:
    config = tiny.replace(**{"mesh.element": element, "mesh.refine": 1})
    mesh = build_mesh(config)
    assert contour_nodes(config) == mesh.contour.size
    points = mesh.points[mesh.contour]
    length = sum(math.dist(a, b) for a, b in zip(points, [*points[1:], points[0]], strict=True))
    assert resolution(config, "mesh") == pytest.approx(length / mesh.contour.size, rel=1e-3)


@pytest.mark.parametrize(
    ("changes", "subjects", "levels", "word"),
    [
        ({}, ("mesh",), 1, "levels = 1"),
        ({}, (), 3, "No subject"),
        ({}, ("colour",), 3, "colour"),
        ({"contact.enabled": False}, ("contact",), 3, "no contact"),
        ({"mesh.refine": 3}, ("mesh",), 3, "mesh.refine = 5"),
    ],
)
def test_what_has_no_meaning_is_refused(
    tiny: Config, changes: dict[str, object], subjects: tuple[str, ...], levels: int, word: str
) -> None:
    with pytest.raises(ConfigError, match=word):
        plan(tiny.replace(**changes), subjects, levels)  # type: ignore[arg-type]
