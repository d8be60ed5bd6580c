"""Ratio (d): damped explicit dynamics at its stable time step, as open folding codes integrate growth.

Everything is counted in crossings of the slice by a shear wave, so that the density cancels. The loading
time and the time step of such a code are those of BrainGrowth (github.com/rousseau/BrainGrowth,
simulation.py: half length 1, mu = 1, K = 5, rho = 0.01, growth over time 1, dt = 0.05 sqrt(rho a^2 / K)).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla

from bench.figures import Figure, Figures
from bench.peers.explicit import steps
from bench.slices import configuration, folded
from bench.timing import Sample, interleaved
from gyrify import simulate
from gyrify.energy.term import FloatArray
from gyrify.model import Slice

# Loading time of BrainGrowth in crossings of the half length by a shear wave; its step over h sqrt(rho / K).
CROSSINGS, STEP = 10.0, 0.05
SAFETY = 0.95
# Part of the growth that is integrated for real, to see how far from quasi-static that loading is.
GROWN = 0.5


@dataclass(frozen=True, eq=False)
class Body:
    """A slice as a damped dynamic body of density 1 [mass/mm^2 per unit thickness].

    Attributes
    ----------
    problem : Slice
        The slice.
    duration : float
        Loading time [time of a unit density].
    damping : float
        Drag over mass [1/time], such that the drag number is that of the slice.
    """

    problem: Slice
    duration: float
    damping: float

    @staticmethod
    def of(problem: Slice) -> Body:
        """Body that is loaded within `CROSSINGS`."""
        config = problem.config
        crossing = max(config.geometry.semi_axes) / np.sqrt(problem.mu.max())
        duration = CROSSINGS * crossing
        drag = config.dissipation.number * config.material.young_modulus / config.geometry.drag_length**2
        return Body(problem, duration, drag * duration)

    def advance(
        self, number: int, dt: float, start: float, u: FloatArray, v: FloatArray
    ) -> tuple[float, float]:
        """Take steps from a time; elastic and kinetic energy at their end."""
        problem, cells = self.problem, self.problem.simplices
        free = np.zeros(u.shape, dtype=bool)
        free.ravel()[problem.free] = True
        rate = problem.rate * problem.config.growth.duration
        return steps(
            number, start, dt, self.duration, u, v, cells.cells, cells.gradients, cells.volumes, rate,
            problem.mu, problem.kappa, problem.lumped_area, free, self.damping,
        )  # fmt: skip


def stable_step(problem: Slice, u: FloatArray, time: float, with_contact: bool) -> float:
    """2 / omega_max of M^-1 K for unit density."""
    terms = [problem.elastic_energy(problem.kinematics(time)).evaluate(u, 2)]
    terms += [problem.contact_energy(u).evaluate(u, 2)] if with_contact else []
    size = u.size
    K = sp.csr_matrix((size, size))
    for term in terms:
        pattern = term.hessian.pattern
        upper = sp.csr_matrix((term.hessian.values, (pattern.rows, pattern.cols)), shape=(size, size))
        K = K + upper + sp.triu(upper, 1).T
    scale = sp.diags_array(1.0 / np.sqrt(problem.free_mass))
    free = K[problem.free][:, problem.free]
    start = np.random.default_rng(0).normal(size=problem.free.size)
    largest = sla.eigsh(scale @ free @ scale, k=1, which="LM", v0=start, return_eigenvectors=False)
    return float(2.0 / np.sqrt(largest[0]))


def dynamics(quick: bool) -> Figures:
    """Cost of a step, number of steps, and the total beside gyrify's own run."""
    history = folded(quick)
    problem, body = history.slice, Body.of(history.slice)
    picked = np.linspace(0, len(history) - 1, 5).astype(int)
    states = [(history.state_vector(int(i)), float(history.growth_times[i])) for i in picked]
    stable = [stable_step(problem, u, time, False) for u, time in states]
    run = Sample(tuple(simulate(configuration(quick)).wall_s for _ in range(1 if quick else 3)))
    step, contact = _costs(body, states[-1][0], 3 if quick else 9)
    steps_by_name = {
        "stable": body.duration * float(np.mean([1.0 / dt for dt in stable])) / SAFETY,
        "BrainGrowth's": body.duration / (STEP * problem.mean_cortical_edge / np.sqrt(problem.kappa.max())),
    }
    found = [
        Figure("loading time in crossings by a shear wave", CROSSINGS),
        Figure.of("one step, elastic", step),
        Figure.of("contact forces of the folded slice", contact),
        Figure("stable step, folded, over that at the start", stable[-1] / stable[0]),
        Figure("the same with contact", stable_step(problem, *states[-1], True) / stable[0]),
        Figure.of("gyrify: solve", run),
    ]
    for name, number in steps_by_name.items():
        total = {"no contact": number * step.median, "contact": number * (step.median + contact.median)}
        found.append(Figure(f"{name} step: steps", round(number), is_extrapolated=True))
        for word, seconds in total.items():
            found.append(Figure(f"{name} step: total, {word}", seconds, "s", is_extrapolated=True))
        ratio = total["contact"] / run.median
        found.append(Figure(f"{name} step: over gyrify", ratio, "x", is_extrapolated=True))
    return found + _lag(body, 0.9 * min(stable), quick)


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
