r"""Compressible neo-Hookean solid, per unit volume of the stress-free (grown) tissue.

.. math:: W = \frac{\mu}{2} (J^{-2/3} I_1 - 3) + \frac{\kappa}{2} (J - 1)^2

This is the meaning of the paper's Eq. 6, whose print is garbled; J and I1 are those of the elastic
deformation gradient in three dimensions.
"""

from __future__ import annotations

from typing import Final

from gyrify.base.compiled import njit
from gyrify.physics.materials.material import Material


def lame_parameters(young_modulus: float, poisson_ratio: float) -> tuple[float, float]:
    """Shear and bulk modulus.

    Parameters
    ----------
    young_modulus : float
        E [Pa].
    poisson_ratio : float
        nu [-].

    Returns
    -------
    mu, kappa : float
        E / 2(1 + nu) and E / 3(1 - 2 nu) [Pa].
    """
    return young_modulus / (2.0 * (1.0 + poisson_ratio)), young_modulus / (3.0 * (1.0 - 2.0 * poisson_ratio))


@njit(cache=True, inline="always")
def density(I1, J, cube_root, p, c):  # type: ignore[no-untyped-def]
    """W [Pa]; see `Material`."""
    mu, kappa = p[0, c], p[1, c]
    return 0.5 * mu * (I1 / (cube_root * cube_root) - 3.0) + 0.5 * kappa * (J - 1.0) * (J - 1.0)


@njit(cache=True, inline="always")
def derivatives(I1, J, cube_root, p, c):  # type: ignore[no-untyped-def]
    """W_1, W_J, W_11, W_1J, W_JJ [Pa]: derivatives of W by I1 and J."""
    mu, kappa = p[0, c], p[1, c]
    power = mu / (cube_root * cube_root)
    return (
        0.5 * power,
        -power * I1 / (3.0 * J) + kappa * (J - 1.0),
        0.0,
        -power / (3.0 * J),
        5.0 / 9.0 * power * I1 / (J * J) + kappa,
    )


NEO_HOOKEAN: Final = Material(
    "neo_hookean",
    "invariants",
    density,
    derivatives,
    lame_parameters,
    "W = mu/2 (J^(-2/3) I1 - 3) + kappa/2 (J - 1)^2",
)
