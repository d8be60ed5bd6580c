"""The scoreboard and the ranking of readings as CSV and Markdown."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Final

from gyrify.paper.cases import Case
from gyrify.paper.row import Row
from gyrify.paper.scoreboard import Scoreboard

SYMBOLS: Final = (
    "E is the stiffness ratio E_G/E_W, G the growth ratio G_G/G_W and T the initial thickness of the cortex; "
    "what is not named is standard: G = 3.6, T = 1.5 mm."
)
MARKS: Final = {True: "pass", False: "fail", None: "open"}


def write_text(path: Path, text: str) -> None:
    """Write a file by atomic rename."""
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(path.name + ".partial")
    partial.write_text(text, encoding="utf-8")
    os.replace(partial, path)


def scoreboard_csv(board: Scoreboard) -> str:
    """One line per observation."""
    names = ("id", "statement", "where", "paper", "ours", "rule", "result", "note")
    return csv_text(
        names,
        ((r.id, r.statement, r.where, r.paper, r.ours, r.rule, MARKS[r.passed], r.note) for r in board.rows),
    )


def cases_csv(rows: Mapping[Case, Row]) -> str:
    """One line per simulation."""
    names = (
        "stiffness_ratio",
        "growth_ratio",
        "thickness_mm",
        "status",
        "gi",
        "n_gyri",
        "sulcal_depth_mm",
        "gyrus_width_mm",
        "crown_over_fundus",
        "fold_sharpness",
        "phenotype",
        "because",
        "key",
    )
    lines = (
        (
            *(repr(value) for value in (case.stiffness, case.growth, case.thickness)),
            row.status,
            *(
                repr(value)
                for value in (row.gi, row.n_gyri, row.depth, row.width, row.crown_fundus, row.sharpness)
            ),
            row.label,
            row.because or row.reason,
            row.key,
        )
        for case, row in sorted(rows.items())
    )
    return csv_text(names, lines)


def scoreboard_markdown(board: Scoreboard) -> str:
    """A page with the table, and a sentence on everything that does not pass."""
    table = markdown_table(
        ("", "The paper says", "paper", "ours", ""),
        [(r.id, r.statement, r.paper, r.ours, MARKS[r.passed]) for r in board.rows],
    )
    notes = [f"- **{r.id}** ({MARKS[r.passed]}): {r.note}." for r in board.rows if r.note]
    rules = [f"- **{r.id}** ({r.where}): {r.rule}" for r in board.rows]
    blocks = (
        "# Wang, Yao and Hu (2019), reproduced",
        f"Reading: {board.reading}. **{board.passed} of {len(board.rows)}** observations hold. {SYMBOLS}",
        table,
        "## Notes",
        "\n".join(notes) or "Nothing to add.",
        "## Rules",
        "\n".join(rules),
    )
    return "\n\n".join(blocks) + "\n"


def markdown_table(names: Sequence[str], lines: Sequence[Sequence[object]]) -> str:
    """A table in Markdown; bars inside cells are escaped."""
    cells = [[str(cell).replace("|", "\\|") for cell in line] for line in (names, *lines)]
    rows = ["| " + " | ".join(line) + " |" for line in cells]
    return "\n".join([rows[0], "|" + "---|" * len(names), *rows[1:]])


def csv_text(names: Sequence[str], lines: Iterable[Sequence[object]]) -> str:
    """Comma-separated values with a heading."""
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(names)
    writer.writerows(lines)
    return buffer.getvalue()
