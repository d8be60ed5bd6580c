"""One linear system of a growing body, at rest and buckling, by a factor and by conjugate gradients."""

from __future__ import annotations

from collections.abc import Callable
from itertools import takewhile

import numpy as np

from bench.figures import Figure, Figures
from bench.slices import solvers as direct_solvers
from bench.timing import interleaved
from gyrify.config import Config
from gyrify.model.rigid import rigid_modes
from gyrify.model.slice import Slice
from gyrify.solve.iterative.blocks import BlockMatrix, BlockPattern, Nodes
from gyrify.solve.iterative.conjugate import Ended, conjugate_gradients
from gyrify.solve.iterative.preconditioners import Preconditioner, block_diagonal, multigrid
from gyrify.solve.linear import linear_solver
from gyrify.solve.problem import State
from gyrify.solve.quasistatic import grow
from gyrify.solve.shift import shifted_factor
from gyrify.solve.system import System

# Edges on the outer surface [mm].
EDGES = (4.0, 2.0)
# Growth at which the body has begun to buckle, and its stiffness is indefinite.
BUCKLING = 0.35
# Relative residual: what a step of Newton's method asks for at most.
RESIDUAL = 1e-4
BODY = {
    "geometry.shape": "ellipsoid",
    "geometry.semi_axes": (36.0, 30.0, 24.0),
    "geometry.hole_fraction": 0.0,
    "geometry.cortical_thickness": 1.5,
    "mesh.n_layers": 8,
    "mesh.n_cortex_layers": 2,
    "mesh.element": "mean_dilatation",
    "mesh.node_jitter": 0.02,
    "growth.law": "area",
    "growth.profile": "sigmoid",
    "growth.rate": 0.003658,
    "growth.ratio": 1e4,
    "material.stiffness_ratio": 0.857,
    "dissipation.number": 0.2,
    "solver.increments": 40,
    "solver.linear_solver": "cg",
    "stability.detect": False,
}
Preconditioned = Callable[[BlockMatrix], Preconditioner]
PRECONDITIONERS: dict[str, Preconditioned] = {"diagonal": block_diagonal, "multigrid": multigrid}


def solvers(quick: bool) -> Figures:
    """Factorisation and solve, and conjugate gradients with each preconditioner, in turn on one matrix."""
    found: Figures = []
    for edge in (6.0,) if quick else EDGES:
        body = Slice(Config().with_overrides({**BODY, "mesh.edge_length": edge}))
        found += compared(body, body.reference_state(), "at rest", quick)
        states = grow(body, body.stepping, body.reference_state())
        end = BUCKLING * body.stepping.end
        *_, last = takewhile(lambda state, end=end: state.position <= end, states)  # type: ignore[misc]
        found += compared(body, last, "buckling", quick)
    return found


def compared(body: Slice, state: State, word: str, quick: bool) -> Figures:
    """Seconds and iterations of the first system of the increment after a state."""
    nodes = Nodes.of(body._moving, rigid_modes(body.mesh.points))
    pattern = body.pattern.pattern if body.patches is None else body.patches.pattern
    direct = linear_solver(direct_solvers()[0])  # type: ignore[arg-type]
    system = System(body._moving, state.u.size, 3, pattern, direct, state.couplings)
    end = body.stepping.end
    total = body.energy((state.position + state.span) / end, state, state.position / end)
    data = system.assemble(total.evaluate(state.u, project_psd=False), lambda: body.candidates(state.u))
    right, mass = system.gather(total.slope(state.u)[1]), body.shift_mass
    assert mass is not None
    if direct.factorise_definite(data) is None:
        tau = shifted_factor(system, data, mass, growth=4.0).tau
        data[system.pattern.indptr[:-1]] += tau * mass
    matrix = BlockPattern(system.pattern.indptr, system.pattern.cols, nodes).matrix(data)
    full = nodes.expand(right)

    def iterated(make: Preconditioned) -> Ended:
        return conjugate_gradients(matrix.__matmul__, full, make(matrix), RESIDUAL, 5000)

    def factorised() -> np.ndarray:
        factor = direct.factorise_definite(data)
        assert factor is not None
        return factor.solve(right)

    tasks: dict[str, Callable[[], object]] = {direct.name: factorised}
    for name, make in PRECONDITIONERS.items():
        tasks[f"cg, {name}"] = lambda make=make: iterated(make)  # type: ignore[misc]
    times = interleaved(tasks, 1 if quick else 3)
    subject = f"{body.mesh.n_cells} cells, {word}"
    found = [Figure(f"{subject}: unknowns", right.size)]
    found += [Figure(f"{subject}: {name}", sample.median, "s") for name, sample in times.items()]
    for name, make in PRECONDITIONERS.items():
        ended = iterated(make)
        assert ended.negative is None
        found.append(Figure(f"{subject}: iterations, {name}", ended.iterations))
    ratio = times[direct.name].over(times["cg, diagonal"])
    found.append(
        Figure(f"{subject}: {direct.name} over cg, diagonal", ratio.median, "x", ratio.low, ratio.high)
    )
    return found
