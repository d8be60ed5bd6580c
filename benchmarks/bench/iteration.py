"""Ratio (a): an iteration of Newton's method against factorisation and solve of the same matrices alone."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import wraps
from time import perf_counter
from typing import Any

import numpy as np

from bench.figures import Figure, Figures
from bench.slices import configuration, solvers
from bench.timing import Sample
from gyrify import simulate
from gyrify.solve.linear import LinearSolver, linear_solver

# Every so many factorisations of a run one matrix is kept.
EVERY = 8


@dataclass
class Kept:
    """Matrices of a run by pattern.

    Attributes
    ----------
    patterns : list of (indptr, indices)
        In the order they were analysed.
    matrices : list of (int, array)
        Number of the pattern, and values on it.
    """

    patterns: list[tuple[np.ndarray, np.ndarray]] = field(default_factory=list)
    matrices: list[tuple[int, np.ndarray]] = field(default_factory=list)
    factorised: int = 0


@contextmanager
def keeping(name: str) -> Iterator[Kept]:
    """Keep some of the matrices that a linear solver factorises."""
    owner, kept = type(linear_solver(name)), Kept()
    analyse, factorise = owner.analyse, owner.factorise

    @wraps(analyse)
    def analysing(self: LinearSolver, indptr: np.ndarray, indices: np.ndarray, *more: Any) -> Any:
        kept.patterns.append((indptr.copy(), indices.copy()))
        self.kept_pattern = len(kept.patterns) - 1  # type: ignore[attr-defined]
        return analyse(self, indptr, indices, *more)

    @wraps(factorise)
    def factorising(self: LinearSolver, data: np.ndarray, *more: Any) -> Any:
        if kept.factorised % EVERY == 0:
            kept.matrices.append((self.kept_pattern, data.copy()))  # type: ignore[attr-defined]
        kept.factorised += 1
        return factorise(self, data, *more)

    owner.analyse, owner.factorise = analysing, factorising
    try:
        yield kept
    finally:
        owner.analyse, owner.factorise = analyse, factorise


def iteration(quick: bool) -> Figures:
    """Runs and bare factorisations of their matrices in turns, for each linear solver."""
    found: Figures = []
    for name in solvers():
        config = configuration(quick, {"solver.linear_solver": name})
        with keeping(name) as kept:
            simulate(config)
        whole, bare = [], []
        for _ in range(2 if quick else 5):
            history = simulate(config)
            whole.append(history.wall_s / history.stats.newton_iterations)
            bare.append(_bare(name, kept))
        run, alone = Sample(tuple(whole)), Sample(tuple(bare))
        found += [
            Figure.of(f"{name}: iteration", run),
            Figure.of(f"{name}: factorisation and solve alone", alone),
            Figure.of(f"{name}: ratio", run.over(alone), "x"),
        ]
    return found


def _bare(name: str, kept: Kept) -> float:
    """Mean seconds of factorisation and one solve; the analyses are done beforehand."""
    opened: dict[int, LinearSolver] = {}
    for number in {number for number, _ in kept.matrices}:
        opened[number] = linear_solver(name)
        opened[number].analyse(*kept.patterns[number])
    right = np.random.default_rng(0).normal(size=kept.patterns[0][0].size - 1)
    opened[kept.matrices[0][0]].factorise(kept.matrices[0][1]).solve(right)
    begun = perf_counter()
    for number, data in kept.matrices:
        opened[number].factorise(data).solve(right)
    return (perf_counter() - begun) / len(kept.matrices)
