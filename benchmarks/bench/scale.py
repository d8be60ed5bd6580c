"""Larger meshes and other elements: solve, memory, and how the time of an iteration grows with the cells."""

from __future__ import annotations

from typing import Any

import numpy as np

from bench.figures import Figure, Figures
from bench.isolated import isolated
from bench.slices import solvers

# Where a run is only looked at: seconds of wall time after which it stops [s].
LOOK = 60.0


def fine(quick: bool) -> Figures:
    """29 376 cells to full growth, 117 504 for a minute, and the exponent between 7 344 and there."""
    return _sizes(quick, to_the_end=2)


def finest(quick: bool) -> Figures:
    """29 376 and 117 504 cells to full growth."""
    return _sizes(quick, to_the_end=3)


def quadratic(quick: bool) -> Figures:
    """The standard mesh with quadratic triangles, and with averaged volume ratios."""
    found: Figures = []
    for element, resistance in (("quadratic", 0.1), ("mean_dilatation", 0.0)):
        chosen = {"mesh.element": element, "mesh.inversion_resistance": resistance}
        run = isolated("bench.standard:run_in_memory", chosen, quick)
        found += _of_run(element, run)
    return found


def soft(quick: bool) -> Figures:
    """The hard case: cortex half as stiff as the white matter, a tenth of the drag."""
    overrides = {"material.stiffness_ratio": 0.5, "dissipation.number": 0.13}
    return _of_run("soft cortex, low drag", isolated("bench.standard:run_in_memory", overrides, quick))


def _sizes(quick: bool, to_the_end: int) -> Figures:
    found: Figures = []
    cells, pace = [], []
    for refine in range(3):
        overrides: dict[str, Any] = {"mesh.refine": refine, "solver.linear_solver": solvers()[0]}
        if refine >= to_the_end or (quick and refine > 0):
            overrides["limits.wall_time"] = 5.0 if quick else LOOK
        run = isolated("bench.standard:run_in_memory", overrides, quick)
        found += _of_run(f"{run['cells']} cells", run)
        cells.append(run["cells"])
        pace.append(run["seconds"] / run["iterations"])
    slope = np.polyfit(np.log(cells), np.log(pace), 1)[0]
    found.append(
        Figure(f"exponent of the time of an iteration, {cells[0]} to {cells[-1]} cells", float(slope))
    )
    return found


def _of_run(name: str, run: dict[str, Any]) -> Figures:
    return [
        Figure(f"{name}: solve", run["seconds"], "s"),
        Figure(f"{name}: growth reached", 100.0 * run["growth"], "%"),
        Figure(f"{name}: increments", run["increments"]),
        Figure(f"{name}: Newton iterations", run["iterations"]),
        Figure(f"{name}: factorisations", run["factorisations"]),
        Figure(f"{name}: symbolic analyses", run["analyses"]),
        Figure(f"{name}: time of an iteration", 1e3 * run["seconds"] / run["iterations"], "ms"),
        Figure(f"{name}: peak memory", run["peak_memory"], "MB"),
        Figure(f"{name}: gyrification index (closing)", round(run["gi"], 4)),
    ]
