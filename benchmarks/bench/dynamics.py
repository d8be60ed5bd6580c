"""Ratio (d): damped explicit dynamics at its stable time step, as open folding codes integrate growth.

Everything is counted in crossings of the slice by a shear wave, so that the density cancels. The loading
time and the time step of such a code are those of BrainGrowth (github.com/rousseau/BrainGrowth,
simulation.py: half length 1, mu = 1, K = 5, rho = 0.01, growth over time 1, dt = 0.05 sqrt(rho a^2 / K)).
"""

from __future__ import annotations

from functools import partial
from time import process_time

import numpy as np

from bench.body import CROSSINGS, Body, stable_step
from bench.figures import Figure, Figures
from bench.slices import configuration, folded, grown
from bench.timing import Sample, interleaved
from gyrify import History, measure_state, simulate
from gyrify.energy.term import FloatArray
from gyrify.metrics import measure

# Time step of BrainGrowth over h sqrt(rho / K).
STEP = 0.05
SAFETY = 0.95
# Part of the growth that is integrated for real, to see how far from quasi-static that loading is.
GROWN = 0.5


def dynamics(quick: bool) -> Figures:
    """Cost of a step, number of steps, and the total beside gyrify's own run."""
    history = folded(quick)
    problem, body = history.slice, Body.of(history.slice)
    picked = np.linspace(0, len(history) - 1, 5).astype(int)
    states = [(history.state_vector(int(i)), float(history.growth_times[i])) for i in picked]
    stable = [stable_step(problem, u, time, False) for u, time in states]
    touching = stable_step(problem, *states[-1], True)
    run = Sample(tuple(grown(configuration(quick))[1] for _ in range(1 if quick else 3)))
    step, contact = _costs(body, states[-1][0], 3 if quick else 9)
    steps_by_name = {
        "stable": body.duration * float(np.mean([1.0 / dt for dt in stable])) / SAFETY,
        "BrainGrowth's": body.duration
        / (STEP * problem.mean_cortical_edge / np.sqrt(problem.bulk_modulus.max())),
    }
    found = [
        Figure("loading time in crossings by a shear wave", CROSSINGS),
        Figure.of("one step, elastic", step),
        Figure.of("contact forces of the folded slice", contact),
        Figure("stable step, folded, over that at the start", stable[-1] / stable[0]),
        Figure("the same with contact", touching / stable[0]),
        Figure.of("gyrify: processor time", run),
    ]
    for name, number in steps_by_name.items():
        total = {"no contact": number * step.median, "contact": number * (step.median + contact.median)}
        found.append(Figure(f"{name} step: steps", round(number), is_extrapolated=True))
        for word, seconds in total.items():
            found.append(Figure(f"{name} step: total, {word}", seconds, "s", is_extrapolated=True))
        ratio = total["contact"] / run.median
        found.append(Figure(f"{name} step: over gyrify", ratio, "x", is_extrapolated=True))
    least = 0.9 * min(*stable, touching)
    return found + _lag(body, least, quick) + _folded(body, least, history, run)


def _folded(body: Body, dt: float, history: History, run: Sample) -> Figures:
    """The whole run explicitly, for real, at the smallest of the stable steps, beside gyrify's own."""
    number, begun = int(np.ceil(body.duration / dt)), process_time()
    u, kinetic = body.fold(number)
    seconds, mesh, config = process_time() - begun, history.mesh, history.config.metrics
    x = mesh.points + u
    radius, prominence, samples = config.closing_radius, config.gyrus_prominence, config.samples
    found = measure(x[mesh.contour], x[mesh.interface], radius, prominence, samples, mesh.period)
    own = measure_state(history)
    return [
        Figure("measured run: steps", number),
        Figure("measured run: processor time", seconds, "s"),
        Figure("measured run: over gyrify", seconds / run.median, "x"),
        Figure("measured run: kinetic over elastic energy at the end", kinetic),
        Figure("measured run: gyrification index (closing)", round(found.gi_closing, 4)),
        Figure("gyrify: gyrification index (closing)", round(own.gi_closing, 4)),
        Figure("measured run: gyri", found.n_gyri),
        Figure("gyrify: gyri", own.n_gyri),
    ]


def _costs(body: Body, u: FloatArray, repeats: int) -> tuple[Sample, Sample]:
    """Seconds of one elastic step and of the contact forces at a folded state."""
    moved, v = u.copy(), np.zeros_like(u)
    contact = body.problem.contact_energy(u)
    tasks = {
        "step": partial(body.advance, 1, 0.0, body.duration, moved, v),  # no time passes: the state stays
        "contact": partial(contact.evaluate, u, 1),
    }
    times = interleaved(tasks, repeats)
    return times["step"], times["contact"]


def _lag(body: Body, dt: float, quick: bool) -> Figures:
    """How far from quasi-static the loading is: the tissue alone, grown for real to half the time."""
    config = body.problem.config
    number = int(np.ceil(GROWN * body.duration / dt))
    u = np.zeros(body.problem.state_shape)
    v = np.zeros_like(u)
    elastic, kinetic = body.advance(number, GROWN * body.duration / number, 0.0, u, v)
    # the drag number counts by the duration, of which only a part passes
    half = {
        "growth.duration": GROWN * config.growth.duration,
        "dissipation.number": config.dissipation.number / GROWN,
        "contact.enabled": False,
        "stability.detect": False,
    }
    slow = simulate(configuration(quick, half)).state_vector(-1)
    return [
        Figure("steps taken for real, to half of the growth", number),
        Figure("kinetic over elastic energy there", kinetic / elastic),
        Figure("distance from gyrify's state there", float(np.abs(u - slow).max() / np.abs(slow).max())),
    ]
