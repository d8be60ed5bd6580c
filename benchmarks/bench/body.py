"""A slice as a damped dynamic body: its stable time step, and its explicit integration."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla

from bench.peers.explicit import add_forces, advance, steps
from gyrify.energy.term import FloatArray
from gyrify.model.slice import Slice

# Loading time of BrainGrowth in crossings of the half length by a shear wave.
CROSSINGS = 10.0
# Steps after which the activation distance of contact is adapted to the shortest edge.
RENEWED = 200


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
        crossing = max(config.geometry.outer_axes) / np.sqrt(problem.parameters[0].max())
        duration = CROSSINGS * crossing
        drag = config.dissipation.number * config.material.young_modulus / config.geometry.drag_length**2
        return Body(problem, duration, drag * duration)

    def advance(
        self, number: int, dt: float, start: float, u: FloatArray, v: FloatArray
    ) -> tuple[float, float]:
        """Take steps from a time; elastic and kinetic energy at their end."""
        problem, cells = self.problem, self.problem.simplices
        rate = problem.growth.rate * problem.config.growth.duration
        return steps(
            number, start, dt, self.duration, u, v, cells.cells, cells.gradients, cells.volumes, rate,
            problem.parameters[0], problem.bulk_modulus, problem.lumped_area, self.is_free, self.damping,
        )  # fmt: skip

    @cached_property
    def is_free(self) -> np.ndarray:
        """(n_points, 2) which components move."""
        free = np.zeros(self.problem.state_shape, dtype=bool)
        free.ravel()[self.problem.free] = True
        return free

    def fold(self, number: int) -> tuple[FloatArray, float]:
        """Displacement after growth in so many steps with contact, and its kinetic over elastic energy.

        Raises
        ------
        RuntimeError
            If a step leads through a contact or inverts a cell: it was not stable.
        """
        problem, cells, dt = self.problem, self.problem.simplices, self.duration / number
        u, v = np.zeros(problem.state_shape), np.zeros(problem.state_shape)
        rate, elastic, kinetic = problem.growth.rate * problem.config.growth.duration, 0.0, 0.0
        for step in range(number):
            if step % RENEWED == 0:
                contact = problem.contact_energy(u)
            touching = contact.evaluate(u, 1)
            if touching.gradient is None or not np.isfinite(elastic):
                raise RuntimeError(f"explicit dynamics fails at step {step} of {number}")
            forces = -touching.gradient
            stretch = 1.0 + rate * (step + 1) / number
            elastic = add_forces(
                u,
                cells.cells,
                cells.gradients,
                cells.volumes,
                stretch,
                problem.parameters[0],
                problem.bulk_modulus,
                forces,
            )
            kinetic = advance(u, v, forces, problem.lumped_area, self.is_free, self.damping, dt)
        return u, kinetic / elastic


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
