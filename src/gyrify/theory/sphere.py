"""A growing sphere, solid or hollow, and its exact state with spherical symmetry.

The outer surface is free; a solid sphere has its centre where it was, and the surface of a hole is clamped or
free. The state r(R) minimises 4 pi int psi(r', r/R, r/R) R^2 dR.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gyrify.theory.moduli import (
    EnergyPer,
    Law,
    Response,
    Stretch,
    compressible,
    elastic_moduli,
    growth_stretch,
)
from gyrify.theory.radial import RadialProblem, require_parameters, wall
from gyrify.theory.spectral import Line

FloatArray = NDArray[np.float64]
Hole = Literal["clamped", "free"]

_CHOICES: Final = {"hole": get_args(Hole), "stretch": get_args(Stretch)} | {
    "energy_per": get_args(EnergyPer),
    "law": get_args(Law),
}


@dataclass(frozen=True)
class Sphere:
    """A sphere whose cortex outgrows its white matter.

    Attributes
    ----------
    inner_radius : float
        Radius of the hole [mm]; 0 for a solid sphere.
    outer_radius : float
        Radius of the free surface [mm].
    cortical_thickness : float
        T [mm]; the grey-white interface is the sphere of radius `outer_radius` - T.
    young_modulus : float
        E of the cortex [Pa].
    stiffness_ratio : float
        E of the cortex / E of the white matter [-].
    poisson_ratio : float
        nu of both tissues [-].
    growth_rate : float
        G of the cortex [1/time].
    growth_ratio : float
        G of the cortex / G of the white matter [-]; infinite where the white matter does not grow.
    duration : float
        Final growth time [time].
    hole : {"clamped", "free"}
        What holds the surface of a hole.
    stretch : {"linear", "exponential"}
        lambda_g = 1 + G t or exp(G t).
    energy_per : {"grown", "reference"}
        The volume that W is counted in.
    law : {"isotropic", "tangential"}
        Growth of the cortex, in all directions or along the surface alone; the white matter is isotropic.
    degree : int
        Polynomial degree of the elements.

    Raises
    ------
    ConfigError
        If a value is out of bounds.
    """

    inner_radius: float = 0.0
    outer_radius: float = 36.0
    cortical_thickness: float = 1.5
    young_modulus: float = 9210.87
    stiffness_ratio: float = 1.0
    poisson_ratio: float = 0.458
    growth_rate: float = 0.002
    growth_ratio: float = 3.6
    duration: float = 500.0
    hole: Hole = "clamped"
    stretch: Stretch = "linear"
    energy_per: EnergyPer = "grown"
    law: Law = "isotropic"
    degree: int = 12

    def __post_init__(self) -> None:
        require_parameters(self, _CHOICES, may_vanish=("inner_radius",), may_be_infinite=("growth_ratio",))
        # Evaluated for its check of the moduli.
        _ = self.moduli_grey

    @property
    def interface_radius(self) -> float:
        """Radius of the grey-white interface [mm]."""
        return self.outer_radius - self.cortical_thickness

    @property
    def moduli_grey(self) -> tuple[float, float]:
        """Shear and bulk modulus of the cortex [Pa]."""
        return elastic_moduli(self.young_modulus, self.poisson_ratio)

    @property
    def is_held(self) -> bool:
        """Whether a clamp keeps it from moving as a whole."""
        return self.inner_radius > 0.0 and self.hole == "clamped"

    def line(self) -> Line:
        """The elements across the wall, with an edge on the interface."""
        return wall(self.inner_radius, self.interface_radius, self.outer_radius, self.degree)

    def growth(self, radius: ArrayLike, growth_time: float) -> FloatArray:
        """Radial and the two tangential growth stretches (n, 3) [-] at reference radii (n,) [mm]."""
        grey = np.asarray(radius, dtype=np.float64) >= self.interface_radius
        rate = self.growth_rate * np.where(grey, 1.0, 1.0 / self.growth_ratio)
        growth = np.repeat(growth_stretch(rate, growth_time, self.stretch)[:, None], 3, axis=1)
        if self.law == "tangential":
            growth[grey, 0] = 1.0
        return growth

    def response(self, radius: ArrayLike, stretch: FloatArray, growth_time: float) -> Response:
        """Energy, stress and tangent (`Response`) at radii (n,) [mm] and principal stretches (n, 3) [-]."""
        return self._response(radius, stretch, growth_time, [0, 1, 2])

    def tangential_response(self, radius: ArrayLike, stretch: FloatArray, growth_time: float) -> Response:
        """The same with the directions in the order (along, along, across): its shear is that of a layer."""
        return self._response(radius, stretch, growth_time, [1, 2, 0])

    def _response(self, radius: ArrayLike, stretch: FloatArray, time: float, order: list[int]) -> Response:
        places = np.asarray(radius, dtype=np.float64)
        grey = places >= self.interface_radius
        white = elastic_moduli(self.young_modulus / self.stiffness_ratio, self.poisson_ratio)
        mu, kappa = (np.where(grey, a, b) for a, b in zip(self.moduli_grey, white, strict=True))
        growth = self.growth(places, time)[:, order]
        return compressible(stretch[:, order], growth, mu, kappa, self.energy_per)


@dataclass(frozen=True, eq=False)
class SphereState:
    """The equilibrium of a sphere at one growth time.

    Attributes
    ----------
    sphere : Sphere
        The parameters.
    growth_time : float
        t [time].
    line : Line
        The elements across the wall.
    displacement : (n_nodes,) float array
        r - R of the nodes [mm].
    residual : float
        Largest out-of-balance nodal force / (E_G x outer radius^2) [-].
    """

    sphere: Sphere
    growth_time: float
    line: Line
    displacement: FloatArray
    residual: float

    def radius(self, reference_radius: ArrayLike) -> FloatArray:
        """Deformed radius r [mm] of reference radii R [mm], shaped as given."""
        places = np.asarray(reference_radius, dtype=np.float64)
        return places + (self.line.at(places.ravel())[0] @ self.displacement).reshape(places.shape)

    def stretches(self, reference_radius: ArrayLike) -> FloatArray:
        """Principal stretches (r', r/R, r/R) [-] as (n, 3) at reference radii (n,) [mm], not the centre."""
        places = np.atleast_1d(np.asarray(reference_radius, dtype=np.float64))
        values, slopes = self.line.at(places)
        along = 1.0 + values @ self.displacement / places
        return np.stack([1.0 + slopes @ self.displacement, along, along], axis=1)

    def response(self, reference_radius: ArrayLike) -> Response:
        """Energy, stress and tangent (`Response`) at reference radii (n,) [mm]."""
        places = np.atleast_1d(np.asarray(reference_radius, dtype=np.float64))
        return self.sphere.response(places, self.stretches(places), self.growth_time)

    @property
    def energy(self) -> float:
        """Strain energy, 4 pi int psi R^2 dR [Pa mm^3]."""
        line = self.line
        return float(4.0 * np.pi * (line.weights * line.points**2) @ self.response(line.points).energy)


def sphere_state(
    sphere: Sphere, growth_time: float | None = None, guess: SphereState | None = None
) -> SphereState:
    """Equilibrium r(R) of a growing sphere.

    Newton's method on d/dr 4 pi int psi(r', r/R, r/R) R^2 dR = 0, in growth steps small enough to converge.

    Parameters
    ----------
    sphere : Sphere
        The parameters.
    growth_time : float, optional
        t [time], not negative; the sphere's duration by default.
    guess : SphereState, optional
        A nearby state to start from; ignored if its nodes differ.

    Returns
    -------
    SphereState
        The state, in balance to round-off.

    Raises
    ------
    ConfigError
        If the growth time is negative or not finite.
    SolveError
        If no equilibrium is found.
    """
    time = sphere.duration if growth_time is None else float(growth_time)
    line = sphere.line()
    hoop = line.values / line.points[:, None]
    free = np.ones(len(line.nodes), dtype=np.bool_)
    free[0] = sphere.inner_radius > 0.0 and not sphere.is_held
    strain = np.stack([line.slopes, hoop, hoop], axis=1)[:, :, free]
    force = sphere.young_modulus * sphere.outer_radius**2
    problem = RadialProblem(sphere, line, line.weights * line.points**2, strain, free, force)
    is_near = guess is not None and np.array_equal(guess.line.nodes, line.nodes)
    unknowns, residual = problem.solve(time, guess.displacement if is_near and guess else None)
    return SphereState(sphere, time, line, unknowns, residual)
