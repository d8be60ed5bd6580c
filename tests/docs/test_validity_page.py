"""Every warning is on the page of warnings, with its bound."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from gyrify.run.validity import after, before
from gyrify.run.validity.collapse import COLLAPSED
from gyrify.run.validity.converged import LIMITS
from gyrify.run.validity.expected import expected_onset
from gyrify.run.validity.locking import LOCKING_POISSON_RATIO
from gyrify.run.validity.resolution import LATE

PAGE = (Path(__file__).parents[2] / "docs" / "validity.md").read_text(encoding="utf-8")
BEFORE, AFTER = PAGE.split("## Before a run")[1].split("## After a run")


@pytest.mark.parametrize("check", before.CHECKS, ids=lambda check: check.__name__)
def test_checks_of_a_configuration_have_a_row(check: object) -> None:
    assert f"\n| `{check.__name__}` |" in BEFORE


@pytest.mark.parametrize("check", after.CHECKS, ids=lambda check: check.__name__)
def test_checks_of_a_run_have_a_row(check: object) -> None:
    assert f"\n| `{check.__name__}` |" in AFTER


def bound(name: str) -> str:
    """Last cell of the row of a check."""
    (row,) = re.findall(rf"\n\| `{name}` \|.*\| (.*) \|", PAGE)
    return row


def test_bounds_are_those_of_the_code() -> None:
    assert bound("resolution").startswith(f"{LATE:.0%}".replace("%", " %"))
    assert bound("locking") == f"{LOCKING_POISSON_RATIO:g}"
    assert bound("collapse") == f"J_e = {COLLAPSED:g}"
    assert bound("fold_resolution") == f"{after.POINTS_PER_FOLD:g} points"
    for limit in LIMITS:
        assert f"{limit.gi_closing:.2f} ± {limit.uncertainty:.2f}" in PAGE


def test_the_keys_of_what_is_expected_are_named() -> None:
    from gyrify.config import Config

    part = PAGE.split("## What is expected")[1].split("## Before a run")[0]
    for key in expected_onset(Config()).as_dict():
        assert f"`{key}`" in part
