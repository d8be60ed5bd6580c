"""The parameters of a growing circular annulus: geometry, tissues, growth, and every open reading."""

from __future__ import annotations

from dataclasses import dataclass
from typing import get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gyrify.theory.moduli import (
    EnergyPer,
    Law,
    OutOfPlane,
    Response,
    Stretch,
    compressible,
    elastic_moduli,
    growth_stretch,
)
from gyrify.theory.radial import require_parameters, wall
from gyrify.theory.spectral import Line

FloatArray = NDArray[np.float64]

_CHOICES = {
    "out_of_plane": get_args(OutOfPlane),
    "stretch": get_args(Stretch),
    "energy_per": get_args(EnergyPer),
    "law": get_args(Law),
}


@dataclass(frozen=True)
class Annulus:
    """A circular slice that grows in its plane; every default is the reference slice's, on a circle.

    Attributes
    ----------
    inner_radius, outer_radius : float
        Radii of the clamped hole and of the free contour [mm].
    cortical_thickness : float
        T [mm]; the grey-white interface is the circle of radius `outer_radius` - T.
    young_modulus : float
        E of the cortex [Pa].
    stiffness_ratio : float
        E of the cortex / E of the white matter [-].
    poisson_ratio : float
        nu of the cortex [-].
    poisson_ratio_white : float or None
        nu of the white matter [-]; None for the cortex's.
    growth_rate : float
        G of the cortex [1/time].
    growth_ratio : float
        G of the cortex / G of the white matter [-].
    duration : float
        Final growth time [time].
    out_of_plane : {"blocked", "none", "generalised"}
        Total F_33 = 1 with growth in z, F_33 = 1 without, or F_33 free of net axial force with growth in z.
    out_of_plane_exponent : float
        s of the growth in z, F_g,33 = lambda_g^s [-], >= 0.
    stretch : {"linear", "exponential"}
        lambda_g = 1 + G t or exp(G t).
    energy_per : {"grown", "reference"}
        The volume that W is counted in.
    law : {"isotropic", "tangential"}
        In-plane growth of the cortex; the white matter is always isotropic.
    degree : int
        Polynomial degree of the elements.

    Raises
    ------
    ConfigError
        If a value is out of bounds.
    """

    inner_radius: float = 18.0
    outer_radius: float = 36.0
    cortical_thickness: float = 1.5
    young_modulus: float = 9210.87
    stiffness_ratio: float = 1.0
    poisson_ratio: float = 0.458
    poisson_ratio_white: float | None = None
    growth_rate: float = 0.002
    growth_ratio: float = 3.6
    duration: float = 500.0
    out_of_plane: OutOfPlane = "blocked"
    out_of_plane_exponent: float = 1.0
    stretch: Stretch = "linear"
    energy_per: EnergyPer = "grown"
    law: Law = "isotropic"
    degree: int = 12

    def __post_init__(self) -> None:
        require_parameters(self, _CHOICES, may_vanish=("out_of_plane_exponent",))
        # Evaluated for their checks of the moduli.
        _ = self.moduli_grey, self.moduli_white

    @property
    def interface_radius(self) -> float:
        """Radius of the grey-white interface [mm]."""
        return self.outer_radius - self.cortical_thickness

    @property
    def moduli_grey(self) -> tuple[float, float]:
        """Shear and bulk modulus of the cortex [Pa]."""
        return elastic_moduli(self.young_modulus, self.poisson_ratio)

    @property
    def moduli_white(self) -> tuple[float, float]:
        """Shear and bulk modulus of the white matter [Pa]."""
        nu = self.poisson_ratio if self.poisson_ratio_white is None else self.poisson_ratio_white
        return elastic_moduli(self.young_modulus / self.stiffness_ratio, nu)

    def line(self) -> Line:
        """The elements across the wall, with an edge on the interface."""
        return wall(self.inner_radius, self.interface_radius, self.outer_radius, self.degree)

    def growth(self, radius: ArrayLike, growth_time: float) -> FloatArray:
        """Principal growth stretches.

        Parameters
        ----------
        radius : (n,) array_like
            Reference radius R [mm]; the interface itself counts as cortex.
        growth_time : float
            t [time].

        Returns
        -------
        (n, 3) float array
            Radial, circumferential and axial growth stretch [-].
        """
        grey = np.asarray(radius, dtype=np.float64) >= self.interface_radius
        rate = self.growth_rate * np.where(grey, 1.0, 1.0 / self.growth_ratio)
        growth = np.repeat(growth_stretch(rate, growth_time, self.stretch)[:, None], 3, axis=1)
        growth[:, 2] **= self.out_of_plane_exponent
        if self.law == "tangential":
            growth[grey, 0] = 1.0
        if self.out_of_plane == "none":
            growth[:, 2] = 1.0
        return growth

    def response(self, radius: ArrayLike, stretch: FloatArray, growth_time: float) -> Response:
        """Energy, stress and tangent (`Response`) at radii (n,) [mm] and principal stretches (n, 3) [-]."""
        places = np.asarray(radius, dtype=np.float64)
        grey = places >= self.interface_radius
        mu, kappa = (np.where(grey, a, b) for a, b in zip(self.moduli_grey, self.moduli_white, strict=True))
        return compressible(stretch, self.growth(places, growth_time), mu, kappa, self.energy_per)
