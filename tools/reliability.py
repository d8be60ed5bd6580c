"""Write the numbers of the reliability page from the records of ``random_runs.py`` and ``kill_*.py``.

``python tools/reliability.py RECORDS... [--kills KILLS]`` keeps what the page needs of the records in
``docs/figures/reliability.jsonl`` and ``reliability-kills.jsonl``. Without arguments it takes
these. It replaces the tables between the marks in ``docs/reliability.md``; the figure is drawn by
``docs/figures/make_reliability.py``.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Final

DOCS: Final = Path(__file__).parents[1] / "docs"
RUNS: Final = DOCS / "figures" / "reliability.jsonl"
KILLS: Final = DOCS / "figures" / "reliability-kills.jsonl"
PAGE: Final = DOCS / "reliability.md"
OUTCOMES: Final = ("completed", "stopped", "exhausted", "wrong")
HEADS: Final = ("completed", "stopped with a reason", "not converged", "wrong or unexplained")
SPACES: Final = {"box": "sensible box", "wide": "whole space"}
# What the figure and the tables need of a configuration, and the value of the standard slice where not given.
KEPT: Final[dict[str, Any]] = {
    "material.stiffness_ratio": 1.0,
    "growth.ratio": 3.6,
    "geometry.cortical_thickness": 1.5,
    "geometry.shape": "ellipse",
    "mesh.element": "linear",
    "growth.out_of_plane": "blocked",
    "dissipation.kind": "drag",
    "dissipation.number": 1.3,
}
Record = dict[str, Any]


def read(path: Path) -> list[Record]:
    """Records of a file of JSON lines."""
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def kept(record: Record) -> Record:
    """What the page needs of a record; the rest follows from its number."""
    names = ("space", "seed", "number", "outcome", "reason", "evidence", "wall_s")
    config = record["config"]
    values = {key: config.get(key, default) for key, default in KEPT.items()}
    return {**{name: record[name] for name in names}, "config": values}


def table(heads: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    """Markdown."""
    heads = list(heads)
    lines = [heads, ["---"] * len(heads), *([str(cell) for cell in row] for row in rows)]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def counts(records: list[Record]) -> list[object]:
    """All, and those of each outcome, and the share that completed."""
    found = Counter(record["outcome"] for record in records)
    share = found["completed"] / len(records) if records else 0.0
    return [len(records), *(found[name] for name in OUTCOMES), f"{share:.1%}"]


def outcomes(records: list[Record]) -> str:
    """One row per space."""
    rows = [
        [name, *counts([record for record in records if record["space"] == space])]
        for space, name in SPACES.items()
    ]
    return table(["", "configurations", *HEADS, "completed"], rows)


def dissipation(config: Record) -> str:
    """Kind of dissipation, ``none`` too where its number is zero."""
    return str(config["dissipation.kind"] if config["dissipation.number"] > 0 else "none")


def strata(records: list[Record]) -> str:
    """One row per value of what matters to a solver, both spaces together."""
    groups: dict[str, Callable[[Record], str]] = {
        "dissipation": dissipation,
        "element": lambda config: config["mesh.element"],
        "out of plane": lambda config: config["growth.out_of_plane"],
        "shape": lambda config: config["geometry.shape"],
    }
    rows: list[list[object]] = []
    for group, value_of in groups.items():
        for value in sorted({value_of(record["config"]) for record in records}):
            rows.append([group, value, *counts([r for r in records if value_of(r["config"]) == value])])
    return table(["", "", "configurations", *HEADS, "completed"], rows)


def early(records: list[Record]) -> str:
    """One row per run that did not complete."""
    rows = []
    for record in records:
        found, config = record["evidence"], record["config"]
        if record["outcome"] == "completed":
            continue
        numbers = (
            found["min_J"],
            found["min_gap_mm"],
            found["residual_over_tolerance"],
            found["lowest_eigenvalue"],
        )
        rows.append(
            [
                f"{record['space']} {record['number']}",
                record["reason"].replace("_", " "),
                f"{found['growth']:.1%}",
                *("–" if number is None else f"{number:.2g}" for number in numbers),
                f"{config['material.stiffness_ratio']:.2f}",
                f"{config['growth.ratio']:.3g}",
                f"{config['geometry.cortical_thickness']:.2f}",
                f"{dissipation(config)} {config['dissipation.number']:.2g}",
                config["mesh.element"].replace("_", " "),
            ]
        )
    heads = ["run", "reason", "growth reached", "least J", "least gap / mm", "residual / tolerance"]
    heads += ["lowest eigenvalue / (Pa/mm²)", "stiffness ratio", "growth ratio", "T / mm", "dissipation"]
    return table([*heads, "element"], rows)


def extremes(records: list[Record]) -> str:
    """The numbers that came closest to a wrong state, over the last states of all runs."""
    found = [record["evidence"] for record in records]
    gaps = [evidence["min_gap_mm"] for evidence in found if evidence["min_gap_mm"]]
    rows = [
        ["increments rechecked", sum(evidence["increments"] for evidence in found)],
        ["Newton iterations", sum(evidence["newton_iterations"] for evidence in found)],
        ["rejected increments", sum(evidence["rejected"] for evidence in found)],
        ["largest residual / tolerance", f"{max(e['residual_over_tolerance'] for e in found):.4f}"],
        ["smallest J", f"{min(evidence['min_J'] for evidence in found):.3g}"],
        ["smallest J of elasticity", f"{min(evidence['min_J_elastic'] for evidence in found):.3g}"],
        ["smallest gap / mm, where there is contact", f"{min(gaps):.2g}"],
        ["runs that folded (more than no gyrus)", sum(evidence["n_gyri"] > 0 for evidence in found)],
    ]
    return table(["", ""], rows)


def kill_table(kills: list[Record]) -> str:
    """One row per route."""
    rows = []
    for route, name in (("run", "runs"), ("processes", "studies, two processes"), ("dask", "studies, dask")):
        mine = [kill for kill in kills if kill["route"] == route]
        deaths = [death for kill in mine for death in kill.get("deaths", [])]
        inside = sum(death.startswith("inside") for death in deaths)
        n_kills = len(deaths) if route == "run" else sum(kill["killed"] for kill in mine)
        lost, same = sum(kill["n_lost"] for kill in mine), sum(kill["same"] for kill in mine)
        rows.append(
            [name, len(mine), n_kills, inside if route == "run" else "–", lost, f"{same} of {len(mine)}"]
        )
    heads = ["", "trials", "kills", "inside a commit", "accepted increments or runs lost", "equal hashes"]
    return table(heads, rows)


def main() -> int:
    """Keep the records and write the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("records", nargs="*", type=Path)
    parser.add_argument("--kills", type=Path)
    given = parser.parse_args()
    if given.records:
        found = [kept(record) for path in given.records for record in read(path)]
        found.sort(key=lambda record: (record["space"], record["seed"], record["number"]))
        RUNS.write_text("".join(json.dumps(record) + "\n" for record in found), encoding="utf-8")
    if given.kills:
        KILLS.write_text(given.kills.read_text(encoding="utf-8"), encoding="utf-8")
    runs, kills, page = read(RUNS), read(KILLS), PAGE.read_text(encoding="utf-8")
    tables = {"outcomes": outcomes, "strata": strata, "early": early, "extremes": extremes}
    texts = {**{name: make(runs) for name, make in tables.items()}, "kills": kill_table(kills)}
    for name, text in texts.items():
        mark = re.compile(rf"(<!-- {name} -->\n).*?(\n<!-- end -->)", re.DOTALL)
        page = mark.sub(lambda found, text=text: f"{found[1]}\n{text}\n{found[2]}", page)
    PAGE.write_text(page, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
