"""Samples, the history of records, and the pages made from it."""

from __future__ import annotations

from itertools import count
from pathlib import Path

import numpy as np
import pytest
from bench.figures import Figure, append, latest, record
from bench.page import BLOCKS, refresh
from bench.table import text
from bench.timing import Sample, interleaved

PAGES = [Path(__file__).parents[2] / "docs" / name for name in ("speed.md", "planning-3d.md")]


def test_tasks_take_turns_and_are_timed_alone() -> None:
    now, order = count(), []
    ticks = iter(float(n) for n in now)
    tasks = {name: (lambda name=name: order.append(name)) for name in ("a", "b")}
    times = interleaved(tasks, 3, least=0.0, clock=lambda: next(ticks))
    assert order == ["a", "b", "a", "b", "b", "a", "a", "b"]
    assert all(sample.values == (1.0, 1.0, 1.0) for sample in times.values())


def test_ratio_is_taken_pair_by_pair() -> None:
    ratio = Sample((2.0, 9.0, 4.0)).over(Sample((1.0, 3.0, 4.0)))
    assert ratio.values == (2.0, 3.0, 1.0)
    assert (ratio.low, ratio.median, ratio.high) == (1.5, 2.0, 2.5)
    with pytest.raises(ValueError, match="shorter"):
        Sample((1.0, 2.0)).over(Sample((1.0,)))


def test_latest_full_record_of_every_case_counts(tmp_path: Path) -> None:
    history = tmp_path / "history.jsonl"
    for value, quick, case in ((1.0, False, "a"), (2.0, False, "a"), (3.0, True, "a"), (4.0, True, "b")):
        append(record({case: [Figure("solve", value, "s", low=0.5, high=5.0)]}, quick=quick), history)
    found = latest(history)
    assert found["a"][1]["solve"] == Figure("solve", 2.0, "s", 0.5, 5.0)
    assert found["b"][1]["solve"].value == 4.0
    assert len(history.read_text().splitlines()) == 4


def test_zero_is_a_value(tmp_path: Path) -> None:
    history = tmp_path / "history.jsonl"
    append(record({"a": [Figure("rejected", 0), Figure("ratio", 1.0, "x")]}, quick=False), history)
    assert list(latest(history)["a"][1].values()) == [Figure("rejected", 0), Figure("ratio", 1.0, "x")]


def test_record_tells_of_versions_but_not_of_whose_machine_it_is() -> None:
    entry = record({"a": [Figure("solve", np.float64(1.5), "s")]}, quick=False)
    assert entry["versions"]["numpy"] == np.__version__
    assert set(entry["machine"]) == {"cpu", "cores", "system"}
    assert str(Path.home()) not in str(entry)


def test_page_is_written_from_the_history_and_stays_the_same(tmp_path: Path) -> None:
    history, page = tmp_path / "history.jsonl", tmp_path / "page.md"
    figures = [Figure("pardiso: solve", 1.25, "s", 1.2, 1.3), Figure("superlu: solve", 2.5, "s")]
    append(record({"standard": figures}, quick=False), history)
    page.write_text("before\n<!-- figures: standard -->\nold\n<!-- end -->\nafter\n")
    refresh(page, history)
    written = page.read_text()
    assert "| solve | 1.25 s (1.2–1.3) | 2.5 s |" in written
    assert "old" not in written
    assert written.startswith("before\n")
    assert written.endswith("after\n")
    refresh(page, history)
    assert page.read_text() == written


def test_unknown_table_is_refused(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("<!-- figures: nothing -->\n<!-- end -->\n")
    append(record({"a": []}, quick=True), tmp_path / "history.jsonl")
    with pytest.raises(KeyError, match="nothing"):
        refresh(page, tmp_path / "history.jsonl")


def test_extrapolated_figures_are_marked() -> None:
    assert text(Figure("total", 12.0, "s", is_extrapolated=True)) == "≈ 12 s"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_pages_ask_for_tables_that_exist(page: Path) -> None:
    import re

    names = re.findall(r"<!-- figures: ([\w-]+) -->", page.read_text())
    assert names
    assert set(names) <= set(BLOCKS)
