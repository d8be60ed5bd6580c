"""Film on a half-space and bare half-space against exact references (incompressible unless nu is given)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gyrify.errors import ConfigError
from gyrify.theory.bilayer import Bilayer, Loading
from gyrify.theory.half_space import (
    asymptotic_wrinkle,
    critical_surface,
    critical_wrinkle,
    dispersion,
    neutral_curve,
)
from gyrify.theory.wave import half_space_stiffness, layered_stiffness, state_matrix

# stiffness ratio: (compression, L), (g along x, L), (g isotropic with z blocked, L); L / deformed thickness
TABLE = {
    1.54: ((0.3532, 4.47), (1.445, 3.96), (1.241, 4.41)),
    2.0: ((0.2986, 4.98), (1.371, 4.53), (1.206, 4.95)),
    3.0: ((0.2293, 5.91), (1.278, 5.44), (1.160, 5.79)),
    10.0: ((0.1052, 9.19), (1.119, 8.82), (1.074, 9.06)),
    100.0: ((0.0236, 20.1), (1.025, 19.9), (1.016, 20.1)),
}
TISSUE_RATIOS = (1 / 1.36, 1.0, 1.54, 2.0, 3.0, 10.0)
TISSUE = {
    "uniaxial": (1.731, 1.614, 1.463, 1.386, 1.290, 1.123),
    "isotropic": (1.385, 1.329, 1.258, 1.221, 1.172, 1.079),
}


def test_biot_surface_instability() -> None:
    """lambda = 0.54369 is the root of w^3 + w^2 + 3 w - 1 = 0, w = lambda^2 (Biot 1963)."""
    roots = np.roots([1.0, 1.0, 3.0, -1.0])
    exact = 1.0 - np.sqrt(roots[np.abs(roots.imag) < 1e-12].real[0])
    surface = critical_surface(Bilayer(loading="compression"))
    assert exact == pytest.approx(0.4563, abs=2e-4)
    assert surface.strain == pytest.approx(exact, abs=1e-10)
    assert surface.is_surface


def test_equal_layers_under_compression_have_no_wavelength() -> None:
    onset = critical_wrinkle(Bilayer(1.0, loading="compression"))
    assert onset.is_surface
    assert onset.strain == pytest.approx(0.4561, abs=3e-4)
    waves = neutral_curve(Bilayer(1.0, loading="compression"), [0.1, 1.0, 5.0])
    assert waves == pytest.approx(np.full(3, onset.load), rel=1e-9)


@pytest.mark.parametrize("ratio", TABLE)
def test_whole_bilayer_compressed(ratio: float) -> None:
    strain, wavelength = TABLE[ratio][0]
    onset = critical_wrinkle(Bilayer(ratio, loading="compression"))
    assert onset.strain == pytest.approx(strain, abs=2e-4)
    assert onset.wavelength == pytest.approx(wavelength, rel=0.03)


@pytest.mark.parametrize(("column", "loading"), [(1, "uniaxial"), (2, "isotropic")])
@pytest.mark.parametrize("ratio", TABLE)
def test_growing_film(ratio: float, column: int, loading: Loading) -> None:
    growth, wavelength = TABLE[ratio][column]
    onset = critical_wrinkle(Bilayer(ratio, loading=loading))
    assert onset.load == pytest.approx(growth, abs=2e-3)
    assert onset.wavelength == pytest.approx(wavelength, rel=0.03)


@pytest.mark.parametrize(
    ("loading", "growth", "wavelength"), [("uniaxial", 1.596, 3.08), ("isotropic", 1.309, 3.62)]
)
def test_growing_film_as_stiff_as_its_substrate(loading: Loading, growth: float, wavelength: float) -> None:
    onset = critical_wrinkle(Bilayer(1.0, loading=loading))
    assert onset.load == pytest.approx(growth, abs=2e-3)
    assert onset.wavelength == pytest.approx(wavelength, rel=0.03)


@pytest.mark.parametrize("loading", TISSUE)
def test_our_tissue(loading: Loading) -> None:
    found = [critical_wrinkle(Bilayer(ratio, 0.458, loading=loading)).load for ratio in TISSUE_RATIOS]
    assert found == pytest.approx(TISSUE[loading], abs=1e-3)


@pytest.mark.parametrize(("loading", "growth"), [("uniaxial", 1.810), ("isotropic", 1.486)])
def test_half_space_of_our_grown_tissue(loading: Loading, growth: float) -> None:
    assert critical_surface(Bilayer(1.0, 0.458, loading=loading)).load == pytest.approx(growth, abs=1e-3)


def test_large_contrast_limit() -> None:
    exact, limit = critical_wrinkle(Bilayer(1000.0, loading="compression")), asymptotic_wrinkle(1000.0)
    assert exact.strain == pytest.approx(limit.strain, rel=0.01)
    assert exact.wavelength == pytest.approx(limit.wavelength, rel=0.01)
    poor = critical_wrinkle(Bilayer(10.0, loading="compression"))
    assert abs(poor.strain / asymptotic_wrinkle(10.0).strain - 1.0) > 0.03


def test_nearly_incompressible_tissue_tends_to_the_incompressible_one() -> None:
    exact = critical_wrinkle(Bilayer(2.0))
    gaps = [critical_wrinkle(Bilayer(2.0, nu)).load - exact.load for nu in (0.499, 0.4999)]
    assert abs(gaps[1]) < 1e-4
    assert gaps[0] / gaps[1] == pytest.approx(10.0, rel=0.05)


def test_growth_across_the_film_changes_only_its_thickness() -> None:
    thin, thick = (critical_wrinkle(Bilayer(3.0, loading=loading)) for loading in ("tangential", "isotropic"))
    assert thin.load == pytest.approx(thick.load, rel=1e-9)
    assert thin.wavelength == pytest.approx(thick.wavelength, rel=1e-4)


def test_det_growth_in_the_energy_matters() -> None:
    """Per reference volume the grown film is softer by det F_g, so it folds later."""
    grown = critical_wrinkle(Bilayer(1.0, 0.458))
    reference = critical_wrinkle(Bilayer(1.0, 0.458, energy_per="reference"))
    assert grown.load == pytest.approx(1.329, abs=1e-3)
    assert reference.load > grown.load + 0.02


def test_a_growing_substrate_delays_folding() -> None:
    held = critical_wrinkle(Bilayer(2.0, 0.458))
    growing = critical_wrinkle(Bilayer(2.0, 0.458, growth_ratio=3.6))
    together = Bilayer(1.0, 0.458, growth_ratio=1.0)
    assert growing.load != pytest.approx(held.load, abs=5e-3)
    assert critical_wrinkle(together).load == pytest.approx(critical_surface(together).load, rel=1e-9)


def test_surface_stiffness_of_a_soft_elastic_half_space() -> None:
    """Without load: 2 mu (lambda + 2 mu) / (lambda + 3 mu) on the diagonal of an isotropic half-space."""
    mu, nu = 1.0, 0.3
    young = 2 * mu * (1 + nu)
    lame = young * nu / ((1 + nu) * (1 - 2 * nu))
    _, response = Bilayer(poisson_ratio=nu).state("film", np.array([1.0]))
    stiffness = half_space_stiffness(state_matrix(young * response.in_plane[0]))
    diagonal = 2 * mu * (lame + 2 * mu) / (lame + 3 * mu)
    assert np.diag(stiffness) == pytest.approx([diagonal, diagonal], rel=1e-9)
    assert stiffness == pytest.approx(stiffness.T)


@pytest.mark.parametrize("nu", [0.458, 0.5])
def test_a_film_of_the_same_tissue_is_no_film(nu: float) -> None:
    bilayer = Bilayer(1.0, nu, loading="compression")
    stiffness = bilayer.half_space("film", 1.4)[0]
    film = bilayer.matrices("film", 1.4)[0]
    for thickness in (0.1, 2.0, 30.0):
        assert layered_stiffness(film, stiffness, thickness) == pytest.approx(stiffness, rel=1e-6)


def test_a_thick_film_is_a_half_space() -> None:
    bilayer = Bilayer(30.0, 0.458)
    assert neutral_curve(bilayer, 12.0)[0] == pytest.approx(critical_surface(bilayer).load, rel=1e-3)
    curve = neutral_curve(bilayer, np.geomspace(0.5, 8.0, 12))
    assert np.all(np.diff(curve) > 0.0)


def test_dispersion_turns_negative_at_onset() -> None:
    bilayer = Bilayer(3.0, 0.458)
    onset = critical_wrinkle(bilayer)
    waves = onset.scaled_thickness * np.array([0.7, 1.0, 1.4])
    assert np.all(dispersion(bilayer, 1.0 + 0.98 * (onset.load - 1.0), waves) > 0.0)
    at_onset = dispersion(bilayer, onset.load, waves)
    assert at_onset[1] == pytest.approx(0.0, abs=1e-8)
    assert np.all(at_onset[[0, 2]] > 1e-4)


@pytest.mark.parametrize(
    "wrong",
    [{"stiffness_ratio": 0.0}, {"poisson_ratio": 0.6}, {"loading": "other"}, {"growth_ratio": -1.0}],
    ids=str,
)
def test_wrong_parameters_are_refused(wrong: dict) -> None:
    with pytest.raises(ConfigError):
        replace(Bilayer(), **wrong)
    with pytest.raises(ConfigError):
        dispersion(Bilayer(), 0.5, 1.0)
