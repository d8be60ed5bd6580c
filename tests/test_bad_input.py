"""Every bad input gets one clear message, and the page that lists them is up to date."""

from __future__ import annotations

from pathlib import Path

import bad_input
import pytest


@pytest.mark.parametrize("case", bad_input.CASES, ids=lambda case: case.id)
def test_message(case: bad_input.Case, tmp_path: Path) -> None:
    code, message = bad_input.provoke(case, tmp_path)
    assert code == case.exit_code
    for part in case.expected:
        assert part in message
    assert message.startswith("gyrify: ")
    assert message.count("gyrify: ") == 1
    for jargon in ("Traceback", "pydantic", "ValidationError", "type=", "validator"):
        assert jargon not in message
    assert all(character.isprintable() or character == "\n" for character in message)


def test_case_names_are_unique() -> None:
    names = [case.id for case in bad_input.CASES]
    assert len(names) == len(set(names))


def test_page_is_up_to_date() -> None:
    stale = "docs/bad-input.md is stale: run python tests/bad_input.py"
    written, fresh = bad_input.PAGE.read_text("utf-8"), bad_input.page()
    assert bad_input.own_lines(written) == bad_input.own_lines(fresh), stale
