"""Rules as data: well-formed, in order, and every input with exactly one label."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gyrify.errors import ConfigError
from gyrify.phenotype import LABELS, classify, load_rules, shape_numbers
from gyrify.phenotype.rules import parse_rules

POSITIVE = st.floats(1e-6, 1e6)
ROWS = st.fixed_dictionaries(
    {
        "gi_hull": st.one_of(st.floats(0.99, 1.2), st.floats(0.5, 1e3)),
        "gi_closing": st.one_of(st.floats(0.99, 1.2), st.floats(0.5, 1e3)),
        "n_gyri": st.integers(0, 200),
        "sulcal_depth_mm_mean": st.one_of(st.just(0.0), st.floats(0, 30)),
        "contour_length_mm": st.floats(1, 1e4),
        "gyrus_width_mm": st.floats(0, 100),
        "gyrus_flatness": st.floats(0, 1),
        "thickness_mm_crown": st.floats(0, 30),
        "thickness_mm_fundus": st.floats(1e-3, 30),
    }
)
NORMAL = {
    "gi_hull": 1.25,
    "gi_closing": 1.2,
    "n_gyri": 19,
    "sulcal_depth_mm_mean": 4.0,
    "contour_length_mm": 500.0,
    "gyrus_width_mm": 12.0,
    "gyrus_flatness": 0.4,
    "thickness_mm_crown": 4.0,
    "thickness_mm_fundus": 2.0,
}
MINIMAL = """
version = 1
[normal]
n_gyri = 19
[numbers]
gi = "index"
[[rule]]
name = "first"
label = "smooth"
when = [{ number = "gi", at_most = 1.1 }]
sentence = "s"
source = "s"
[[rule]]
name = "rest"
label = "normal"
when = []
sentence = "s"
source = "s"
"""


@settings(max_examples=300, deadline=None, derandomize=True)
@given(row=ROWS, thickness=st.floats(0.1, 30))
def test_every_shape_gets_the_label_of_the_first_rule_that_fires(
    row: dict[str, float], thickness: float
) -> None:
    found, rules = classify(row, thickness), load_rules()
    fired = [rule for rule in rules.rules if rule.fires(found.numbers)]
    assert found.label in LABELS
    assert (found.label, found.rule) == (fired[0].label, fired[0].name)
    assert found.numbers == shape_numbers(row, thickness, rules.normal_gyri)
    assert all(condition.number in found.because for condition in fired[0].when)
    assert found.because


@settings(max_examples=100, deadline=None, derandomize=True)
@given(row=ROWS, thickness=st.floats(0.1, 30), scale=st.floats(1e-2, 1e2))
def test_the_unit_of_length_does_not_matter(row: dict[str, float], thickness: float, scale: float) -> None:
    scaled = {key: value * scale if "_mm" in key else value for key, value in row.items()}
    ours, theirs = classify(row, thickness).numbers, classify(scaled, thickness * scale).numbers
    assert theirs == pytest.approx(ours, rel=1e-9)


def test_every_label_has_a_rule_and_every_rule_a_reason() -> None:
    rules = load_rules()
    assert {rule.label for rule in rules.rules} == set(LABELS)
    assert len({rule.name for rule in rules.rules}) == len(rules.rules)
    assert all(len(rule.sentence) > 20 and len(rule.source) > 20 for rule in rules.rules)
    used = {condition.number for rule in rules.rules for condition in rule.when}
    assert used | {"spacing"} == set(rules.numbers)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('label = "normal"', 'label = "average"', "'average' is unknown"),
        ('number = "gi"', 'number = "size"', "malformed"),
        ("at_most = 1.1", "equals = 1.1", "malformed"),
        ("when = []", 'when = [{ number = "gi", above = 2.0 }]', "no label"),
    ],
)
def test_bad_rules_are_refused(old: str, new: str, words: str) -> None:
    assert len(parse_rules(MINIMAL).rules) == 2
    with pytest.raises(ConfigError, match=words):
        parse_rules(MINIMAL.replace(old, new))


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -1.0, None])
def test_what_is_no_metric_is_refused_by_name(value: float | None) -> None:
    assert classify(NORMAL, 3.0).label == "normal"
    with pytest.raises(ConfigError, match="sulcal_depth_mm_mean"):
        classify(NORMAL | {"sulcal_depth_mm_mean": value}, 3.0)
    with pytest.raises(ConfigError, match="thickness"):
        classify(NORMAL, 0.0)
