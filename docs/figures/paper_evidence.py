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
FIGURES = ("figure-2", "figure-5", "figure-6", "figure-8", "figure-S1", "figure-S2")
HOLDS = "observations that hold"
COLUMNS = {
    HOLDS: "holds",
    f"{HOLDS} with fresh seeds": "fresh seeds",
    f"{HOLDS} by the first rules": "first rules",
    "GI, E = 1/1.36": "GI, E = 1/1.36",
    "GI, E = 1": "GI, E = 1",
    "gyri, E = 1": "gyri, E = 1",
    "growth ratio of visible folds, E = 1": "folds seen, E = 1",
    "growth ratio of visible folds, E = 1/1.36": "folds seen, E = 1/1.36",
}


def ranking(folder: Path) -> str:
    """Everything of ``readings.md`` but its title and the readings with several seeds, a level lower."""
    text = (folder / "readings.md").read_text(encoding="utf-8")
    blocks = text.rstrip().split("\n\n")[1:]
    first = [number for number, block in enumerate(blocks) if block.startswith("## ") and "; GI by" in block]
    return "\n\n".join(
        f"#{block}" if block.startswith("## ") else block for block in blocks[: (*first, len(blocks))[0]]
    )


def best(folder: Path) -> str:
    """Scoreboard of the best reading, its notes, all readings with several seeds, and the figures."""
    text = (folder / "best-1" / "scoreboard.md").read_text(encoding="utf-8")
    blocks = text.split("\n\n")
    heading, table, notes = blocks[1], blocks[2], blocks[4]
    pictures = [
        f"![The best reading, {name.replace('-', ' ')}](figures/paper-{name}.png)" for name in FIGURES
    ]
    return "\n\n".join((heading, table, notes, *seeds(folder), *pictures))


def seeds(folder: Path) -> tuple[str, str, str]:
    """The best readings with five seeds: their spread, and how often each observation holds."""
    with (folder / "seeds.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    lines = ["| reading | " + " | ".join(COLUMNS.values()) + " |", "|---" * (len(COLUMNS) + 1) + "|"]
    for rank in dict.fromkeys(row["rank"] for row in rows):
        of = {row["quantity"]: row for row in rows if row["rank"] == rank}
        cells = [_spread(of.get(name)) for name in COLUMNS]
        lines.append("| " + " | ".join([of[HOLDS]["reading"], *cells]) + " |")
    text = (folder / "readings.md").read_text(encoding="utf-8")
    tables = [block for block in text.split("\n\n") if block.startswith("| P1 |")]
    passes = tables[0].splitlines()[:2] + [table.splitlines()[2] for table in tables]
    told = (
        "Mean ± standard deviation over five seeds, of which seeds 3 and 4 are fresh; first the best three "
        "with fitted constants, then without:"
    )
    return told, "\n".join(lines), "\n".join(("Seeds with which each holds, in the same order:", "", *passes))


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
