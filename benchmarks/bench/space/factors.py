"""One stiffness of a tetrahedral shell, factorised, or solved by conjugate gradients with multigrid."""

from __future__ import annotations

from time import process_time
from typing import Any

import numpy as np
import scipy.sparse as sp

from bench.isolated import fresh_peak, peak_memory
from bench.space.shell import Tangent, half_ellipsoid
from gyrify.solve.linear import linear_solver

# Relative residual at which an iteration stops: what Newton's method needs, and what a factorisation gives.
LOOSE, TIGHT = 1e-4, 1e-8
# Quick factorisations are repeated and the least time counts.
REPEATS, REPEATED_BELOW = 3, 22


def factorised(n: int, name: str) -> dict[str, Any]:
    """Seconds and memory of analysis, factorisation and solve, in a process of its own."""
    tangent = Tangent(half_ellipsoid(n))
    upper = tangent.upper()
    right = np.random.default_rng(0).normal(size=upper.shape[0])
    base = fresh_peak()
    solver = linear_solver(name)  # type: ignore[arg-type]
    factorise = getattr(solver, "factorise_definite", solver.factorise)  # at rest it is positive definite
    pattern = upper.indptr.astype(np.int64), upper.indices.astype(np.int64)
    seconds: dict[str, list[float]] = {"analysis": [], "factorisation": [], "solve": []}
    for _ in range(REPEATS if n < REPEATED_BELOW else 1):
        begun = process_time()
        solver.analyse(*pattern)
        factorise(upper.data.copy())  # a solver may put its analysis off until here
        again = process_time()
        factor = factorise(upper.data.copy())
        done = process_time()
        solution = factor.solve(right)
        spent = (max(again - begun - (done - again), 0.0), done - again, process_time() - done)
        for values, value in zip(seconds.values(), spent, strict=True):
            values.append(value)
    whole = upper + sp.triu(upper, 1).T
    return {
        **_size(tangent, upper),
        **{name: min(values) for name, values in seconds.items()},
        "memory": peak_memory() - base,
        "residual": float(np.linalg.norm(whole @ solution - right) / np.linalg.norm(right)),
    }


def iterated(n: int) -> dict[str, Any]:
    """Seconds, iterations and memory of conjugate gradients with smoothed aggregation of rigid modes."""
    tangent = Tangent(half_ellipsoid(n))
    upper = tangent.upper()
    whole = (upper + sp.triu(upper, 1).T).tobsr(blocksize=(3, 3))
    right = np.random.default_rng(0).normal(size=upper.shape[0])
    base = fresh_peak()
    setup = np.inf
    for _ in range(REPEATS):
        begun = process_time()
        hierarchy = _hierarchy(whole, tangent)
        hierarchy.solve(right, maxiter=1)  # the first cycle factorises the coarsest level
        setup = min(setup, process_time() - begun)
    found = {**_size(tangent, upper), "setup": setup}
    for word, tolerance in (("loose", LOOSE), ("tight", TIGHT)):
        spent = []
        for _ in range(REPEATS):
            residuals: list[float] = []
            begun = process_time()
            hierarchy.solve(right, tol=tolerance, accel="cg", maxiter=500, residuals=residuals)
            spent.append(process_time() - begun)
        found[f"seconds, {word}"] = min(spent)
        found[f"iterations, {word}"] = len(residuals) - 1
        found[f"reached, {word}"] = residuals[-1] / residuals[0]
    complexity = hierarchy.operator_complexity()
    return {**found, "memory": peak_memory() - base, "complexity": float(complexity)}


def _hierarchy(matrix: sp.bsr_matrix, tangent: Tangent) -> Any:
    """Smoothed aggregation with rigid modes, as PyAMG's documentation advises for elasticity."""
    import pyamg

    smooth = ("jacobi", {"omega": 4.0 / 3.0, "filter_entries": False, "weighting": "local"})
    return pyamg.smoothed_aggregation_solver(
        matrix,
        B=tangent.rigid_modes(),
        symmetry="symmetric",
        strength=("symmetric", {"theta": 0.0}),
        smooth=smooth,
        improve_candidates=None,
        max_coarse=300,
        coarse_solver="splu",
    )


def _size(tangent: Tangent, upper: sp.csr_matrix) -> dict[str, Any]:
    cells = tangent.energy.kinematics.cells.shape[0]
    return {"cells": cells, "unknowns": upper.shape[0], "entries": upper.nnz}
