"""Folding of the growing annulus: mode by mode, and at the surface."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gyrify.errors import ConfigError
from gyrify.theory import (
    Annulus,
    SecondVariation,
    base_state,
    critical_growth_ratio,
    critical_growth_time,
    critical_surface,
    crossings,
    lowest_eigenvalue,
    stability_map,
    stability_margin,
    surface_limit,
)
from gyrify.theory.bilayer import Bilayer
from gyrify.theory.moduli import compressible


@pytest.mark.parametrize(
    ("stiffness_ratio", "growth_ratio", "modes"), [(1.0, 1.760, (19, 20)), (1 / 1.36, 2.019, (21,))]
)
def test_critical_growth_ratio(stiffness_ratio: float, growth_ratio: float, modes: tuple[int, ...]) -> None:
    (found,) = critical_growth_ratio(Annulus(stiffness_ratio=stiffness_ratio), [1.5, 2.3])
    assert found.value == pytest.approx(growth_ratio, abs=2e-3)
    assert found.mode_number in modes
    assert found.becomes == "unstable"


@pytest.mark.parametrize("stiffness_ratio", [1 / 2.61, 1 / 3])
def test_soft_cortex_fails_at_the_surface_first(stiffness_ratio: float) -> None:
    annulus = Annulus(stiffness_ratio=stiffness_ratio)
    (found,) = critical_growth_ratio(annulus, [2.2, 2.8])
    assert found.mode_number is None
    assert found.wavelength == 0.0
    assert 2.5 < found.value < 2.6
    # Longer waves fail later, the shorter the earlier: any mesh delays the onset.
    margins = stability_map(annulus, "growth_ratio", [found.value], [40, 80, 160])[0]
    assert np.all(margins > 0.0)
    assert np.all(np.diff(margins) < 0.0)


def test_the_annulus_needs_its_physics() -> None:
    """The threshold moves by far more than the tolerance with the exponent, det F_g, or the z growth."""
    standard = Annulus()
    state = base_state(replace(standard, growth_ratio=1.76))
    assert abs(stability_margin(state).value) < 5e-3
    for change in ({"energy_per": "reference"}, {"out_of_plane": "none"}, {"stretch": "exponential"}):
        changed = replace(standard, growth_ratio=1.76, **change)
        assert abs(stability_margin(base_state(changed)).value) > 2e-2


def test_the_isochoric_exponent_matters() -> None:
    """A stress-free tissue under pure dilatation carries no isochoric stress, with J^(-2/3) only."""
    response = compressible(np.full((1, 3), 1.1), np.ones((1, 3)), np.array([1.0]), np.array([0.0]))
    assert response.stress == pytest.approx(np.zeros((1, 3)), abs=1e-12)
    assert response.energy == pytest.approx(0.0, abs=1e-12)


def test_tangent_is_the_derivative_of_the_energy() -> None:
    """Second differences of W of a full in-plane F, with growth, against the closed form."""
    growth, stretch, mu, kappa = np.array([1.2, 1.5, 1.4]), np.array([1.3, 1.1, 1.05]), 2.0, 9.0

    def energy(in_plane: np.ndarray) -> float:
        gradient = np.diag(stretch)
        gradient[[0, 1, 0, 1], [0, 1, 1, 0]] += in_plane
        elastic = gradient @ np.diag(1.0 / growth)
        jacobian = np.linalg.det(elastic)
        invariant = np.sum(elastic**2)
        density = 0.5 * mu * (jacobian ** (-2 / 3) * invariant - 3) + 0.5 * kappa * (jacobian - 1) ** 2
        return float(np.prod(growth) * density)

    step = 1e-4
    numeric = np.empty((4, 4))
    for i in range(4):
        for j in range(4):
            a, b = step * np.eye(4)[i], step * np.eye(4)[j]
            numeric[i, j] = energy(a + b) - energy(a - b) - energy(b - a) + energy(-a - b)
    numeric /= 4.0 * step**2
    exact = compressible(stretch[None], growth[None], np.array([mu]), np.array([kappa]))
    assert exact.in_plane[0] == pytest.approx(numeric, abs=1e-5)
    assert exact.energy[0] == pytest.approx(energy(np.zeros(4)))
    slope = [(energy(step * row) - energy(-step * row)) / (2 * step) for row in np.eye(4)[:2]]
    assert exact.stress[0, :2] == pytest.approx(slope, abs=1e-6)


def test_eigenvalues_do_not_depend_on_the_elements() -> None:
    annulus = Annulus(growth_ratio=1.9)
    for mode in (0, 1, 2, 19, 60):
        coarse, fine = (lowest_eigenvalue(replace(annulus, degree=d), 500.0, mode) for d in (12, 16))
        assert coarse == pytest.approx(fine, rel=1e-6, abs=1e-6)


def test_a_mode_reproduces_its_eigenvalue() -> None:
    """Rayleigh's quotient of the returned fields, integrated anew."""
    state = base_state(Annulus())
    mode = SecondVariation.of(state).mode(15)
    line, n = state.line, mode.number
    u, v = line.values @ mode.radial, line.values @ mode.circumferential
    du, dv = line.slopes @ mode.radial, line.slopes @ mode.circumferential
    gradient = np.stack([du, (u + n * v) / line.points, -(n * u + v) / line.points, dv], axis=1)
    area = line.weights * line.points
    work = np.einsum("q,qi,qij,qj->", area, gradient, state.response(line.points).in_plane, gradient)
    assert work / (area @ (u**2 + v**2)) == pytest.approx(mode.eigenvalue, rel=1e-8)
    assert mode.radial[0] == mode.circumferential[0] == 0.0
    assert mode.eigenvalue < 0.0


def test_large_rings_fold_like_a_film_on_a_half_space() -> None:
    """A thin cortex on white matter that does not grow, far from the centre: g = 1.258, kh = 0.744."""
    radius = 2e4
    ring = Annulus(radius - 40.0, radius, 1.0, stiffness_ratio=1.54, growth_ratio=1e9, degree=20)
    number = round(0.7437 * radius)
    found = [SecondVariation.of(base_state(ring, time)).lowest(number) for time in (128.0, 130.0)]
    assert found[0] > 0.0 > found[1]


def test_surface_limit_is_the_bare_half_space() -> None:
    """The contour's stiffness vanishes where a bare half-space of the same elastic stretch is critical."""
    (found,) = critical_growth_ratio(Annulus(stiffness_ratio=1 / 3), [2.2, 2.8])
    state = base_state(Annulus(stiffness_ratio=1 / 3, growth_ratio=found.value))
    assert surface_limit(state) == pytest.approx(0.0, abs=1e-5)
    bare = critical_surface(Bilayer(1.0, 0.458)).load
    # Not equal, for the elastic axial stretch is 1/2 here and 1/1.486 there.
    hoop = state.stretches(36.0)[0, 1] / 2.0
    assert hoop == pytest.approx(1.0 / bare, abs=0.15)


def test_growth_time_and_growth_ratio_agree() -> None:
    (time,) = critical_growth_time(Annulus(growth_ratio=3.6), [200.0, 300.0])
    (ratio,) = critical_growth_ratio(Annulus(), [3.4, 3.8], growth_time=time.value)
    assert ratio.value == pytest.approx(3.6, rel=1e-5)
    assert time.growth_time == time.value
    assert time.wavelength == pytest.approx(2 * np.pi * 40.0 / time.mode_number, rel=0.15)


def test_the_direction_of_a_crossing_is_reported() -> None:
    """A thicker cortex needs a larger growth ratio: 1.708 at 0.5 mm, 2.254 at 8 mm."""
    (found,) = crossings(Annulus(growth_ratio=1.77), "cortical_thickness", [0.5, 1.5, 4.0, 9.0])
    assert found.becomes == "stable"
    assert 1.5 < found.value < 2.0
    assert replace(Annulus(), cortical_thickness=found.value).interface_radius == pytest.approx(34.3, abs=0.1)


def test_stress_and_tangent_do_not_see_a_rotation() -> None:
    """Rotating the state costs nothing: H A H = P F for H = W F with the unit skew W."""
    state = base_state(Annulus())
    places = np.array([19.0, 30.0, 35.0])
    response, stretch = state.response(places), state.stretches(places)
    rotation = np.stack([np.zeros(3), np.zeros(3), -stretch[:, 1], stretch[:, 0]], axis=1)
    second = np.einsum("qi,qij,qj->q", rotation, response.in_plane, rotation)
    assert second == pytest.approx(np.sum(response.stress[:, :2] * stretch[:, :2], axis=1), rel=1e-12)


def test_nothing_critical_is_no_crossing() -> None:
    assert critical_growth_ratio(Annulus(), [1.0, 1.4]) == ()


def test_wrong_requests_are_refused() -> None:
    with pytest.raises(ConfigError):
        crossings(Annulus(), "growth_ratio", [2.0, 1.0])
    with pytest.raises(ConfigError):
        lowest_eigenvalue(Annulus(), 500.0, -1)
    with pytest.raises(ConfigError):
        lowest_eigenvalue(Annulus(), -1.0, 5)
