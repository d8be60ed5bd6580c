"""A term of one's own: the pressure of the fluid around the brain, times the area within the contour.

.. math:: E(u) = p A(u)

It does work on the tissue from outside: its role is *external*, and `gyrify verify`, the report and the plot
of the energy book it as the surroundings'.

Run it: ``python examples/own_term.py``
"""

from __future__ import annotations

import numpy as np

import gyrify
from gyrify.energy.term import Evaluation, FloatArray, Hessian, Pattern
from gyrify.model.terms import TERMS, GrowthStep, TermKind

PRESSURE = 30.0  # Pa


class FluidPressure:
    """Energy of a fluid of constant pressure around a closed contour."""

    is_barrier = False

    def __init__(self, step: GrowthStep) -> None:
        self._line, self._X = step.problem.mesh.contour, step.problem.mesh.points
        after = np.roll(self._line, -1)
        ends = np.stack([2 * self._line, 2 * after + 1]), np.stack([2 * self._line + 1, 2 * after])
        self._pattern, self._position = Pattern.of(*np.stack(ends, axis=1).reshape(2, -1))

    def evaluate(self, u: FloatArray, order: int, project_psd: bool = False) -> Evaluation:
        """Energy [Pa mm^2], gradient [Pa mm] and Hessian [Pa]; the latter has no projection of its own."""
        x = (self._X + u[: len(self._X)])[self._line]
        before, after = np.roll(x, 1, axis=0), np.roll(x, -1, axis=0)
        area = 0.5 * float(np.sum(x[:, 0] * after[:, 1] - x[:, 1] * after[:, 0]))
        gradient, turn = np.zeros_like(u), np.array([[0.0, -1.0], [1.0, 0.0]])
        gradient[self._line] = 0.5 * PRESSURE * (after - before) @ turn
        values = np.zeros(self._pattern.rows.size)
        if not project_psd:
            signs = np.repeat([0.5 * PRESSURE, -0.5 * PRESSURE], len(self._line))
            np.add.at(values, self._position, signs)
        return Evaluation(PRESSURE * area, gradient, Hessian(self._pattern, values) if order == 2 else None)

    def max_step(self, u: FloatArray, du: FloatArray) -> float:  # noqa: ARG002
        """Every step is admissible."""
        return 1.0


if __name__ == "__main__":
    TERMS.append(TermKind("fluid pressure", "external", FluidPressure))
    coarse = {"mesh.n_around": 108, "mesh.n_layers": 9, "mesh.n_cortex_layers": 3}
    print(gyrify.measure_state(gyrify.simulate(gyrify.Config().with_overrides(coarse))))
