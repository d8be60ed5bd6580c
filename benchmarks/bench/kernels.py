"""The parts of an iteration alone: assembly, contact, growth; and the search for a threshold."""

from __future__ import annotations

from bench.figures import Figure, Figures
from bench.slices import configuration, folded_state
from bench.timing import Sample, interleaved
from gyrify import critical_growth


def kernels(quick: bool) -> Figures:
    """Assembly and contact at the folded state of the standard run."""
    problem, u, time = folded_state(quick)
    energy, contact = problem.elastic_energy(problem.kinematics(time)), problem.contact_energy(u)
    step = 1e-3 * u
    tasks = {
        "growth of all cells": lambda: problem.kinematics(time),
        "tissue: energy": lambda: energy.evaluate(u, 0),
        "tissue: energy, gradient": lambda: energy.evaluate(u, 1),
        "tissue: energy, gradient, Hessian, fill": lambda: energy.evaluate(u, 2),
        "tissue: the same, projected": lambda: energy.evaluate(u, 2, True),
        "tissue: largest step": lambda: energy.max_step(u, step),
        "contact: energy": lambda: contact.evaluate(u, 0),
        "contact: energy, gradient": lambda: contact.evaluate(u, 1),
        "contact: energy, gradient, Hessian": lambda: contact.evaluate(u, 2),
        "contact: collision-free step": lambda: contact.max_step(u, step),
    }
    times = interleaved(tasks, 3 if quick else 15)
    found = [Figure.of(name, sample) for name, sample in times.items()]
    whole = "tissue: energy, gradient, Hessian, fill"
    per_cell = times[whole].median / problem.mesh.n_cells * 1e9
    return [*found, Figure("tissue: all that, per cell", per_cell, "ns")]


def threshold(quick: bool) -> Figures:
    """The critical growth ratio of the standard slice."""
    answers = [critical_growth(configuration(quick)) for _ in range(1 if quick else 3)]
    answer = answers[-1]
    found = [
        Figure.of("critical growth ratio: time", Sample(tuple(each.wall_s for each in answers))),
        Figure("critical growth ratio: evaluations", answer.evaluations),
    ]
    if answer.critical_value is not None:
        found.append(Figure("critical growth ratio", round(answer.critical_value, 6)))
    return found
