"""The exact axisymmetric state of a growing circular annulus.

The inner circle is clamped, the outer one free. The state r(R) minimises 2 pi int psi(r', r/R, F_33) R dR; it
is computed with high-order elements, to about 1e-10.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gyrify.theory.annulus_parameters import Annulus
from gyrify.theory.moduli import Response
from gyrify.theory.radial import RadialProblem
from gyrify.theory.spectral import Line

__all__ = ["Annulus", "BaseState", "base_state"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class BaseState:
    """The axisymmetric equilibrium of an annulus at one growth time.

    Attributes
    ----------
    annulus : Annulus
        The parameters.
    growth_time : float
        t [time].
    line : Line
        The elements across the wall.
    displacement : (n_nodes,) float array
        r - R of the nodes [mm].
    axial_stretch : float
        F_33 [-].
    residual : float
        Largest out-of-balance nodal force / (E_G x outer radius) [-].
    """

    annulus: Annulus
    growth_time: float
    line: Line
    displacement: FloatArray
    axial_stretch: float
    residual: float

    def radius(self, reference_radius: ArrayLike) -> FloatArray:
        """Deformed radius r [mm] of reference radii R [mm], shaped as given."""
        places = np.asarray(reference_radius, dtype=np.float64)
        return places + (self.line.at(places.ravel())[0] @ self.displacement).reshape(places.shape)

    def stretches(self, reference_radius: ArrayLike) -> FloatArray:
        """Principal stretches (r', r/R, F_33) [-] as (n, 3) at reference radii (n,) [mm]."""
        places = np.atleast_1d(np.asarray(reference_radius, dtype=np.float64))
        values, slopes = self.line.at(places)
        along = 1.0 + values @ self.displacement / places
        across = 1.0 + slopes @ self.displacement
        return np.stack([across, along, np.full_like(along, self.axial_stretch)], axis=1)

    def response(self, reference_radius: ArrayLike) -> Response:
        """Energy, stress and tangent (`Response`) at reference radii (n,) [mm]."""
        return self.annulus.response(
            np.atleast_1d(reference_radius), self.stretches(reference_radius), self.growth_time
        )

    @cached_property
    def energy(self) -> float:
        """Strain energy of the slice per depth, 2 pi int psi R dR [Pa mm^2]."""
        line = self.line
        return float(2.0 * np.pi * (line.weights * line.points) @ self.response(line.points).energy)


def _problem(annulus: Annulus) -> RadialProblem:
    """Energy of r - R and F_33 - 1."""
    line = annulus.line()
    strain = np.zeros((len(line.points), 3, len(line.nodes) + 1))
    strain[:, 0, :-1] = line.slopes
    strain[:, 1, :-1] = line.values / line.points[:, None]
    strain[:, 2, -1] = 1.0
    free = np.ones(len(line.nodes) + 1, dtype=np.bool_)
    free[0] = False
    free[-1] = annulus.out_of_plane == "generalised"
    force = annulus.young_modulus * annulus.outer_radius
    return RadialProblem(annulus, line, line.weights * line.points, strain[:, :, free], free, force)


def base_state(
    annulus: Annulus, growth_time: float | None = None, guess: BaseState | None = None
) -> BaseState:
    """Axisymmetric equilibrium r(R) of a growing annulus.

    Newton's method on d/dr 2 pi int psi(r', r/R, F_33) R dR = 0, in growth steps small enough to converge.

    Parameters
    ----------
    annulus : Annulus
        The parameters.
    growth_time : float, optional
        t [time], not negative; the annulus' duration by default.
    guess : BaseState, optional
        A nearby state to start from; ignored if its nodes differ.

    Returns
    -------
    BaseState
        The state, in balance to round-off.

    Raises
    ------
    ConfigError
        If the growth time is negative or not finite.
    SolveError
        If no equilibrium is found.
    """
    time = annulus.duration if growth_time is None else float(growth_time)
    problem, start = _problem(annulus), None
    if guess is not None and np.array_equal(guess.line.nodes, problem.line.nodes):
        start = np.append(guess.displacement, guess.axial_stretch - 1.0)
    unknowns, residual = problem.solve(time, start)
    return BaseState(annulus, time, problem.line, unknowns[:-1], 1.0 + float(unknowns[-1]), residual)
