"""An indefinite stiffness made definite by a multiple of the mass: K + tau M."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from gyrify.errors import SolveError
from gyrify.solve.linear import Factor
from gyrify.solve.system import System
from gyrify.solve.types import FloatArray

# First shift over the largest diagonal entry of M^-1 K, and how often it may be raised.
FIRST_SHIFT: Final = 1e-5
_RAISES: Final = 60


class Shifted(NamedTuple):
    """A definite factor, and the shift that it took.

    Attributes
    ----------
    factor : Factor
        Of K + tau M.
    tau : float
        The shift [Pa/mm^2].
    """

    factor: Factor
    tau: float


def shifted_factor(
    system: System,
    data: FloatArray,
    mass: FloatArray,
    least: float = 0.0,
    growth: float = 2.0,
    first: float = FIRST_SHIFT,
) -> Shifted:
    """Factor of K + tau M with the first tau of a geometric sequence that leaves no negative pivot.

    Parameters
    ----------
    system : System
        Linear system of the free degrees of freedom.
    data : float array
        K on the pattern of the system [Pa].
    mass : (n_free,) float array
        Diagonal of M [mm^2].
    least : float
        Smallest tau to try [Pa/mm^2].
    growth : float
        Ratio of the sequence [-].
    first : float
        Smallest tau to try over the largest diagonal entry of M^-1 K, whatever its sign [-].

    Returns
    -------
    Shifted

    Raises
    ------
    SolveError
        If no shift is enough.
    """
    diagonal = system.pattern.indptr[:-1]
    tau = max(least, first * float(np.abs(data[diagonal] / mass).max()))
    for _ in range(_RAISES):
        shifted = data.copy()
        shifted[diagonal] += tau * mass
        factor = system.factorise_definite(shifted)
        if factor is not None:
            return Shifted(factor, tau)
        tau *= growth
    raise SolveError(
        "No shift makes the stiffness positive definite.", "Check that all stiffnesses are finite."
    )
