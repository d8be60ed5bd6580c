"""Onset of folding on the circle with quadratic triangles, against the exact annulus."""

from __future__ import annotations

import numpy as np
import pytest

from gyrify.config import Config
from gyrify.theory import Annulus, critical_growth_ratio
from gyrify.threshold import critical_growth


def relative_error(
    quadrilaterals: tuple[int, int, int], stiffness_ratio: float = 1.0, element: str = "quadratic"
) -> float:
    """Critical growth ratio, less the exact one, over it; around, across, across the cortex."""
    exact = critical_growth_ratio(Annulus(stiffness_ratio=stiffness_ratio))[0]
    n_around, n_layers, n_cortex_layers = quadrilaterals
    overrides = {
        "geometry.shape": "circle",
        "material.stiffness_ratio": stiffness_ratio,
        "mesh.node_jitter": 0.0,
        "mesh.element": element,
        "mesh.n_around": n_around,
        "mesh.n_layers": n_layers,
        "mesh.n_cortex_layers": n_cortex_layers,
        "dissipation.kind": "none",
        "contact.enabled": False,
    }
    config = Config.preset("reference-slice").with_overrides(overrides)
    span = (0.99 * exact.value, (1.02 if element == "quadratic" else 1.08) * exact.value)
    found = critical_growth(config, range=span, points=2, tolerance=1e-5)
    assert found.critical_value is not None
    assert found.mode_number is not None
    assert exact.mode_number is not None
    assert element != "quadratic" or abs(found.mode_number - exact.mode_number) <= 1
    return found.critical_value / exact.value - 1.0


def test_quadratic_onset_is_within_a_thousandth() -> None:
    """216 x 12 quadrilaterals, 1.7604 against 1.7595; linear triangles of this mesh are 5.8 % off."""
    assert 0.0 < relative_error((216, 12, 4)) <= 1e-3


@pytest.mark.slow
def test_quadratic_onset_of_the_softer_cortex_is_within_a_thousandth() -> None:
    """288 x 16 quadrilaterals against 2.0181 at stiffness ratio 1/1.36."""
    assert 0.0 < relative_error((288, 16, 8), 1.0 / 1.36) <= 1e-3


@pytest.mark.slow
def test_quadratic_onset_converges_with_the_fourth_order() -> None:
    """Twice the order of the gradient, or better: 144 x 8, 216 x 12, 288 x 16."""
    errors = np.array([relative_error((72 * k, 4 * k, 2 * k)) for k in (2, 3, 4)])
    orders = np.log(errors[:-1] / errors[1:]) / np.log([3 / 2, 4 / 3])
    assert np.all(errors > 0.0)
    assert np.all(orders >= 3.7)


@pytest.mark.slow
def test_onset_with_mean_dilatation_is_late_as_with_linear_triangles() -> None:
    """At nu = 0.458 bending, not locking, delays it: 4.5 and 5.8 % on 216 x 12 quadrilaterals."""
    free, linear = (relative_error((216, 12, 4), element=e) for e in ("mean_dilatation", "linear"))
    assert 0.03 < free < linear < 0.07
