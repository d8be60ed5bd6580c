"""Write the table of docs/reliability-fuzz.md from the JSON lines of the campaigns."""

from __future__ import annotations

import json
import re
from collections import defaultdict
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Final

ROOT: Final = Path(__file__).resolve().parents[1]
PAGE: Final = ROOT / "docs" / "reliability-fuzz.md"
BEGIN, END = "<!-- table: tools/fuzz.py page -->", "<!-- end of table -->"
HEAD: Final = (
    "| reader | way | inputs | read | refused clearly | crashes | hangs | others | CPU [s] | memory [MB] |",
    "|---|---|---|---|---|---|---|---|---|---|",
)
_OTHERS: Final = ("memory", "message", "escape")


def table(lines: Iterable[Mapping[str, Any]], what: Mapping[str, str]) -> str:
    """One row for each reader and way of making inputs, in order of appearance."""
    groups: dict[tuple[str, str], list[Mapping[str, Any]]] = defaultdict(list)
    for line in lines:
        groups[line["target"], line["way"]].append(line)
    rows = []
    for (name, way), group in sorted(groups.items(), key=lambda item: [*what].index(item[0][0])):
        count = {
            kind: sum(int(line.get(kind, 0)) for line in group)
            for kind in ("inputs", "read", "refused", "crash", "hang", *_OTHERS)
        }
        cells = (
            what[name],
            way,
            *(
                f"{count[kind]:,}".replace(",", " ")
                for kind in ("inputs", "read", "refused", "crash", "hang")
            ),
            str(sum(count[kind] for kind in _OTHERS)),
            f"{max(line['slowest_s'] for line in group):.2f}",
            str(max(line["peak_MB"] for line in group)),
        )
        rows.append(f"| {' | '.join(cells)} |")
    return "\n".join((*HEAD, *rows))


def read_lines(path: Path) -> list[dict[str, Any]]:
    """Lines of JSON."""
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines() if line]


def with_table(page: str, new: str) -> str:
    """A page with its table replaced."""
    pattern = f"{re.escape(BEGIN)}.*?{re.escape(END)}"
    return re.sub(pattern, lambda _: f"{BEGIN}\n\n{new}\n\n{END}", page, flags=re.DOTALL)


def write_page(path: Path) -> None:
    """Write the table into the page."""
    from targets import TARGETS

    what = {target.name: target.what for target in TARGETS.values()}
    text = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(with_table(text, table(read_lines(path), what)), encoding="utf-8")
