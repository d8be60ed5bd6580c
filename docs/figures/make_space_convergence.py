"""Three meshes of two elements for one body in space: the table of docs/space.md, in about ten minutes."""

from __future__ import annotations

import sys
from pathlib import Path

from gyrify import Config, converge
from gyrify.run.validity.expected import expected_onset

PATCH = {
    "geometry.shape": "patch",
    "geometry.length": 15.0,
    "geometry.width": 4.0,
    "geometry.depth": 20.0,
    "geometry.cortical_thickness": 2.0,
    "mesh.edge_length": 2.0,
    "mesh.n_layers": 5,
    "mesh.n_cortex_layers": 2,
    "mesh.node_jitter": 0.0,
    "growth.law": "area",
    "growth.ratio": 1e4,
    "material.stiffness_ratio": 3.0,
    "dissipation.kind": "none",
    "stability.follow_branch": True,
    "solver.increments": 8,
}
SHOWN = ("onset_growth_time", "gi_area_closing", "gi_area_hull", "sulcal_depth_mm_max", "elastic_energy_mJ")


def main(folder: Path) -> None:
    """Print a row for each element, growth time and quantity."""
    print(expected_onset(Config().with_overrides(PATCH)))
    for element in ("mean_dilatation", "linear"):
        for duration in (160.0, 220.0):
            config = Config().with_overrides({**PATCH, "mesh.element": element, "growth.duration": duration})
            study = converge(config, folder / f"{element}-{duration:.0f}", of="mesh")
            for key in SHOWN:
                found = study.family("mesh").verdicts[key]
                print(element, duration, key, found.values, found.order, found.limit, found.sentence)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "convergence/space"))
