"""Every bad input gets one clear message, and the page that lists them is up to date."""

from __future__ import annotations

import contextlib
from pathlib import Path

import bad_input
import pytest
from bad_input_advice import ADVICE, Way

from gyrify.cli import main


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


def test_every_refusal_has_advice_that_is_tried() -> None:
    assert set(ADVICE) == {case.id for case in bad_input.CASES}
    assert all(ADVICE.values())


@pytest.mark.parametrize(
    ("case", "way"),
    [pytest.param(case, way, id=case.id) for case in bad_input.CASES for way in ADVICE.get(case.id, [])],
)
def test_the_advice_works(
    case: bad_input.Case, way: Way, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _, message = bad_input.provoke(case, tmp_path)
    assert way.says in message
    if way.first is not None:
        way.first(tmp_path)
    arguments = list(way.args)
    if way.toml is not None:
        (tmp_path / "mended.toml").write_text(way.toml, encoding="utf-8")
        arguments.append("mended.toml")
    with contextlib.chdir(tmp_path):
        for command in filter(None, (arguments, list(way.then))):
            assert main(command) == 0, capsys.readouterr().err


def test_case_names_are_unique() -> None:
    names = [case.id for case in bad_input.CASES]
    assert len(names) == len(set(names))


def test_page_is_up_to_date() -> None:
    stale = "docs/bad-input.md is stale: run python tests/bad_input.py"
    written, fresh = bad_input.PAGE.read_text("utf-8"), bad_input.page()
    assert bad_input.own_lines(written) == bad_input.own_lines(fresh), stale
