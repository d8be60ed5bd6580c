"""Every code block of the README and the documentation does what its page says."""

from __future__ import annotations

import contextlib
import io
import json
import re
from pathlib import Path

import pytest
from blocks import PAGES, ROOT, Block, blocks, faults
from options import unknown_options
from printed import missing_lines, unknown_columns, unknown_keys
from runner import Runner

from gyrify import Config, measure_state, simulate
from gyrify.cli import main

BLOCKS = {page: blocks(page) for page in PAGES}
WITH_BLOCKS = [page for page in PAGES if BLOCKS[page]]
WITH_SLOW = [page for page in PAGES if any(block.is_slow for block in BLOCKS[page])]


def test_languages_and_notes_are_known() -> None:
    found = [fault for page in PAGES for block in BLOCKS[page] for fault in faults(block)]
    assert not found, "\n".join(found)


def test_commands_and_options_exist() -> None:
    scripts = [block for page in PAGES for block in BLOCKS[page] if block.language == "sh"]
    assert len(scripts) > 40
    expected = [block for block in scripts if block.value("exits") != "2"]
    found = {block.place: unknown_options(block.text) for block in expected}
    assert {place: unknown for place, unknown in found.items() if unknown} == {}


@pytest.mark.parametrize("page", WITH_BLOCKS, ids=lambda page: page.stem)
def test_quick_blocks(page: Path, tmp_path: Path) -> None:
    quick = [block for block in BLOCKS[page] if not block.is_slow]
    assert _run(quick, tmp_path) == len(quick)


@pytest.mark.slow
@pytest.mark.parametrize("page", WITH_SLOW, ids=lambda page: page.stem)
def test_all_blocks(page: Path, tmp_path: Path) -> None:
    assert _run(BLOCKS[page], tmp_path) == len(BLOCKS[page])


def _run(chosen: list[Block], folder: Path) -> int:
    """Run or compare blocks in order; how many were."""
    runner = Runner(folder)
    for block in chosen:
        runner.run(block)
    return runner.n_checked


def test_a_comment_before_a_block_is_its_note(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text(
        "<!-- block: slow -->\n```sh\ntrue\n```\n\nText.\n\n    indented\n\n- item\n\n  ```toml\n  ```\n"
    )
    first, second, third = blocks(page)
    assert (first.notes, first.language, first.line) == (("slow",), "sh", 2)
    assert (second.notes, second.language) == ((), "")
    assert third.language == "toml"


def test_unknown_language_and_note_are_faults() -> None:
    page = PAGES[0]
    assert faults(Block(page, 1, "fortran", "")) != []
    assert faults(Block(page, 1, "", "")) != []
    assert faults(Block(page, 1, "sh", "", ("quick",))) != []
    assert faults(Block(page, 1, "sh", "", ("as shown:",))) != []
    assert faults(Block(page, 1, "sh", "", ("slow", "exits 3"))) == []


def test_a_wrong_page_fails(tmp_path: Path) -> None:
    page = PAGES[0]
    wrong = [
        Block(page, 1, "sh", "gyrify presets --no-such-option"),
        Block(page, 1, "sh", "make no-such-target"),
        Block(page, 1, "sh", "pip install '.[no-such-extra]'"),
        Block(page, 1, "sh", "pip install 'gyrify[notebook]'"),  # nothing is published
        Block(page, 1, "toml", "[growth]\nratoi = 3\n"),
        Block(page, 1, "python", "assert False"),
        Block(page, 1, "text", "never printed"),
    ]
    for block in wrong:
        with pytest.raises(Exception):  # noqa: B017 - any error is the point
            Runner(tmp_path).run(block)


def test_commands_that_are_not_run_must_exist() -> None:
    assert unknown_options("gyrify paper --readings --workers 2 \\\n  --out paper  # long\nmake run") == []
    assert unknown_options("gyrify papre --readings") == ["gyrify papre"]
    assert unknown_options("gyrify config show --no-such") == ["gyrify config show --no-such"]
    assert unknown_options("pip install something-else") != []


@pytest.mark.slow
def test_the_progress_that_the_quick_start_shows_is_that_of_its_run(tmp_path: Path) -> None:
    page = (ROOT / "docs" / "quick-start.md").read_text(encoding="utf-8")
    shown = re.search(r"(\d+)% .* time (\d+)/500  GI (\S+)  increment (\d+)  (\d+) iterations", page)
    assert shown is not None
    history = simulate(Config.preset("reference-slice"), tmp_path / "run")
    number = int(shown[4])
    work = history.journal.column("newton_iterations")
    assert history.fractions[number] == pytest.approx(int(shown[1]) / 100)
    assert history.growth_times[number] == pytest.approx(float(shown[2]))
    assert measure_state(history, number).gi_closing == pytest.approx(float(shown[3]), abs=0.005)
    assert work[number] == pytest.approx(int(shown[5]), abs=3)


def test_printed_numbers_may_round_differently_and_no_more() -> None:
    printed = "start\nGI 1.412 (closing of 10 mm); 19 gyri\n5 increments, 3.4 s\n"
    assert missing_lines("GI 1.411 (closing of 10 mm); 19 gyri\n…\n5 increments, 9 s", printed) == []
    assert missing_lines("GI 1.511 (closing of 10 mm); 19 gyri", printed) != []
    assert missing_lines("GI 1.412 (closing of 10 mm); 9 gyri", printed) != []
    assert missing_lines("5 increments, 9 s\nstart", printed) == ["start"]


def test_samples_are_compared_by_key() -> None:
    real = {"gi": {"hull": 1.2, "rows": [{"id": "P1"}]}, "onset": None}
    assert unknown_keys({"gi": {"hull": 1.2, "rows": [{"id": "x"}]}, "onset": {"mode": 1}}, real) == []
    assert unknown_keys({"gi": {"hull": 1.21}}, real) == [".gi.hull = 1.21, not 1.2"]
    assert unknown_keys({"exposed": 2.608}, {"exposed": 2.625}) == [".exposed = 2.608, not 2.625"]
    assert unknown_keys({"wall_s": 9.0}, {"wall_s": 1.0}) == []
    assert unknown_keys({"gi": {"hul": 1.2}}, real) == [".gi.hul"]
    assert unknown_keys({"gi": {"rows": [{"name": "x"}]}}, real) == [".gi.rows[].name"]
    assert unknown_keys({"gi": 1.0}, real) == [".gi is dict"]
    assert unknown_columns("gi_hull,…\n1,2\n", "time,gi_hull\n") == []
    assert unknown_columns("gi\n", "time,gi_hull\n") == ["gi"]


def test_pages_that_follow_one_another_do_not_collide() -> None:
    """The same folder holds the same run on the first pages, which a new user follows in one place."""
    folders: dict[str, set[str]] = {}
    for name in ("README.md", "docs/quick-start.md", "docs/tutorial.md"):
        for block in BLOCKS[ROOT / name]:
            for line in block.text.splitlines() if block.language == "sh" else ():
                words = line.split("#")[0].split()
                if words[:2] != ["gyrify", "run"] or "--out" not in words:
                    continue
                place = words.index("--out")
                options = words[2:place] + words[place + 2 :]
                shown = io.StringIO()
                with contextlib.redirect_stdout(shown):
                    assert main(["config", "show", *options, "--json"]) == 0
                folders.setdefault(words[place + 1], set()).add(json.loads(shown.getvalue())["config_hash"])
    assert len(folders) >= 4
    assert {folder: hashes for folder, hashes in folders.items() if len(hashes) > 1} == {}
