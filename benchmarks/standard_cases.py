"""Folds the cases that the documentation quotes and prints their metrics as a Markdown table.

Usage: python benchmarks/standard_cases.py [--seeds N] [--workers N]
"""

from __future__ import annotations

import argparse
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import numpy as np

from gyrify import Config, measure_state, simulate

CASES: dict[str, dict[str, Any]] = {
    "reference-slice": {},
    "stiffness ratio 1/1.36": {"material.stiffness_ratio": "1/1.36"},
    "drag number 0.13": {"dissipation.number": 0.13},
    "drag number 0.13, stiffness ratio 1/1.36": {
        "dissipation.number": 0.13,
        "material.stiffness_ratio": "1/1.36",
    },
    "drag number 0.13, energy per reference volume": {
        "dissipation.number": 0.13,
        "growth.energy_per": "reference",
    },
    "no contact": {"contact.enabled": False},
    "growth ratio 1": {"growth.ratio": 1.0},
}


def fold(case: tuple[str, int]) -> tuple[float, float, int, float, bool, float, int, float]:
    """Metrics of one case and seed, with the work it took."""
    name, seed = case
    config = Config.preset("reference-slice").with_overrides({**CASES[name], "seed": seed})
    history = simulate(config)
    found = measure_state(history)
    return (
        found.gi_closing,
        found.gi_hull,
        found.n_gyri,
        found.min_gap,
        found.self_intersecting,
        found.sulcal_depth_max,
        history.stats.newton_iterations,
        history.wall_s,
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--workers", type=int, default=1)
    options = parser.parse_args()
    todo = [(name, seed) for name in CASES for seed in range(options.seeds)]
    with ProcessPoolExecutor(options.workers) as pool:
        results = dict(zip(todo, pool.map(fold, todo), strict=True))
    print(
        "| case | GI closing | GI hull | gyri | smallest gap / mm | crosses itself | deepest sulcus / mm |",
        end="",
    )
    print(" iterations | solve / s |\n|---|---|---|---|---|---|---|---|---|")
    for name in CASES:
        rows = np.array([results[name, seed] for seed in range(options.seeds)], dtype=float)
        mean, spread = rows.mean(axis=0), rows.std(axis=0)
        gyri = "–".join(str(int(n)) for n in sorted({rows[:, 2].min(), rows[:, 2].max()}))
        print(
            f"| {name} | {mean[0]:.3f} ± {spread[0]:.3f} | {mean[1]:.3f} ± {spread[1]:.3f} | {gyri} "
            f"| {rows[:, 3].min():.3f} | {int(rows[:, 4].sum())} of {len(rows)} | {mean[5]:.2f} "
            f"| {mean[6]:.0f} | {mean[7]:.1f} |",
        )


if __name__ == "__main__":
    main()
