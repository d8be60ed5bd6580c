"""Writes the results of `gyrify paper --readings` into docs/evidence.md, and copies figures beside it.

``python docs/figures/paper_evidence.py FOLDER``; the folder is the one that the command wrote. What stands
between the comments ``scan: begin NAME`` and ``scan: end NAME`` is replaced.
"""

from __future__ import annotations

import csv
import re
import shutil
import sys
from pathlib import Path

DOCS = Path(__file__).parent.parent
PAGE = DOCS / "evidence.md"
SHOWN = 12
FIGURES = ("figure-2", "figure-5", "figure-6", "figure-8")
QUANTITIES = ("GI, E = 1/1.36", "GI, E = 1", "gyri, E = 1/1.36", "gyri, E = 1")
THRESHOLDS = ("growth ratio of visible folds, E = 1/1.36", "growth ratio of visible folds, E = 1")


def ranking(folder: Path) -> str:
    """Summary, legend and the first lines of the matrix."""
    blocks = (folder / "readings.md").read_text(encoding="utf-8").split("\n\n")
    _, summary, legend, table = blocks[:4]
    summary = re.sub(
        r"The best \d+ are shown; readings.csv has all.", f"The best {SHOWN} are shown.", summary
    )
    return "\n\n".join((summary, legend, "\n".join(table.splitlines()[: SHOWN + 2])))


def best(folder: Path) -> str:
    """Scoreboard of the best reading, its notes, the spread over seeds, and its figures."""
    text = (folder / "best-1" / "scoreboard.md").read_text(encoding="utf-8")
    blocks = text.split("\n\n")
    heading, table, notes = blocks[1], blocks[2], blocks[4]
    with (folder / "seeds.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    names = ("observations that hold", *QUANTITIES, *THRESHOLDS)
    lines = ["| reading | " + " | ".join(names) + " |", "|---" * (len(names) + 1) + "|"]
    for reading in dict.fromkeys(row["reading"] for row in rows):
        of = {row["quantity"]: row for row in rows if row["reading"] == reading}
        cells = [_spread(of.get(name)) for name in names]
        lines.append("| " + " | ".join([reading, *cells]) + " |")
    pictures = [
        f"![The best reading, {name.replace('-', ' ')}](figures/paper-{name}.png)" for name in FIGURES
    ]
    spread = "Mean ± standard deviation over five seeds of the best three readings:"
    return "\n\n".join((heading, table, notes, spread, "\n".join(lines), *pictures))


def replaced(page: str, name: str, text: str) -> str:
    """The page with the text between two comments replaced."""
    pattern = rf"(<!-- scan: begin {name} -->\n).*?(\n<!-- scan: end {name} -->)"
    if not re.search(pattern, page, re.DOTALL):
        raise SystemExit(f"{PAGE} has no place for {name}.")
    return re.sub(pattern, lambda found: found[1] + text + found[2], page, flags=re.DOTALL)


def _spread(row: dict[str, str] | None) -> str:
    return "–" if row is None else f"{float(row['mean']):.3f} ± {float(row['standard_deviation']):.3f}"


def main(folder: Path) -> None:
    """Fill the page and copy the figures."""
    page = PAGE.read_text(encoding="utf-8")
    page = replaced(page, "ranking", ranking(folder))
    page = replaced(page, "best", best(folder))
    PAGE.write_text(page, encoding="utf-8")
    for name in FIGURES:
        shutil.copyfile(folder / "best-1" / "figures" / f"{name}.png", DOCS / "figures" / f"paper-{name}.png")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
