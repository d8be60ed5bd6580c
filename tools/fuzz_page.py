"""Write the tables of docs/reliability-fuzz.md from the JSON lines of the campaigns."""

from __future__ import annotations

import json
import re
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

ROOT: Final = Path(__file__).resolve().parents[1]
PAGE: Final = ROOT / "docs" / "reliability-fuzz.md"
BEGIN, END = "<!-- table: tools/fuzz.py page -->", "<!-- end of table -->"
BEGIN_HDF5: Final = "<!-- table of HDF5: tools/fuzz.py page -->"
HEAD: Final = (
    "| reader | way | inputs | read | refused clearly | crashes | hangs | others | CPU [s] | memory [MB] |",
    "|---|---|---|---|---|---|---|---|---|---|",
)
HEAD_HDF5: Final = (
    "| damaged files | refused by gyrify | HDF5: read | refused | crashes | hangs | no memory |",
    "|---|---|---|---|---|---|---|",
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
            *(_spaced(count[kind]) for kind in ("inputs", "read", "refused", "crash", "hang")),
            str(sum(count[kind] for kind in _OTHERS)),
            f"{max(line['slowest_s'] for line in group):.2f}",
            str(max(line["peak_MB"] for line in group)),
        )
        rows.append(f"| {' | '.join(cells)} |")
    return "\n".join((*HEAD, *rows))


def table_of_hdf5(lines: Sequence[Mapping[str, Any]]) -> str:
    """What gyrify, and what HDF5 in a process of its own, did with damaged time series."""
    count = {
        kind: sum(int(line.get(kind, 0)) for line in lines)
        for kind in ("inputs", "accepted", "read", "refused", "crash", "hang", "memory")
    }
    refused = count["inputs"] - count["accepted"]
    others = (count[kind] for kind in ("read", "refused", "crash", "hang", "memory"))
    row = " | ".join(_spaced(number) for number in (count["inputs"], refused, *others))
    return "\n".join((*HEAD_HDF5, f"| {row} |"))


def _spaced(number: int) -> str:
    return f"{number:,}".replace(",", " ")


def read_lines(path: Path) -> list[dict[str, Any]]:
    """Lines of JSON."""
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines() if line]


def with_table(page: str, new: str, begin: str = BEGIN) -> str:
    """A page with one of its tables replaced."""
    pattern = f"{re.escape(begin)}.*?{re.escape(END)}"
    return re.sub(pattern, lambda _: f"{begin}\n\n{new}\n\n{END}", page, flags=re.DOTALL)


def write_page(path: Path) -> None:
    """Write the tables into the page."""
    from targets import TARGETS

    what = {target.name: target.what for target in TARGETS.values()}
    lines = read_lines(path)
    text = PAGE.read_text(encoding="utf-8")
    text = with_table(text, table([line for line in lines if line["target"] in what], what))
    apart = [line for line in lines if line["target"] == "hdf5"]
    PAGE.write_text(with_table(text, table_of_hdf5(apart), BEGIN_HDF5), encoding="utf-8")
