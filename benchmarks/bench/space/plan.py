"""Constants measured on tetrahedra, their growth with the size, and what a million tetrahedra would take."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from bench.figures import Figure, Figures
from bench.isolated import isolated
from bench.slices import solvers
from bench.space.shell import Tangent, half_ellipsoid
from bench.space.surface import contact
from bench.timing import interleaved

# Edges of the half cubes: 4 608, 15 552, 36 864, 72 000, 124 416 and 158 184 tetrahedra; and a million.
SIZES, MILLION = (8, 12, 16, 20, 24, 26), 48
# Iterations of Newton's method that a run of 3-D growth is planned with.
ITERATIONS = 300
SUPERLU_UP_TO = 16
# Sizes that the exponents are fitted to, the largest: the smaller ones have not come to their powers yet.
FITTED = 3


def space(quick: bool) -> Figures:
    """Everything that docs/planning-3d.md quotes."""
    sizes = SIZES[:3] if quick else SIZES
    found = _assembly(quick)
    runs: dict[str, list[dict[str, Any]]] = {"multigrid": []}
    for n in sizes:
        for name in solvers():
            if name != "superlu" or n <= (12 if quick else SUPERLU_UP_TO):
                run = isolated("bench.space.factors:factorised", n, name)
                runs.setdefault(name, []).append(run)
        runs["multigrid"].append(isolated("bench.space.factors:iterated", n))
    for name, measured in runs.items():
        found += _measured(name, measured)
        found += _extrapolated(name, measured)
    found += contact(quick)
    return found + _whole(found)


def _assembly(quick: bool) -> Figures:
    """Energy, gradient, Hessian and fill of gyrify's energy on tetrahedra."""
    tangent = Tangent(half_ellipsoid(8 if quick else 20))
    n_cells, energy, u = tangent.energy.weight.size, tangent.energy, tangent.u
    tasks = {
        "energy, gradient, Hessian, fill": lambda: energy.evaluate(u, 2),
        "energy": lambda: energy.evaluate(u, 0),
    }
    times = interleaved(tasks, 2 if quick else 7)
    return [Figure(f"assembly: {n}, per cell", 1e9 * s.median / n_cells, "ns") for n, s in times.items()]


QUANTITIES = {
    "pardiso": ("analysis", "factorisation", "solve", "memory"),
    "superlu": ("analysis", "factorisation", "solve", "memory"),
    "multigrid": (
        "setup", "seconds, loose", "seconds, tight", "iterations, loose", "iterations, tight", "memory",
    ),
}  # fmt: skip


def unit(quantity: str) -> str:
    """Unit of a measured quantity."""
    return "MB" if quantity == "memory" else "" if quantity.startswith("iterations") else "s"


def _measured(name: str, runs: Sequence[dict[str, Any]]) -> Figures:
    found = []
    for run in runs:
        size = f"{name}, {run['cells']} cells"
        found.append(Figure(f"{size}: unknowns", run["unknowns"]))
        found += [Figure(f"{size}: {q}", run[q], unit(q)) for q in QUANTITIES[name]]
    return found


def fit(cells: Sequence[float], values: Sequence[float]) -> tuple[float, float]:
    """Exponent and factor of value = factor cells^exponent, by least squares of the logarithms."""
    exponent, constant = np.polyfit(np.log(cells), np.log(values), 1)
    return float(exponent), float(np.exp(constant))


def _extrapolated(name: str, runs: Sequence[dict[str, Any]]) -> Figures:
    """Exponents over the largest sizes, and values at a million cells from them."""
    larger = runs[-FITTED:]
    goal = 9 * MILLION**3
    found = []
    for quantity in QUANTITIES[name]:
        exponent, factor = fit([r["cells"] for r in larger], [max(r[quantity], 1e-9) for r in larger])
        found.append(Figure(f"{name}: exponent of {quantity}", exponent))
        at_a_million = factor * goal**exponent
        found.append(
            Figure(f"{name}, a million: {quantity}", at_a_million, unit(quantity), is_extrapolated=True)
        )
    return found


def _whole(found: Figures) -> Figures:
    """A run at a million cells, one thread, of so many iterations."""
    value = {figure.name: figure.value for figure in found}
    cells = 9 * MILLION**3
    assembly = cells * 1e-9 * value["assembly: energy, gradient, Hessian, fill, per cell"]
    # the outer surface of the half cube, five faces of which four are halved
    vertices = 3 * MILLION**2 + 2 * MILLION + 1
    largest = max(int(n.split()[1]) for n in value if n.startswith("contact,"))
    touching = [value[f"contact, {largest} vertices: {n}, per vertex"] for n in CONTACT]
    contact_seconds = vertices * 1e-6 * sum(touching)
    plan = [
        Figure("plan: cells", cells),
        Figure("plan: surface vertices", vertices),
        Figure("plan: Newton iterations assumed", ITERATIONS),
        Figure("plan: assembly of an iteration", assembly, "s", is_extrapolated=True),
        Figure("plan: contact of an iteration", contact_seconds, "s", is_extrapolated=True),
    ]
    linear = {
        "multigrid": ("setup", "seconds, loose"),
        **dict.fromkeys(solvers(), ("factorisation", "solve")),
    }
    for name, parts in linear.items():
        solve = sum(value[f"{name}, a million: {part}"] for part in parts)
        hours = ITERATIONS * (solve + assembly + contact_seconds) / 3600.0
        plan.append(Figure(f"plan: run with {name}, one thread", hours, "h", is_extrapolated=True))
    return plan


CONTACT = ("energy, gradient, Hessian", "collision-free step")
