"""Phenotypes of shapes that are drawn by hand, each rule at least once."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from shapes import RADIUS, THICKNESS, waves

from gyrify.config import Config
from gyrify.phenotype import classify, grown_thickness, load_rules


@pytest.mark.parametrize(
    ("k", "depth", "power", "uniform", "label", "rule"),
    [
        (19, 0.2, 1, False, "smooth", "no folds to be seen"),
        (19, 2.5, 1, False, "lissencephaly", "sulci of less than half the cortex"),
        (19, 2.5, 4, False, "lissencephaly", "sulci of less than half the cortex"),
        (6, 12.0, 20, False, "lissencephaly", "a third of the normal gyri"),
        (28, 6.0, 1, False, "polymicrogyria", "numerous small gyri"),
        (17, 4.0, 4, False, "pachygyria", "sulci shallower than the cortex"),
        (12, 8.0, 4, False, "pachygyria", "few gyri"),
        (14, 8.0, 12, False, "pachygyria", "broad and flat gyri"),
        (19, 8.0, 2, True, "sinusoidal", "cortex of nearly uniform thickness"),
        (19, 8.0, 4, False, "normal", "deep sulci below thick crowns"),
    ],
)
def test_drawn_shapes(k: int, depth: float, power: float, uniform: bool, label: str, rule: str) -> None:
    found = classify(waves(k, depth, power, uniform=uniform), THICKNESS)
    assert (found.label, found.rule) == (label, rule), found.numbers
    assert found.numbers["gyri"] == pytest.approx(0.0 if depth < 0.3 else k / load_rules().normal_gyri)


def test_a_circle_is_smooth_and_says_why() -> None:
    found = classify(waves(19, 0.0), THICKNESS)
    assert found.label == "smooth"
    assert found.because.startswith("hull = 1 ")
    assert found.numbers["gyri"] == found.numbers["depth"] == 0.0


def test_numbers_of_a_wave() -> None:
    numbers = classify(waves(20, 3.0), THICKNESS).numbers
    assert numbers["breadth"] == pytest.approx(0.5 * (RADIUS - 1.5) / (RADIUS - 0.5) * 19 / 20, rel=0.05)
    assert numbers["flatness"] == pytest.approx(1 / 3, rel=0.1)
    assert numbers["spacing"] == pytest.approx(2 * math.pi * RADIUS / 20 / THICKNESS, rel=0.04)


@pytest.mark.parametrize(
    ("overrides", "factor"),
    [({}, 2.0), ({"growth.stretch": "exponential"}, math.e), ({"growth.law": "tangential"}, 1.0)],
)
def test_thickness_grows_as_the_law_says(overrides: dict[str, str], factor: float) -> None:
    config = Config().with_overrides(overrides | {"geometry.cortical_thickness": 2.0})
    assert grown_thickness(config) == pytest.approx(2.0 * factor)


def test_rules_travel_with_the_package() -> None:
    import gyrify.phenotype

    assert (Path(gyrify.phenotype.__file__).parent / "rules.toml").is_file()
