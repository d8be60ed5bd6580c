"""Growth along z as a power of that in the plane: F_g,33 = λ_g^s."""

from __future__ import annotations

import numpy as np
import pytest

from gyrify.config import Config
from gyrify.errors import ConfigError
from gyrify.mesh import GREY
from gyrify.model.slice import Slice
from gyrify.physics.growth import out_of_plane_growth
from gyrify.run.simulation import simulate
from gyrify.run.validity.exact_bodies import annulus_of
from gyrify.run.validity.expected import expected_onset
from gyrify.theory import Annulus, base_state

STRETCH = np.array([1.0, 1.3, 2.0])


def test_the_entry_is_a_power_of_the_growth_stretch() -> None:
    for reading in ("blocked", "generalised"):
        np.testing.assert_array_equal(out_of_plane_growth(STRETCH, reading), STRETCH)
        np.testing.assert_allclose(
            out_of_plane_growth(STRETCH, reading, 0.13), np.exp(0.13 * np.log(STRETCH))
        )
        np.testing.assert_array_equal(out_of_plane_growth(STRETCH, reading, 0.0), 1.0)
    np.testing.assert_array_equal(out_of_plane_growth(STRETCH, "none"), 1.0)


@pytest.mark.parametrize("law", ["isotropic", "tangential"])
def test_the_volume_grows_by_two_and_s_powers(tiny: Config, law: str) -> None:
    config = tiny.with_overrides({"growth.out_of_plane_exponent": 0.4, "growth.law": law})
    problem, time = Slice(config), 350.0
    grey = problem.mesh.region[problem.simplices.cell] == GREY
    assert grey.any()
    assert not grey.all()
    stretch = 1.0 + time * np.where(grey, config.growth.rate, config.growth.rate_white)
    powers = np.where(grey & (law == "tangential"), 1.4, 2.4)
    np.testing.assert_allclose(problem.volume_growth(time), stretch**powers)


def test_energy_at_rest_is_that_of_cells_squeezed_by_their_growth(tiny: Config) -> None:
    """F = 1, so F_e = diag(1/λ, 1/λ, λ^-s); W = μ/2 (I₁ J_e^(-2/3) - 3) + κ/2 (J_e - 1)², times J_g."""
    s, time = 0.3, 400.0
    config = tiny.with_overrides({"growth.out_of_plane_exponent": s})
    problem = Slice(config)
    stretch = 1.0 + time * problem.growth.rate
    J_g = stretch ** (2.0 + s)
    invariant = 2.0 / stretch**2 + stretch ** (-2.0 * s)
    W = (
        0.5 * problem.parameters[0] * (invariant * J_g ** (2.0 / 3.0) - 3.0)
        + 0.5 * problem.bulk_modulus * (1.0 / J_g - 1.0) ** 2
    )
    u = np.zeros(problem.state_shape)
    energy = problem.elastic_energy(problem.kinematics(time)).evaluate(u, 0).value
    assert energy == pytest.approx(float(np.sum(J_g * W * problem.simplices.volumes)), rel=1e-12)


def test_no_power_is_no_growth_along_z(tiny: Config) -> None:
    short = tiny.with_overrides({"solver.increments": 4, "stability.detect": False})
    power = simulate(short.with_overrides({"growth.out_of_plane_exponent": 0.0}))
    none = simulate(short.with_overrides({"growth.out_of_plane": "none"}))
    np.testing.assert_array_equal(power.displacement(), none.displacement())
    R = np.linspace(18.0, 36.0, 7)
    radii = [
        base_state(annulus, 400.0).radius(R)
        for annulus in (Annulus(out_of_plane_exponent=0.0), Annulus(out_of_plane="none"))
    ]
    np.testing.assert_array_equal(*radii)


def test_the_default_changes_no_hash() -> None:
    config = Config()
    assert config.config_hash.startswith("70e224fd81e3")
    assert config.replace(**{"growth.out_of_plane_exponent": 1.0}).config_hash == config.config_hash
    assert config.replace(**{"growth.out_of_plane_exponent": 0.5}).config_hash != config.config_hash


def test_a_power_of_no_growth_is_refused_and_the_advice_works(tiny: Config) -> None:
    changes = {"growth.out_of_plane": "none", "growth.out_of_plane_exponent": 0.5}
    with pytest.raises(ConfigError, match=r"out_of_plane_exponent = 0\.5 is not allowed") as caught:
        tiny.with_overrides(changes)
    assert 'growth.out_of_plane = "blocked"' in str(caught.value)
    tiny.with_overrides({**changes, "growth.out_of_plane": "blocked"})
    with pytest.raises(ConfigError):
        tiny.with_overrides({"growth.out_of_plane_exponent": -0.1})
    with pytest.raises(ConfigError, match="0 or more"):
        Annulus(out_of_plane_exponent=-0.1)


def test_theory_knows_the_power_on_a_ring_and_says_that_it_has_none_on_a_strip(tiny: Config) -> None:
    config = tiny.with_overrides({"growth.out_of_plane_exponent": 0.5})
    assert annulus_of(config).out_of_plane_exponent == 0.5
    strip = config.with_overrides({"geometry.shape": "strip"})
    assert "out_of_plane_exponent" in expected_onset(strip).not_covered
