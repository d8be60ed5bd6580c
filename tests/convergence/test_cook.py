"""Cook's panel: deflection of the tip, all elements with the same nodes.

Limits as the quadratic element approaches them with 16, 32 and 64 squares along each side (docs/elements.md).
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from cook import FORCE, end_shear, panel, tip_deflection
from panels import ELEMENTS

LIMIT = {0.458: 7.37, 0.4999: 6.93}
SQUARES = {"linear": (8, 16, 32), "mean_dilatation": (8, 16, 32), "quadratic": (4, 8, 16)}


@cache
def shortfall(element: str, poisson_ratio: float) -> np.ndarray:
    """(3 levels,) deflection that is missing, over the limit."""
    tips = [tip_deflection(n, element, poisson_ratio) for n in SQUARES[element]]
    return 1.0 - np.array(tips) / LIMIT[poisson_ratio]


def test_load_is_the_same_for_all_elements() -> None:
    for element in ELEMENTS:
        body = panel(4, element)
        forces = end_shear(body, FORCE)
        assert forces.sum(axis=0) == pytest.approx([0.0, FORCE])
        moment = (body.points[:, 0] * forces[:, 1]).sum()
        assert moment == pytest.approx(48.0 * FORCE)


@pytest.mark.parametrize("poisson_ratio", [0.458, 0.4999])
@pytest.mark.parametrize("element", ELEMENTS)
def test_deflection_rises_towards_the_limit(element: str, poisson_ratio: float) -> None:
    """All are too stiff, and each halving removes two fifths of what is missing or more."""
    missing = shortfall(element, poisson_ratio)
    assert np.all(missing > 0.0)
    assert np.all(missing[1:] <= 0.6 * missing[:-1])


@pytest.mark.parametrize(("poisson_ratio", "factor"), [(0.458, 1.9), (0.4999, 2.8)])
def test_linear_triangles_are_the_stiffest(poisson_ratio: float, factor: float) -> None:
    """With 1089 nodes; the more so the less compressible."""
    linear = shortfall("linear", poisson_ratio)[-1]
    assert linear >= factor * shortfall("mean_dilatation", poisson_ratio)[-1]
    assert linear >= factor * shortfall("quadratic", poisson_ratio)[-1]
