"""Every element on the growing circle, against the exact one-dimensional state."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from growing_circle import circle_errors, configured
from panels import rates

# growth ratio and duration: where the cortex outgrows the white matter, and where all grows against the clamp
CASES = {"cortex": (3.6, 200.0), "uniform": (1.0, 500.0)}
LEVELS = {"linear": (2, 4), "mean_dilatation": (2, 4), "quadratic": (1, 2)}


@cache
def errors(element: str, case: str, levels: tuple[int, ...], out_of_plane: str = "blocked") -> np.ndarray:
    """(n_levels, 3) errors."""
    ratio, duration = CASES[case]
    growth = {"growth.ratio": ratio, "growth.duration": duration, "growth.out_of_plane": out_of_plane}
    return np.array([circle_errors(configured(level, element, **growth)) for level in levels])


@pytest.mark.parametrize(
    ("element", "order"), [("linear", 2.0), ("mean_dilatation", 2.0), ("quadratic", 2.8)]
)
def test_displacement_converges(element: str, order: float) -> None:
    """In L2 over the slice; the gradient one order less."""
    found = errors(element, "cortex", LEVELS[element])
    assert rates(found[:, 0])[0] >= order - 0.1 * (element != "quadratic")
    assert rates(found[:, 1])[0] >= order - 1.1
    assert np.all(found[:, 2] == 0.0)


@pytest.mark.slow
@pytest.mark.parametrize("case", ["cortex", "uniform"])
def test_quadratic_order_is_at_least_2_8(case: str) -> None:
    """Last halving of 96 x 10 to 192 x 20 and 384 x 40 quadrilaterals."""
    found = errors("quadratic", case, (2, 4, 8))
    assert rates(found[:, 0])[-1] >= 2.8
    assert rates(found[:, 1])[-1] >= 1.8


def test_quadratic_triangles_beat_linear_ones_with_the_same_nodes() -> None:
    """The coarsest pair, 1056 nodes: five times in L2 against linear, four against mean dilatation."""
    quadratic = errors("quadratic", "cortex", LEVELS["quadratic"])[0, 0]
    assert errors("linear", "cortex", LEVELS["linear"])[0, 0] >= 5.0 * quadratic
    assert errors("mean_dilatation", "cortex", LEVELS["mean_dilatation"])[0, 0] >= 4.0 * quadratic


def test_mean_dilatation_relieves_the_locking_of_uniform_growth() -> None:
    """The same meshes where everything is pressed against the clamp: less than half the error."""
    linear, free = (errors(element, "uniform", (2, 4)) for element in ("linear", "mean_dilatation"))
    assert np.all(free[:, 0] <= 0.45 * linear[:, 0])
    assert rates(free[:, 0])[0] >= 1.7


@pytest.mark.parametrize(("element", "order", "axial_order"), [("linear", 1.9, 1.8), ("quadratic", 2.8, 3.3)])
def test_generalised_plane_strain_converges(element: str, order: float, axial_order: float) -> None:
    """Displacement and axial strain F33 - 1, which converges as the energy does: twice the order of H1."""
    found = errors(element, "cortex", LEVELS[element], "generalised")
    assert rates(found[:, 0])[0] >= order
    assert rates(found[:, 2])[0] >= axial_order
    assert found[-1, 2] <= (1e-5 if element == "quadratic" else 1e-3)
