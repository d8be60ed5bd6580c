"""The standard run: seconds of solve, iterations, where the time goes; either linear solver."""

from __future__ import annotations

from typing import Any

from bench.figures import Figure, Figures
from bench.slices import configuration, folded, grown, solvers
from bench.split import clocked
from bench.timing import Sample
from gyrify import History, measure_state, simulate


def standard(quick: bool) -> Figures:
    """Whole standard runs in memory, both solvers in turns."""
    folded(quick)  # compiles
    names, last = solvers(), {}
    wall: dict[str, list[float]] = {name: [] for name in names}
    processor: dict[str, list[float]] = {name: [] for name in names}
    for _ in range(2 if quick else 5):
        for name in names:
            last[name], seconds = grown(configuration(quick, {"solver.linear_solver": name}))
            wall[name].append(last[name].wall_s)
            processor[name].append(seconds)
    found: Figures = []
    for name in names:
        found.append(Figure.of(f"{name}: solve", Sample(tuple(wall[name]))))
        found.append(Figure.of(f"{name}: processor time", Sample(tuple(processor[name]))))
        found += _work(name, last[name])
        found += _split(name, quick)
    return found


def _work(name: str, history: History) -> Figures:
    stats = history.stats
    return [
        Figure(f"{name}: Newton iterations", stats.newton_iterations),
        Figure(f"{name}: factorisations", stats.factorizations),
        Figure(f"{name}: symbolic analyses", stats.analyses),
        Figure(f"{name}: rejected increments", stats.rejected),
        Figure(f"{name}: gyrification index (closing)", round(measure_state(history).gi_closing, 6)),
    ]


def _split(name: str, quick: bool) -> Figures:
    """Share of each part in one more run, slowed a little by the clocks."""
    with clocked() as clock:
        whole = simulate(configuration(quick, {"solver.linear_solver": name})).wall_s
    parts = {part: spent for part, spent in clock.seconds.items() if part != "journal"}
    parts["everything else"] = whole - sum(parts.values())
    ordered = sorted(parts.items(), key=lambda item: -item[1])
    return [Figure(f"{name}: share of {part}", 100.0 * spent / whole, "%") for part, spent in ordered]


def run_in_memory(overrides: dict[str, Any], quick: bool) -> dict[str, Any]:
    """One run with its statistics, for a process of its own."""
    history = simulate(configuration(quick, overrides))
    return {
        "seconds": history.wall_s,
        "iterations": history.stats.newton_iterations,
        "factorisations": history.stats.factorizations,
        "analyses": history.stats.analyses,
        "cells": history.mesh.n_cells,
        "growth": float(history.fractions[-1]),
        "increments": len(history) - 1,
        "gi": measure_state(history).gi_closing,
    }
