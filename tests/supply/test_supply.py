"""What gyrify runs with: licences, pins, and lower bounds that are those which are tested."""

from __future__ import annotations

import importlib.util
import sys
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[2]
_spec = importlib.util.spec_from_file_location("audit", ROOT / "tools" / "audit.py")
audit = importlib.util.module_from_spec(_spec)
sys.modules["audit"] = audit
_spec.loader.exec_module(audit)

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
EXTRAS = PROJECT["optional-dependencies"]


def test_nothing_at_run_time_is_copyleft_or_unknown() -> None:
    found = list(audit.licences())
    assert len(found) > 30
    assert {"numpy", "cyclopts", "pydantic-core"} <= {item.name for item in found}
    assert [item for item in found if item.fault] == []


@pytest.mark.parametrize(
    ("stated", "fault"),
    [
        ("MIT", ""),
        ("GPL-3.0-or-later", "copyleft"),
        ("GNU General Public License v3 (GPLv3)", "copyleft"),
        ("AGPL-3.0-only", "copyleft"),
        ("GNU Affero General Public License v3", "copyleft"),
        ("", "unknown"),
        ("Proprietary", "unknown"),
    ],
)
def test_licences_are_judged(stated: str, fault: str) -> None:
    assert audit.Licence("some", "1", stated).fault == fault


def test_what_is_not_settled_by_metadata_is_named_and_documented() -> None:
    page = (ROOT / "SECURITY.md").read_text(encoding="utf-8")
    assert {"mkl", "imageio-ffmpeg"} <= set(audit.NAMED)
    assert all(f"`{name}`" in page for name in ("mkl", "imageio-ffmpeg"))


def test_continuous_integration_pins_everything() -> None:
    direct = [*PROJECT["dependencies"], *(line for lines in EXTRAS.values() for line in lines)]
    pinned = audit.pins()
    for text in direct:
        requirement = Requirement(text)
        assert requirement.specifier.contains(pinned[canonicalize_name(requirement.name)]), text
    whole = audit.required(audit.ALL)
    assert len(whole) > 80
    assert whole - set(pinned) == set()


def test_the_lowest_versions_are_the_lower_bounds() -> None:
    lowest = audit.pins(ROOT / "constraints-lowest.txt")
    bounds = {}
    for text in [*PROJECT["dependencies"], *(line for lines in EXTRAS.values() for line in lines)]:
        requirement = Requirement(text)
        (bound,) = (part.version for part in requirement.specifier if part.operator == ">=")
        bounds[canonicalize_name(requirement.name)] = bound
    tested = {name: version for name, version in bounds.items() if name in lowest}
    assert set(lowest) == set(tested)
    for name, bound in tested.items():
        assert lowest[name] == bound or lowest[name].startswith(f"{bound}."), name
    run_time = {canonicalize_name(Requirement(text).name) for text in PROJECT["dependencies"]}
    assert run_time <= set(lowest)
