"""The tables of the page are sums of the lines of the campaigns."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
_spec = importlib.util.spec_from_file_location("fuzz_page", ROOT / "tools" / "fuzz_page.py")
fuzz_page = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(fuzz_page)

LINE = {"target": "a", "way": "mutation", "slowest_s": 0.5, "peak_MB": 100}


def test_lines_of_a_target_are_added_up() -> None:
    lines = [
        {**LINE, "inputs": 2000, "read": 500, "refused": 1500},
        {**LINE, "inputs": 2000, "read": 1996, "crash": 1, "hang": 2, "escape": 1, "slowest_s": 3.0},
        {**LINE, "way": "coverage", "inputs": 10, "read": 10},
    ]
    rows = fuzz_page.table(lines, {"a": "something"}).splitlines()[2:]
    assert rows == [
        "| something | mutation | 4 000 | 2 496 | 1 500 | 1 | 2 | 1 | 3.00 | 100 |",
        "| something | coverage | 10 | 10 | 0 | 0 | 0 | 0 | 0.50 | 100 |",
    ]


def test_hdf5_is_told_apart() -> None:
    lines = [{"inputs": 10, "read": 4, "refused": 3, "hang": 2, "accepted": 1}, {"inputs": 5, "crash": 5}]
    assert fuzz_page.table_of_hdf5(lines).splitlines()[2] == "| 15 | 14 | 4 | 3 | 5 | 2 | 0 |"


@pytest.mark.parametrize("begin", [fuzz_page.BEGIN, fuzz_page.BEGIN_HDF5])
def test_one_table_is_replaced_and_nothing_else(begin: str) -> None:
    page = fuzz_page.PAGE.read_text(encoding="utf-8")
    once = fuzz_page.with_table(page, "| new |", begin)
    assert once.count("| new |") == 1
    assert fuzz_page.with_table(once, "| newer |", begin) == once.replace("| new |", "| newer |")
    assert begin in once
