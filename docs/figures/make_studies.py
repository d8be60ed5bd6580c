"""Runs the two studies that docs/studies.md shows, and draws their pictures.

Usage: python docs/figures/make_studies.py [FOLDER] [--workers N]

Runs that FOLDER holds from an earlier call are not run again.
"""

from __future__ import annotations

import argparse
import shutil
from pathlib import Path
from typing import Any

from gyrify import Study, run_study
from gyrify.report.study_pictures import write_study_pictures

HERE = Path(__file__).parent
BASE: dict[str, Any] = {
    "preset": "reference-slice",
    "mesh": {"n_around": 120, "n_layers": 9, "n_cortex_layers": 3},
    "solver": {"increments": 40},
}
GROWTH = {"key": "growth.ratio", "range": [1.0, 5.0], "n": 6}
STIFFNESS = {
    "key": "material.stiffness_ratio",
    "values": ["1/3", "1/2", "1/1.36", 1.0, 1.54, 3.0],
}
DRAG = {"key": "dissipation.number", "range": [0.1, 10.0], "scale": "log", "n": 5}
TWO = {"key": "material.stiffness_ratio", "values": ["1/1.36", 1.0]}
SEEDS = {"key": "seed", "values": [0, 1, 2]}
STUDIES = {
    "phase-diagram": ({**BASE, "dissipation": {"number": 0.3}}, [GROWTH, STIFFNESS]),
    "dissipation": (BASE, [DRAG, TWO, SEEDS]),
}


def main() -> None:
    """Run and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, default=Path("studies/docs"))
    parser.add_argument("--workers", type=int, default=2)
    options = parser.parse_args()
    for name, (base, parameters) in STUDIES.items():
        study = Study.from_mapping({"base": base, "design": {"kind": "grid", "parameter": parameters}})
        run_study(study, options.folder / name, workers=options.workers)
        write_study_pictures(options.folder / name)
        shutil.copy(options.folder / name / f"{name}.png", HERE / f"studies-{name}.png")


if __name__ == "__main__":
    main()
