"""A film on a half-space, both in uniform stretch: parameters and the state before folding.

Layers are infinite along x; the depth is Y, the film lies on top and its surface is free. The load is one
number, g: the growth stretch of a film that is held at its length, or 1/lambda where the whole bilayer is
shortened to the stretch lambda. The compression is 1 - 1/g in both.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gyrify.errors import ConfigError, SolveError
from gyrify.theory.moduli import EnergyPer, Response, compressible, elastic_moduli, incompressible
from gyrify.theory.wave import half_space_stiffness, state_matrix

FloatArray = NDArray[np.float64]
Loading = Literal["compression", "uniaxial", "isotropic", "plane", "tangential"]
Layer = Literal["film", "substrate"]

INCOMPRESSIBLE: Final = 0.5
# Which of (across, along, axial) grow; F_33 = 1 in total always, so growth in z is blocked.
_GROWS = {
    "compression": (0.0, 0.0, 0.0),
    "uniaxial": (0.0, 1.0, 0.0),
    "isotropic": (1.0, 1.0, 1.0),
    "plane": (1.0, 1.0, 0.0),
    "tangential": (0.0, 1.0, 1.0),
}
_MAX_NEWTON = 60


@dataclass(frozen=True)
class Bilayer:
    """A film on a half-space.

    Attributes
    ----------
    stiffness_ratio : float
        Young's modulus of the film / that of the substrate [-].
    poisson_ratio : float
        nu of the film [-]; 0.5 is the incompressible neo-Hookean solid.
    poisson_ratio_substrate : float or None
        nu of the substrate [-]; None for the film's.
    loading : {"compression", "uniaxial", "isotropic", "plane", "tangential"}
        Whole bilayer compressed along x; or held at its length while it grows along x only, in all directions
        (z blocked), in the plane only (no growth in z), or along x and z only (z blocked).
    growth_ratio : float
        Growth strain g - 1 of the film / that of the substrate [-]; infinite: the substrate does not grow.
    energy_per : {"grown", "reference"}
        The volume that W is counted in.

    Raises
    ------
    ConfigError
        If a value is out of bounds.
    """

    stiffness_ratio: float = 1.0
    poisson_ratio: float = INCOMPRESSIBLE
    poisson_ratio_substrate: float | None = None
    loading: Loading = "isotropic"
    growth_ratio: float = np.inf
    energy_per: EnergyPer = "grown"

    def __post_init__(self) -> None:
        if self.loading not in get_args(Loading) or self.energy_per not in get_args(EnergyPer):
            raise ConfigError(
                f"loading is {self.loading!r}, energy_per {self.energy_per!r}.", "See `Bilayer`."
            )
        if not (0.0 < self.stiffness_ratio < np.inf and self.growth_ratio > 0.0):
            raise ConfigError("A ratio of the bilayer is out of bounds.", "Ratios must be positive.")
        for layer in get_args(Layer):
            if self._poisson_ratio(layer) != INCOMPRESSIBLE:
                elastic_moduli(1.0, self._poisson_ratio(layer))

    def _poisson_ratio(self, layer: Layer) -> float:
        if layer == "film" or self.poisson_ratio_substrate is None:
            return self.poisson_ratio
        return self.poisson_ratio_substrate

    def growth(self, layer: Layer, load: ArrayLike) -> FloatArray:
        """Principal growth stretches (..., 3) [-] of a layer at loads g (...) [-]."""
        strain = np.asarray(load, dtype=np.float64) - 1.0
        if layer == "substrate":
            strain = strain / self.growth_ratio
        growth: FloatArray = 1.0 + strain[..., None] * np.array(_GROWS[self.loading])
        return growth

    def along(self, load: ArrayLike) -> FloatArray:
        """Total stretch F_22 (...) [-] along the layers at loads g (...) [-]."""
        loads = np.asarray(load, dtype=np.float64)
        return 1.0 / loads if self.loading == "compression" else np.ones_like(loads)

    def state(self, layer: Layer, load: ArrayLike) -> tuple[FloatArray, Response]:
        """Uniform state of a layer with a free surface.

        Parameters
        ----------
        layer : {"film", "substrate"}
            Which layer.
        load : (...) array_like
            Loads g [-].

        Returns
        -------
        tuple of (..., 3) float array and Response
            Principal total stretches [-], and energy, stress, tangent in units of the film's Young's modulus.

        Raises
        ------
        SolveError
            If no stretch across the layer leaves it free of stress there.
        """
        growth = self.growth(layer, load)
        along, nu = self.along(load), self._poisson_ratio(layer)
        young = 1.0 if layer == "film" else 1.0 / self.stiffness_ratio
        across = np.prod(growth, axis=-1) / along
        stretch = np.stack([across, along, np.ones_like(along)], axis=-1)
        if nu == INCOMPRESSIBLE:
            return stretch, incompressible(stretch, growth, np.full_like(along, young / 3.0), self.energy_per)
        mu, kappa = (np.full_like(along, modulus) for modulus in elastic_moduli(young, nu))
        for _ in range(_MAX_NEWTON):
            response = compressible(stretch, growth, mu, kappa, self.energy_per)
            change = -response.stress[..., 0] / response.moduli[..., 0, 0]
            # Never lose more than half of the thickness in one step.
            stretch[..., 0] += np.maximum(change, -0.5 * stretch[..., 0])
            if np.all(np.abs(change) <= 1e-14 * stretch[..., 0]):
                break
        else:
            if np.any(np.abs(change) > 1e-10 * stretch[..., 0]):
                raise SolveError("The uniform state of a layer is not found.", "Try a smaller load.")
        return stretch, compressible(stretch, growth, mu, kappa, self.energy_per)

    def matrices(self, layer: Layer, load: ArrayLike) -> FloatArray:
        """State matrices (n, 4, 4) of a layer at loads g (n,) [-] (see `state_matrix`), film's E = 1."""
        stretch, response = self.state(layer, np.atleast_1d(load))
        keeps_volume = self._poisson_ratio(layer) == INCOMPRESSIBLE
        return np.array(
            [
                state_matrix(tangent, stretches[:2] if keeps_volume else None)
                for tangent, stretches in zip(response.in_plane, stretch, strict=True)
            ]
        )

    def half_space(self, layer: Layer, load: ArrayLike) -> FloatArray:
        """Surface stiffness (n, 2, 2) of a half-space of a layer's tissue at loads g (n,), film's E = 1."""
        return np.array([half_space_stiffness(matrix) for matrix in self.matrices(layer, load)])
