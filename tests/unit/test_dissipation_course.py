"""Dissipation that is reduced in proportion to the growth that is left."""

from __future__ import annotations

import numpy as np
import pytest

from gyrify.config import Config
from gyrify.energy.viscous import DragEnergy, KelvinVoigtEnergy, reduction
from gyrify.model.slice import Slice
from gyrify.run.simulation import simulate
from gyrify.solve.problem import State


@pytest.mark.parametrize(
    ("fraction", "left"), [(0.01, 0.99), (0.5, 0.5), (0.9, 0.1), (0.9995, 1e-3), (1.0, 1e-3)]
)
def test_what_is_left_of_the_coefficient(fraction: float, left: float) -> None:
    assert reduction("constant", fraction) == 1.0
    assert reduction("reduced", fraction) == pytest.approx(left, rel=1e-12)


@pytest.mark.parametrize("kind", ["drag", "kelvin_voigt"])
def test_the_energy_of_an_increment_is_reduced_by_growth_at_its_end(tiny: Config, kind: str) -> None:
    values, rng = [], np.random.default_rng(5)
    u = 1e-3 * rng.standard_normal(Slice(tiny).state_shape)
    for course in ("constant", "reduced"):
        problem = Slice(tiny.with_overrides({"dissipation.kind": kind, "dissipation.course": course}))
        start = State.reference(*problem.state_shape)
        terms = problem.energy(0.8, start, 0.7).terms
        (term,) = [term for term in terms if isinstance(term, DragEnergy | KelvinVoigtEnergy)]
        values.append(term.evaluate(u, 0).value)
    assert values[0] > 0.0
    assert values[1] == pytest.approx(0.2 * values[0], rel=1e-12)


def test_the_last_state_is_almost_an_equilibrium_of_the_tissue(tiny: Config) -> None:
    """With the same drag to the end, letting go moves the slice much further."""
    moved = {}
    for course in ("constant", "reduced"):
        history = simulate(tiny.with_overrides({"dissipation.course": course, "dissipation.number": 2.6}))
        assert history.relaxed is not None
        moved[course] = history.relaxed.moved_mm
    assert moved["reduced"] < 0.2 * moved["constant"]


def test_the_default_changes_no_hash() -> None:
    config = Config()
    assert config.replace(**{"dissipation.course": "constant"}).config_hash == config.config_hash
    assert config.replace(**{"dissipation.course": "reduced"}).config_hash != config.config_hash
