"""Ratio (a): an iteration of Newton's method against factorisation and solve of the same matrices alone."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import wraps
from time import process_time
from typing import Any

import numpy as np

from bench.figures import Figure, Figures
from bench.slices import configuration, grown, solvers
from bench.timing import Sample
from gyrify import simulate
from gyrify.solve.linear import LinearSolver, linear_solver

# Every so many factorisations of a run one matrix is kept.
EVERY = 8
METHODS = ("factorise", "factorise_definite")


@dataclass
class Kept:
    """Matrices of a run by pattern.

    Attributes
    ----------
    patterns : list of (indptr, indices)
        In the order they were analysed.
    matrices : list of (int, array, str)
        Number of the pattern, values on it, and the method that factorised it.
    factorised : int
        How many were factorised.
    is_inside : bool
        Whether one is being factorised.
    """

    patterns: list[tuple[np.ndarray, np.ndarray]] = field(default_factory=list)
    matrices: list[tuple[int, np.ndarray, str]] = field(default_factory=list)
    factorised: int = 0
    is_inside: bool = False


@contextmanager
def keeping(name: str) -> Iterator[Kept]:
    """Keep some of the matrices that a linear solver factorises, and how it was asked to."""
    owner, kept = type(linear_solver(name)), Kept()  # type: ignore[arg-type]
    own = {m: vars(owner)[m] for m in ("analyse", *METHODS) if m in vars(owner)}

    @wraps(own["analyse"])
    def analysing(self: LinearSolver, indptr: np.ndarray, indices: np.ndarray, *more: Any) -> Any:
        kept.patterns.append((indptr.copy(), indices.copy()))
        self.kept_pattern = len(kept.patterns) - 1  # type: ignore[attr-defined]
        return own["analyse"](self, indptr, indices, *more)

    owner.analyse = analysing
    for method in METHODS:
        if method in own:
            setattr(owner, method, _noting(kept, method, own[method]))
    try:
        yield kept
    finally:
        for method, function in own.items():
            setattr(owner, method, function)


def _noting(kept: Kept, method: str, factorise: Callable[..., Any]) -> Callable[..., Any]:
    @wraps(factorise)
    def factorising(self: LinearSolver, data: np.ndarray, *more: Any) -> Any:
        if kept.is_inside:  # one method may be made of another
            return factorise(self, data, *more)
        if kept.factorised % EVERY == 0:
            kept.matrices.append((self.kept_pattern, data.copy(), method))  # type: ignore[attr-defined]
        kept.factorised += 1
        kept.is_inside = True
        try:
            return factorise(self, data, *more)
        finally:
            kept.is_inside = False

    return factorising


def iteration(quick: bool) -> Figures:
    """Runs and bare factorisations of their matrices in turns, for each linear solver."""
    found: Figures = []
    for name in solvers():
        config = configuration(quick, {"solver.linear_solver": name})
        with keeping(name) as kept:
            simulate(config)
        whole, bare = [], []
        for _ in range(2 if quick else 5):
            history, seconds = grown(config)
            whole.append(seconds / history.stats.newton_iterations)
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
    opened: dict[tuple[int, str], LinearSolver] = {}
    right = np.random.default_rng(0).normal(size=kept.patterns[0][0].size - 1)
    for number, data, method in kept.matrices:
        if (number, method) not in opened:
            opened[number, method] = linear_solver(name)  # type: ignore[arg-type]
            opened[number, method].analyse(*kept.patterns[number])
            _solved(opened[number, method], method, data, right)
    begun = process_time()
    for number, data, method in kept.matrices:
        _solved(opened[number, method], method, data, right)
    return (process_time() - begun) / len(kept.matrices)


def _solved(solver: LinearSolver, method: str, data: np.ndarray, right: np.ndarray) -> None:
    factor = getattr(solver, method)(data)
    if factor is not None:  # else it was found indefinite
        factor.solve(right)
