"""The axisymmetric state of the growing annulus against what is known exactly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gyrify.errors import ConfigError
from gyrify.theory.annulus import Annulus, base_state
from gyrify.theory.moduli import growth_stretch

READINGS = [
    {},
    {"out_of_plane": "none"},
    {"out_of_plane": "generalised"},
    {"stretch": "exponential"},
    {"energy_per": "reference"},
    {"law": "tangential"},
    {"growth_ratio": 1.0},
    {"stiffness_ratio": 1 / 3, "cortical_thickness": 8.0},
]


@pytest.mark.parametrize("reading", READINGS, ids=str)
def test_the_state_does_not_depend_on_the_elements(reading: dict) -> None:
    annulus = Annulus(**reading)
    coarse, fine = (base_state(replace(annulus, degree=degree)) for degree in (12, 17))
    places = np.linspace(18.0, 36.0, 301)
    assert np.max(np.abs(coarse.radius(places) - fine.radius(places))) < 1e-8
    assert coarse.energy == pytest.approx(fine.energy, rel=1e-11)
    assert coarse.radius(18.0) == pytest.approx(18.0, abs=1e-12)


@pytest.mark.parametrize("reading", READINGS, ids=str)
def test_stress_is_in_balance(reading: dict) -> None:
    """(R P_1)' = P_2 between any two radii of one tissue, and P_1 = 0 on the free contour."""
    state = base_state(Annulus(**reading, degree=16))
    scale = state.annulus.young_modulus
    assert abs(state.response(36.0).stress[0, 0]) < 1e-7 * scale
    interface = state.annulus.interface_radius
    for a, b in [(20.0, interface - 0.1), (interface + 0.1, 35.9)]:
        place, weight = np.polynomial.legendre.leggauss(60)
        along = state.response(0.5 * (a + b) + 0.5 * (b - a) * place).stress[:, 1]
        across = state.response([a, b]).stress[:, 0]
        assert 0.5 * (b - a) * weight @ along == pytest.approx(
            b * across[1] - a * across[0], abs=1e-5 * scale
        )
    below, above = state.response([interface - 1e-9, interface]).stress[:, 0]
    assert below == pytest.approx(above, abs=1e-5 * scale)


def test_generalised_plane_strain_carries_no_axial_force() -> None:
    state = base_state(Annulus(out_of_plane="generalised"))
    line = state.line
    axial = line.weights * line.points * state.response(line.points).stress[:, 2]
    assert abs(axial.sum()) < 1e-9 * np.abs(axial).sum()
    assert 1.2 < state.axial_stretch < 2.0


def test_no_growth_is_no_displacement_and_no_energy() -> None:
    state = base_state(Annulus(), 0.0)
    assert state.radius([18.0, 30.0, 36.0]) == pytest.approx([18.0, 30.0, 36.0], abs=1e-12)
    assert abs(state.energy) < 1e-6


def test_small_growth_is_the_linear_thermoelastic_solution() -> None:
    """Lame's r = a R + b / R under a uniform eigenstrain e in the plane and in z, F_33 = 1."""
    strain, nu = 1e-6, 0.3
    annulus = Annulus(growth_ratio=1.0, poisson_ratio=nu)
    displacement = base_state(annulus, strain / annulus.growth_rate).radius(36.0) - 36.0
    # u = a R + b/R; u(18) = 0; sigma_RR(36) = 0 with sigma_RR ~ a/(1 - 2 nu) - b/R^2 - (1 + nu) e/(1 - 2 nu).
    matrix = np.array([[18.0, 1 / 18.0], [1 / (1 - 2 * nu), -1 / 36.0**2]])
    a, b = np.linalg.solve(matrix, [0.0, (1 + nu) * strain / (1 - 2 * nu)])
    assert displacement == pytest.approx(36.0 * a + b / 36.0, rel=1e-5)


def test_the_state_minimises_the_energy() -> None:
    """A small bump raises the energy, by the same amount in either sense."""
    state = base_state(Annulus())
    line, annulus = state.line, state.annulus
    bump = np.sin(np.pi * (line.nodes - 18.0) / 36.0)
    values, slopes = line.values @ bump, line.slopes @ bump

    def energy(amount: float) -> float:
        stretch = state.stretches(line.points)
        stretch[:, 0] += amount * slopes
        stretch[:, 1] += amount * values / line.points
        psi = annulus.response(line.points, stretch, state.growth_time).energy
        return float(2 * np.pi * (line.weights * line.points) @ psi)

    assert energy(1e-3) > state.energy
    assert energy(-1e-3) > state.energy
    assert abs(energy(1e-3) - energy(-1e-3)) < 1e-3 * (energy(1e-3) + energy(-1e-3) - 2 * energy(0.0))


def test_energy_per_grown_volume_carries_det_growth() -> None:
    annulus = Annulus(growth_ratio=1.0)
    grown, reference = (base_state(replace(annulus, energy_per=per)) for per in ("grown", "reference"))
    assert grown.energy == pytest.approx(8.0 * reference.energy, rel=1e-9)
    plane = replace(annulus, out_of_plane="none")
    flat, reference = (base_state(replace(plane, energy_per=per)) for per in ("grown", "reference"))
    assert flat.energy == pytest.approx(4.0 * reference.energy, rel=1e-9)


def test_growth_laws() -> None:
    assert growth_stretch(0.002, 500.0, "linear") == pytest.approx(2.0)
    assert growth_stretch(0.002, 500.0, "exponential") == pytest.approx(np.e)
    growth = Annulus(law="tangential").growth([20.0, 35.0], 500.0)
    assert growth == pytest.approx(np.array([[1 + 1 / 3.6] * 3, [1.0, 2.0, 2.0]]))


@pytest.mark.parametrize(
    "wrong",
    [
        {"inner_radius": -1.0},
        {"cortical_thickness": 18.0},
        {"poisson_ratio": 0.5},
        {"poisson_ratio_white": -1.0},
        {"growth_ratio": 0.0},
        {"stiffness_ratio": float("nan")},
        {"law": "other"},
    ],
    ids=str,
)
def test_wrong_parameters_are_refused(wrong: dict) -> None:
    with pytest.raises(ConfigError):
        Annulus(**wrong)
