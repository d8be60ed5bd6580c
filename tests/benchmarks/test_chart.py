"""The picture of the plan shows what was measured, and is the same each time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from bench.chart import draw, points
from bench.figures import Figure, append, by_name, record


def measured() -> list[Figure]:
    found = []
    for name, quantities in (("pardiso", ("factorisation", "memory")), ("multigrid", ("setup", "memory"))):
        for quantity in quantities:
            sizes = (36_864, 4_608)
            found += [Figure(f"{name}, {n} cells: {quantity}", 1e-4 * n**1.5, "s") for n in sizes]
            found.append(Figure(f"{name}, a million: {quantity}", 1e5, "s", is_extrapolated=True))
    return found


def test_points_are_sorted_and_of_one_quantity() -> None:
    cells, values = points(by_name(measured()), "pardiso", "factorisation")
    np.testing.assert_array_equal(cells, [4_608, 36_864])
    np.testing.assert_allclose(values, 1e-4 * cells**1.5)
    assert points(by_name(measured()), "superlu", "factorisation")[0].size == 0


def test_same_history_gives_the_same_picture(tmp_path: Path) -> None:
    history, pictures = tmp_path / "history.jsonl", [tmp_path / "a.png", tmp_path / "b.png"]
    append(record({"standard": []}, quick=False), history)
    draw(history, pictures[0])
    assert not pictures[0].exists(), "nothing was measured in space"
    append(record({"space": measured()}, quick=False), history)
    for picture in pictures:
        draw(history, picture)
    assert pictures[0].read_bytes() == pictures[1].read_bytes()
    assert pictures[0].read_bytes().startswith(b"\x89PNG")
