"""Ratio (b): energy, gradient, Hessian and sparse fill beside scikit-fem and FElupe, with equal numbers."""

from __future__ import annotations

from bench.figures import Figure, Figures
from bench.peers.cells import Assembler, GrownCells, disagreement
from bench.slices import configuration, folded_state
from bench.timing import Sample, interleaved
from gyrify.energy.term import FloatArray
from gyrify.model.slice import Slice

# Relative difference above which a comparison is refused.
AGREEMENT = 1e-10


def assembly(quick: bool) -> Figures:
    """The folded standard slice, and a mesh four times as fine; every library in its two ways."""
    problem, u, time = folded_state(quick)
    found = _compared(problem, u, time, repeats=3 if quick else 15)
    fine = Slice(configuration(quick, {"mesh.refine": 1}))
    return found + _compared(fine, 1e-3 * fine.mesh.points, time, repeats=3 if quick else 9)


def assemblers(cells: GrownCells) -> dict[str, Assembler]:
    """Every library and way, by name."""
    from bench.peers import felupe, scikit_fem

    return {
        "scikit-fem, vector forms": scikit_fem.VectorForms(cells),
        "scikit-fem, scalar blocks": scikit_fem.ScalarBlocks(cells),
        "FElupe, its own solid": felupe.PlaneStrain(cells),
        "FElupe, solid of the plane": felupe.InPlane(cells),
    }


def _compared(problem: Slice, u: FloatArray, time: float, repeats: int) -> Figures:
    energy, cells = problem.elastic_energy(problem.kinematics(time)), GrownCells.of(problem, time)
    others, size = assemblers(cells), problem.mesh.n_cells
    found = []
    for name, other in others.items():
        worst = disagreement(energy.evaluate(u, 2), other.all(u))
        if not worst <= AGREEMENT:
            raise RuntimeError(f"{name} disagrees with gyrify by {worst:.1e}: nothing to compare")
        found.append(Figure(f"{size} cells: {name}: disagreement", float(f"{worst:.1e}")))
    tasks = {name: (lambda other=other: other.all(u)) for name, other in others.items()}
    times = interleaved({"gyrify": lambda: energy.evaluate(u, 2), **tasks}, repeats)
    found += [Figure.of(f"{size} cells: {name}", sample) for name, sample in times.items()]
    for library in ("scikit-fem", "FElupe"):
        fastest = min((n for n in others if n.startswith(library)), key=lambda n: times[n].median)
        ratio: Sample = times[fastest].over(times["gyrify"])
        found.append(Figure.of(f"{size} cells: {library} at its fastest over gyrify", ratio, "x"))
    return found
