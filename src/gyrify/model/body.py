"""What the tissue of a configuration is made of at each point: its growth and its material."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gyrify.config import Config
from gyrify.energy.term import FloatArray
from gyrify.physics.growth import Growth
from gyrify.physics.materials import Material, material_named


def growth_of(config: Config, grey: NDArray[np.bool_], across: FloatArray) -> Growth:
    """Growth of the points of a body.

    Parameters
    ----------
    config : Config
        Every number of the run.
    grey : (n,) bool array
        Where there is grey matter.
    across : (n, n_dim) float array
        Unit reference direction across the layers.
    """
    growth = config.growth
    return Growth(
        rate=np.where(grey, growth.rate, growth.rate_white),
        tangential=grey & (growth.law == "tangential"),
        across=np.asarray(across),
        law=growth.stretch,
        out_of_plane_rule=growth.out_of_plane,
        exponent=growth.out_of_plane_exponent,
    )


def parameters_of(config: Config, grey: NDArray[np.bool_]) -> FloatArray:
    """(n_parameters, n) parameters of the material at each point; arguments as in `growth_of`."""
    given, law = config.material, material_of(config)
    stiff = law.parameters(given.young_modulus, given.poisson_ratio)
    soft = law.parameters(given.young_modulus_white, given.poisson_ratio_white)
    return np.stack([np.where(grey, g, w) for g, w in zip(stiff, soft, strict=True)])


def material_of(config: Config) -> Material:
    """The material of a configuration."""
    return material_named(config.material.law)
