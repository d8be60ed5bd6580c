"""What a verification lets pass: each bound from both sides, on increments that are made up."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from gyrify.base.versions import versions
from gyrify.run.reevaluation import Increment
from gyrify.solve.newton import Criterion
from gyrify.solve.problem import TICKS, Stepping
from gyrify.verify.metrics import LATER_KEYS, WORDED, _comparable, _differences
from gyrify.verify.recheck import (
    _check_balance,
    _check_contact,
    _check_forces,
    _check_path,
    _check_volumes,
    _jumps,
)
from gyrify.verify.verification import Check

TOLERANCE = 1e-3
FINE = Increment(
    residual=0.9e-3, stored_residual=0.9e-3, rise=-0.1, min_J=0.5, min_J_elastic=0.5,
    smallest_cell=7, smallest_elastic_cell=8, is_path_free=True,
    stored=60.0, contact=1.0, external=0.0, dissipated=39.0, work=100.0, work_error=0.0,
)  # fmt: skip


def passed(name: str, **changes: float) -> bool:
    """Whether the check of that name lets three increments pass, the middle one of them changed."""
    increments = [FINE, replace(FINE, **changes), FINE]  # type: ignore[arg-type]
    found = (*_check_forces(TOLERANCE, increments, "N/mm"), *_check_volumes(increments))
    checks = {check.name: check for check in found}
    others = {key: check for key, check in checks.items() if key != name}
    assert len(others) == 4
    assert "increment 2" in checks[name].sentence or checks[name].passed
    return checks[name].passed


@pytest.mark.parametrize(
    ("name", "field", "good", "bad"),
    [
        # a thousandth of the tolerance is rounding
        ("residual", "residual", 1.0009e-3, 1.0011e-3),
        ("stored residual", "stored_residual", 0.9009e-3, 0.9011e-3),
        ("stored residual", "stored_residual", 0.8991e-3, 0.8989e-3),
        ("descent", "rise", 0.9e-10, 1.1e-10),
        ("volume", "min_J", 1e-9, 0.0),
        ("volume", "min_J", 1e-9, -0.1),
        ("elastic volume", "min_J_elastic", 1e-9, 0.0),
    ],
)
def test_each_bound_of_an_increment_holds_from_both_sides(
    name: str, field: str, good: float, bad: float
) -> None:
    assert passed(name, **{field: good})
    assert not passed(name, **{field: bad})
    assert not passed(name, **{field: np.nan})


def balance(stored: float, work_error: float = 0.0) -> Check:
    """Of one increment whose defect is that of its stored energy, among nine that are in balance."""
    return _check_balance([replace(FINE, stored=stored, work_error=work_error), *[FINE] * 9], "uJ/mm")


def test_energy_may_be_lost_but_not_created() -> None:
    """Of 1000 Pa mm^2 of growth, 2 % or 20."""
    assert balance(60.0 + 19.0).passed
    assert not balance(60.0 + 21.0).passed
    assert balance(60.0 - 500.0).passed
    assert not balance(np.nan).passed


def test_what_is_created_may_be_as_much_as_the_work_of_growth_is_uncertain_by() -> None:
    assert balance(60.0 + 49.0, work_error=50.0).passed
    assert not balance(60.0 + 51.0, work_error=50.0).passed
    assert not balance(60.0 + 21.0, work_error=10.0).passed
    created = balance(60.0 + 21.0)
    assert (created.worst, created.bound) == (pytest.approx(0.021), 0.02)


def test_what_one_increment_loses_makes_up_for_nothing_that_another_creates() -> None:
    less, more = replace(FINE, stored=30.0), replace(FINE, stored=90.0)
    assert not _check_balance([less, more], "uJ/mm").passed


def test_what_cannot_be_checked_is_left_out_and_told() -> None:
    """An increment whose work is not known must not let the others create energy."""
    lost = replace(FINE, stored=1e9, work=1.0, work_error=np.inf)
    more = replace(FINE, stored=90.0)
    found = _check_balance([lost, more], "uJ/mm")
    assert not found.passed
    assert "1 increments are left out" in found.sentence
    assert "Not checked" in _check_balance([lost], "uJ/mm").sentence


ROW: dict[str, Any] = {"self_intersecting": False, "min_gap_mm": 0.1}


@pytest.mark.parametrize("number", [0, 1, 2])
def test_a_single_contour_that_crosses_itself_is_too_many(number: int) -> None:
    rows = [ROW | ({"self_intersecting": True} if k == number else {}) for k in range(3)]
    checks = {check.name: check.passed for check in _check_contact(rows)}
    assert checks == {"simple contour": False, "gap": True}
    closed = [ROW | ({"min_gap_mm": 0.0} if k == number else {}) for k in range(3)]
    checks = {check.name: check.passed for check in _check_contact(closed)}
    assert checks == {"simple contour": True, "gap": False}


def test_a_single_path_that_crosses_is_too_many() -> None:
    increments = [FINE, replace(FINE, is_path_free=False)]
    assert not _check_path(increments, set()).passed
    assert _check_path(increments, {2}).passed


def test_a_jump_is_an_increment_that_left_an_unstable_state_or_could_not_be_smaller() -> None:
    """Increments may be halved twice; the second one was stable. With drag there are no jumps."""
    spans = [0, TICKS, TICKS, TICKS // 2, TICKS // 4]
    journal = SimpleNamespace(negative_pivots={1: 2, 2: 0}, column=lambda _: spans)
    stepping = Stepping(4, 1 / 16, Criterion(1e-3, 9))
    for may_jump, jumps in ((True, {1, 4}), (False, set())):
        history: Any = SimpleNamespace(
            slice=SimpleNamespace(may_jump=may_jump, stepping=stepping), journal=journal
        )
        assert _jumps(history) - {0} == jumps


@pytest.mark.parametrize(
    ("stored", "found", "is_same"),
    [
        (1.0, 1.0 + 0.9e-9, True),
        (1.0, 1.0 + 1.1e-9, False),
        ("1.0", 1.0, True),
        (0.0, 0.9e-12, True),
        (0.0, 1.1e-12, False),
        ("", None, True),
        ("", 0.0, False),
        (None, 0.0, False),
        (float("nan"), 1.0, False),
        ("grey", "white", False),
    ],
)
def test_numbers_are_the_same_up_to_rounding(stored: object, found: object, is_same: bool) -> None:
    assert (not list(_differences({"a": {"b": stored}}, {"a": {"b": found}}, "", 1.0))) is is_same


def test_a_number_that_one_side_lacks_is_a_difference() -> None:
    assert len(list(_differences({"a": 1, "b": 2}, {"a": 1}, "", 1.0))) == 1
    assert len(list(_differences({"a": 1}, {"a": 1, "b": 2}, "", 1.0))) == 1


def test_keys_that_an_older_version_did_not_write_are_left_out_and_no_others() -> None:
    now: dict[str, Any] = {key: 1 for key in LATER_KEYS | WORDED if "." not in key}
    now |= {"onset": {"growth_time": 3.0, "kind": "fold", "visible_delay": 2.0}}
    now |= {"solver": {"name": "x", "contact_library": "y"}, "gi": {"closing": 1.2}}
    earlier = {"onset": {"growth_time": 3.0}, "solver": {"name": "x"}, "gi": {"closing": 1.2}}
    earlier |= {"stability_note": "in other words"}
    this: Any = SimpleNamespace(versions=versions())
    stored, found = _comparable(this, earlier, now)
    assert stored == found == {key: earlier[key] for key in ("onset", "solver", "gi")}
    assert _comparable(this, now, now) == (now, now)
    without = {**now, "onset": None}  # a run that stays stable has no onset to lack keys
    assert _comparable(this, without, without) == (without, without)
    stored, found = _comparable(this, {**earlier, "onset": {}}, now)
    assert list(_differences(stored, found, "", 1.0)) == ["onset.growth_time = missing, not 3.0"]
