"""Pages whose tables come from the history: what stands between two marks is written anew.

A mark is ``<!-- figures: NAME -->``, and ``<!-- end -->`` closes it; the names are those of `BLOCKS`.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bench.figures import HISTORY, Figure, latest
from bench.table import text

Latest = dict[str, tuple[dict[str, Any], dict[str, Figure]]]


@dataclass(frozen=True)
class Block:
    """A table of a page.

    Attributes
    ----------
    cases : tuple of str
        Benchmarks, the first that was measured counts.
    only, without : str
        Regular expressions: figures to take, and to leave out.
    head : tuple of str
        Heads of the columns of a plain list.
    is_crossed : bool
        Whether figures named ``subject: quantity`` make a table of subjects and quantities.
    is_wide : bool
        Whether the subjects are the rows of such a table.
    """

    cases: tuple[str, ...]
    only: str = ""
    without: str = "^$"
    head: tuple[str, str] = ("", "")
    is_crossed: bool = False
    is_wide: bool = False


BLOCKS = {
    "standard": Block(("standard",), without="share of", is_crossed=True),
    "split": Block(("standard",), only="share of", is_crossed=True),
    "command": Block(("command",), head=("command", "seconds")),
    "sizes": Block(("finest", "fine"), only="cells: ", is_crossed=True, is_wide=True),
    "exponent": Block(("finest", "fine"), only="^exponent"),
    "elements": Block(("quadratic",), is_crossed=True, is_wide=True),
    "soft": Block(("soft",), is_crossed=True, is_wide=True),
    "kernels": Block(("kernels",), head=("at the folded state of the standard run", "time")),
    "threshold": Block(("threshold",)),
    "iteration": Block(("iteration",), is_crossed=True),
    "assembly": Block(("assembly",), only="cells: ", is_crossed=True),
    "whole-run": Block(("whole-run",)),
    "dynamics": Block(("dynamics",)),
    "solvers": Block(("solvers",), is_crossed=True, is_wide=True),
    "factors": Block(("space",), only=r"^(pardiso|superlu), \d+ cells", is_crossed=True, is_wide=True),
    "multigrid": Block(("space",), only=r"^multigrid, \d+ cells", is_crossed=True, is_wide=True),
    "exponents": Block(("space",), only=": exponent of", is_crossed=True),
    "million": Block(("space",), only="a million:", is_crossed=True),
    "rates": Block(("space",), only="^(assembly|contact)"),
    "plan": Block(("space",), only="^plan: "),
}
_MARKED = re.compile(r"(<!-- figures: (?P<name>[\w-]+) -->\n).*?(<!-- end -->)", re.DOTALL)


def refresh(path: Path, history: Path = HISTORY) -> None:
    """Write the tables of a page from the history.

    Raises
    ------
    KeyError
        If the page asks for a table that is not in `BLOCKS`.
    """
    found = latest(history)

    def block(match: re.Match[str]) -> str:
        return f"{match[1]}{table(match['name'], found)}\n{match[3]}"

    path.write_text(_MARKED.sub(block, path.read_text(encoding="utf-8")), encoding="utf-8")


def table(name: str, found: Latest) -> str:
    """One Markdown table, with where it was measured below it."""
    block = BLOCKS[name]
    case = next((case for case in block.cases if case in found), None)
    if case is None:
        return "Not measured yet."
    entry, figures = found[case]
    taken = [f for n, f in figures.items() if re.search(block.only, n) and not re.search(block.without, n)]
    rows = _crossed(taken, block.is_wide) if block.is_crossed else _list(taken, block.head)
    return "\n".join([*rows, "", _where(entry, case)])


def _list(figures: list[Figure], head: tuple[str, str]) -> list[str]:
    return [f"| {head[0]} | {head[1]} |", "|---|---|", *(f"| {f.name} | {text(f)} |" for f in figures)]


def _crossed(figures: list[Figure], is_wide: bool) -> list[str]:
    """Subjects across and quantities down, or the other way round."""
    cells: dict[tuple[str, str], str] = {}
    for figure in figures:
        subject, _, quantity = figure.name.partition(": ")
        cells[(subject, quantity) if is_wide else (quantity, subject)] = text(figure)
    down, across = (list(dict.fromkeys(key[side] for key in cells)) for side in (0, 1))
    return [
        f"| | {' | '.join(across)} |",
        "|---" * (len(across) + 1) + "|",
        *(f"| {row} | {' | '.join(cells.get((row, column), '') for column in across)} |" for row in down),
    ]


def _where(entry: dict[str, Any], case: str) -> str:
    machine = entry["machine"]
    words = "small slices, to try the page out" if entry["quick"] else f"`--only {case}`"
    return (
        f"*{words}; commit {entry['commit']}, {entry['date']}; {machine['cpu']}, {machine['cores']} cores.*"
    )
