"""The residual stored with every increment, computed again from the stored states by an independent route."""

from __future__ import annotations

import numpy as np
import pytest
from oracle import SliceOracle

from gyrify.store import History


def assert_residuals(history: History) -> None:
    config, oracle = history.config, SliceOracle(history.config, history.mesh)
    # contract: largest nodal force <= tolerance x E_G x mean edge of the grey cells
    grey = oracle.X[oracle.grey]
    edge = np.linalg.norm(grey - np.roll(grey, 1, axis=1), axis=2).mean()
    scale = config.material.young_modulus * edge
    fractions, stored = history.fractions, history.residuals
    for k in range(1, len(history)):
        u, before = history.displacement(k), history.displacement(k - 1)
        ours = oracle.residual(u, before, fractions[k], fractions[k - 1])
        assert ours <= config.solver.tolerance * scale * 1.001, k
        assert stored[k] == pytest.approx(ours, rel=1e-3, abs=1e-10 * scale), k


def test_stored_residual_of_a_run_with_contact_is_the_largest_force(folded: History) -> None:
    assert_residuals(folded)


@pytest.mark.parametrize(
    "reading",
    [
        {"growth.out_of_plane": "none", "growth.law": "tangential", "growth.duration": 200.0},
        {"growth.energy_per": "reference", "growth.stretch": "exponential", "growth.duration": 200.0},
        {"material.stiffness_ratio": 2.0, "material.poisson_ratio_white": 0.3, "dissipation.number": 0.1},
        {"dissipation.kind": "none", "growth.duration": 100.0},
    ],
    ids=lambda reading: ",".join(map(str, reading.values())),
)
def test_stored_residual_is_the_largest_force_in_every_reading(tiny, reading: dict) -> None:
    from gyrify.run.simulation import simulate

    assert_residuals(simulate(tiny.replace(**reading)))
