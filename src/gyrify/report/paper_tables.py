"""The scoreboard and the ranking of readings as CSV and Markdown."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Final

from gyrify.paper.cases import Case
from gyrify.paper.observations import Observation, observations
from gyrify.paper.row import Row
from gyrify.paper.scoreboard import Scoreboard, ScoreRow
from gyrify.store.files import whole_file

SYMBOLS: Final = (
    "E is the stiffness ratio E_G/E_W, G the growth ratio G_G/G_W and T the initial thickness of the cortex; "
    "what is not named is standard: G = 3.6, T = 1.5 mm."
)
FIRST: Final = "by the first rule"
MARKS: Final = {True: "pass", False: "fail", None: "open"}


def write_text(path: Path, text: str) -> None:
    """Write a file by atomic rename."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole_file(path) as partial:
        partial.write_text(text, encoding="utf-8")


def scoreboard_csv(board: Scoreboard) -> str:
    """One line per observation."""
    names = ("id", "statement", "where", "paper", "ours", "rule", "result", "by_first_rule", "note")
    lines = (
        (r.id, r.statement, r.where, r.paper, r.ours, r.rule, MARKS[r.passed], MARKS[r.first_passed], r.note)
        for r in board.rows
    )
    return csv_text(names, lines)


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
        ("", "The paper says", "paper", "ours", "", FIRST),
        [(r.id, r.statement, r.paper, r.ours, MARKS[r.passed], by_first_rule(r)) for r in board.rows],
    )
    notes = [f"- **{r.id}** ({MARKS[r.passed]}): {r.note}." for r in board.rows if r.note]
    rules = [f"- **{r.id}** ({r.where}): {rule_told(r)}" for r in board.rows]
    blocks = (
        "# Wang, Yao and Hu (2019), reproduced",
        f"Reading: {board.reading}. {held(board, '**')} {SYMBOLS}",
        table,
        "## Notes",
        "\n".join(notes) or "Nothing to add.",
        "## Rules",
        "\n".join(rules),
    )
    return "\n\n".join(blocks) + "\n"


def held(board: Scoreboard, strong: str = "") -> str:
    """The score by both sets of rules, as a sentence."""
    score = f"{strong}{board.passed} of {len(board.rows)}{strong}"
    return f"{score} observations hold; by the rules as they were first frozen, {board.first_passed}."


def by_first_rule(row: ScoreRow) -> str:
    """What a corrected row comes to by its first rule; empty where the rule was not corrected."""
    return MARKS[row.first_passed] if _rules()[row.id].reason else ""


def rule_told(row: ScoreRow) -> str:
    """The rule in force, and what it was before where it was corrected."""
    rule = _rules()[row.id]
    if not rule.reason:
        return row.rule
    return f"{row.rule} Corrected: {rule.reason} The first rule: {rule.first_rule}"


def _rules() -> dict[str, Observation]:
    return {observation.id: observation for observation in observations()}


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
