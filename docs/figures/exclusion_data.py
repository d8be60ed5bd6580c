"""Computes the numbers behind the exclusion diagram of docs/evidence.md.

``python docs/figures/exclusion_data.py FOLDER [MESH ...]``; the folder keeps the runs. What is known is in
exclusion.json, and is not computed again.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from gyrify import Config
from gyrify.paper.cases import BOTH, EQUAL, SOFT, STIFFNESS, THICK, Case, threshold_ends
from gyrify.paper.index import STANDARD_INDEX, Index
from gyrify.paper.reading import Mechanics, Reading, point_of
from gyrify.paper.reproduce import known_rows
from gyrify.paper.scoreboard import score
from gyrify.paper.simulations import Simulations
from gyrify.theory import Annulus, critical_growth_ratio

DATA = Path(__file__).with_name("exclusion.json")
BASE = Mechanics("generalised", "exponential", imperfection=0.1)
# 0 is no dissipation
NUMBERS = (0.0, 0.1, 0.6, 2.6, 6.0)
EXPONENTS = (0.0, 0.14, 0.25, 0.5, 1.0)
COURSES = ("constant", "reduced")
MESHES: dict[str, dict[str, str]] = {
    "paper": {},
    "one diagonal": {"grading": "uniform", "split": "one"},
    "quadratic triangles": {"element": "quadratic"},
}
# On meshes other than the paper's, these numbers and exponents.
FEW = {
    "one diagonal": ((0.0, 0.6, 2.6), (0.0, 0.14, 0.5, 1.0)),
    "quadratic triangles": ((0.0, 0.6), (0.0, 0.14, 0.5)),
}
# By which the observations are judged: that of the best reading, and the standard one.
JUDGED = (Index("picture", pen=0.2), STANDARD_INDEX)
IDS = ("P3", "P4", "P6", "P7", "P12", "P13", "P15", "P17", "P18")
CASES = (
    *(Case(e) for e in (*STIFFNESS[:2], SOFT, EQUAL)),
    *(end for e in BOTH for end in threshold_ends(e)),
    *(Case(e, thickness=t) for t in (0.75, 3.0, *THICK) for e in BOTH),
)
# Slices whose exact onset is told, by their name on the picture: stiffness ratio and thickness.
ONSETS = {
    "E = 1": (EQUAL, 1.5),
    "E = 1/1.36": (SOFT, 1.5),
    "E = 1/2.61": (STIFFNESS[1], 1.5),
    "E = 1/3": (STIFFNESS[0], 1.5),
    "E = 1, T = 3 mm": (EQUAL, 3.0),
    "E = 1, T = 8 mm": (EQUAL, 8.0),
}
FINE = (0.0, 0.14, 0.3, 0.6, 1.0)


def known() -> dict[str, Any]:
    """What is stored."""
    return json.loads(DATA.read_text(encoding="utf-8")) if DATA.exists() else {}


def keep(part: str, key: str, value: Any) -> None:
    """Store something of a part."""
    data = known()
    data.setdefault(part, {})[key] = value
    DATA.write_text(json.dumps(data, indent=1, sort_keys=True) + "\n", encoding="utf-8")


def mechanics_of(mesh: str) -> Iterator[tuple[str, Mechanics]]:
    """Every reading of the diagram on a mesh, by its key."""
    numbers, exponents = FEW.get(mesh, (NUMBERS, EXPONENTS))
    for course in COURSES:
        for exponent in exponents:
            for number in numbers:
                one = replace(BASE, number=number, exponent=exponent, course=course, **MESHES[mesh])
                if number == 0.0:
                    one = replace(one, dissipation="none", course="constant")
                yield f"{course} {exponent:g} {number:g}", one


def folded(simulations: Simulations, mesh: str) -> None:
    """Which observations hold, for every reading on a mesh; those of one exponent at a time."""
    base = Config.preset("wang2019")
    todo = [(key, one) for key, one in mechanics_of(mesh) if key not in known().get(mesh, {})]
    for start in range(0, len(todo), len(NUMBERS)):
        part = todo[start : start + len(NUMBERS)]
        simulations.run([point_of(base, one, case, 0) for _, one in part for case in CASES])
        for key, one in part:
            found = {str(index): judged(simulations, base, Reading(one, index)) for index in JUDGED}
            keep(mesh, key, found)
            print(
                mesh,
                key,
                {name: sum(map(bool, told["holds"].values())) for name, told in found.items()},
                flush=True,
            )


def judged(simulations: Simulations, base: Config, reading: Reading) -> dict[str, Any]:
    """Which observations hold by a reading, and the index of every run."""
    rows = known_rows(simulations, base, reading, CASES, 0)
    holds = {row.id: row.passed for row in score(rows, str(reading)).rows if row.id in IDS}
    return {"holds": holds, "gi": {str(c): round(row.gi, 4) for c, row in rows.items() if row.is_complete}}


def exact() -> None:
    """Growth ratios at which the exact annulus loses stability at the end of growth."""
    for name, (stiffness, thickness) in ONSETS.items():
        for exponent in FINE:
            key = f"{name} {exponent:g}"
            if key in known().get("exact", {}):
                continue
            annulus = Annulus(
                stiffness_ratio=stiffness,
                cortical_thickness=thickness,
                out_of_plane=BASE.out_of_plane,
                out_of_plane_exponent=exponent,
                stretch=BASE.stretch,
            )
            found = critical_growth_ratio(annulus)
            keep("exact", key, found[0].value if found else None)
            print(key, known()["exact"][key], flush=True)


def main(folder: Path, meshes: list[str]) -> None:
    """Compute what is not known."""
    with Simulations(folder, 2) as simulations:
        for mesh in meshes or MESHES:
            folded(simulations, mesh)
    exact()


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
