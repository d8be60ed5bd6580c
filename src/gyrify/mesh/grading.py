"""How the layers under the cortex thicken with depth."""

from __future__ import annotations

from typing import Final, Literal

import numpy as np
from scipy.optimize import brentq

from gyrify.mesh.mesh import FloatArray

Grading = Literal["geometric", "uniform"]

# Under a thick cortex the white layers thin out with depth; below this ratio they would become slivers.
LOWEST_RATIO: Final = 0.8


def layer_fractions(n_layers: int, top: float, grading: Grading) -> FloatArray:
    """Depth of the lines between white layers, from 0 (deep) to 1 (the interface).

    Parameters
    ----------
    n_layers : int
        Number of white layers.
    top : float
        Thickness of the layer under the interface over the whole depth (geometric grading only).
    grading : {"geometric", "uniform"}
        Law of the thicknesses.

    Returns
    -------
    (n_layers + 1,) float array
    """
    if grading == "uniform" or n_layers == 1:
        return np.linspace(0.0, 1.0, n_layers + 1)
    powers = np.arange(n_layers)

    def excess(ratio: float) -> float:
        with np.errstate(over="ignore"):  # the widest ratio that is tried may be far too wide
            return float(top * np.power(ratio, powers).sum() - 1.0)

    ratio = (
        LOWEST_RATIO if excess(LOWEST_RATIO) >= 0.0 else brentq(excess, LOWEST_RATIO, 2.0 / top, xtol=1e-15)
    )
    thickness = np.power(ratio, powers[::-1])
    lines = np.concatenate([[0.0], np.cumsum(thickness)])
    return np.asarray(lines / lines[-1])
