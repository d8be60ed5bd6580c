"""What the tissue of a configuration is made of at each point: its growth and its material."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gyrify.config import Config
from gyrify.energy.term import FloatArray
from gyrify.physics.growth import Growth
from gyrify.physics.neo_hookean import lame_parameters


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


def moduli_of(config: Config, grey: NDArray[np.bool_]) -> tuple[FloatArray, FloatArray]:
    """(n,) shear and (n,) bulk modulus [Pa]; parameters as in `growth_of`."""
    material = config.material
    stiff = lame_parameters(material.young_modulus, material.poisson_ratio)
    soft = lame_parameters(material.young_modulus_white, material.poisson_ratio_white)
    mu, kappa = (np.where(grey, g, w) for g, w in zip(stiff, soft, strict=True))
    return mu, kappa
