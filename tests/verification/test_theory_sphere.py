"""The growing sphere: its state and modes against the energy itself, rigid motions, and the flat limit."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from numpy.polynomial import legendre
from scipy.optimize import brentq

from gyrify.errors import ConfigError
from gyrify.theory import (
    Bilayer,
    Sphere,
    SphericalVariation,
    critical_growth_time,
    critical_wrinkle,
    sphere_state,
)

SOLID = Sphere(law="tangential", growth_ratio=5.0, stiffness_ratio=1.5)
HOLLOW = Sphere(inner_radius=15.0, hole="free", growth_ratio=3.0, stretch="exponential")
CLAMPED = Sphere(inner_radius=18.0, law="tangential", energy_per="reference", cortical_thickness=4.0)


def energy(sphere: Sphere, points: np.ndarray, weights: np.ndarray, F: np.ndarray, time: float) -> float:
    """4 pi int W R^2 dR of deformation gradients (n_radii, n_angles, 3, 3), by the formula of W alone."""
    grown = sphere.growth(points, time)[:, None, None, :]
    grey = points >= sphere.interface_radius
    young = np.where(grey, sphere.young_modulus, sphere.young_modulus / sphere.stiffness_ratio)[:, None]
    mu, kappa = young / (2 * (1 + sphere.poisson_ratio)), young / (3 * (1 - 2 * sphere.poisson_ratio))
    F_e = F / grown
    J, I1 = np.linalg.det(F_e), np.sum(F_e * F_e, axis=(2, 3))
    W = 0.5 * mu * (J ** (-2 / 3) * I1 - 3) + 0.5 * kappa * (J - 1) ** 2
    if sphere.energy_per == "grown":
        W = W * np.prod(grown, axis=-1)[:, 0]
    return float(np.sum(weights * W))


def perturbed(sphere: Sphere, time: float, degree: int, fields: np.ndarray, step: float) -> float:
    """Energy of the state plus ``step`` times U P e_r + V P' e_theta + W P' e_phi, P = P_l(cos theta)."""
    state, line = sphere_state(sphere, time), sphere.line()
    cosine, weight = legendre.leggauss(2 * degree + 24)
    sine = np.sqrt(1 - cosine**2)
    P, dP = (
        legendre.legval(cosine, legendre.legder([0] * degree + [1], k))
        if k
        else legendre.legval(cosine, [0] * degree + [1])
        for k in (0, 1)
    )
    d2P = legendre.legval(cosine, legendre.legder([0] * degree + [1], 2))
    slope, curved = -sine * dP, sine**2 * d2P - cosine * dP  # by theta
    R = line.points[:, None]
    (U, V, W), (dU, dV, dW) = (
        [step * (matrix @ field)[:, None] for field in fields] for matrix in (line.values, line.slopes)
    )
    stretch = state.stretches(line.points)
    F = np.zeros((len(line.points), len(cosine), 3, 3))
    F[..., 0, 0] = stretch[:, :1] + dU * P
    F[..., 0, 1] = (U - V) / R * slope
    F[..., 1, 0] = dV * slope
    F[..., 1, 1] = stretch[:, 1:2] + (U * P + V * curved) / R
    F[..., 2, 2] = stretch[:, 1:2] + (U * P + V * slope * cosine / sine) / R
    F[..., 2, 0], F[..., 0, 2] = dW * slope, -W / R * slope
    F[..., 1, 2], F[..., 2, 1] = -W / R * slope * cosine / sine, W / R * curved
    area = 2 * np.pi * weight[None] * (line.weights * line.points**2)[:, None]
    return energy(sphere, line.points, area, F, time)


@pytest.mark.parametrize("sphere", [SOLID, HOLLOW, CLAMPED], ids=["solid", "hollow", "clamped"])
@pytest.mark.parametrize(
    ("kind", "degree"), [*product(["spheroidal"], [0, 1, 2, 5]), *product(["toroidal"], [1, 2, 5])]
)
def test_second_variation_is_that_of_the_energy(sphere: Sphere, degree: int, kind: str) -> None:
    time, line = 300.0, sphere.line()
    x = line.nodes / sphere.outer_radius
    rise = x**2 * (x - sphere.inner_radius / sphere.outer_radius)
    fields = np.zeros((3, len(x)))
    if kind == "spheroidal":
        fields[:2] = rise * (1 + x), rise * np.cos(3 * x) * (degree > 0)
    else:
        fields[2] = rise * np.sin(2 + x)
    h = 2e-3
    found = [perturbed(sphere, time, degree, fields, step) for step in (-h, 0.0, h)]
    second = (found[0] - 2 * found[1] + found[2]) / h**2
    variation = SphericalVariation.of(sphere_state(sphere, time))
    held, L = int(sphere.is_held), degree * (degree + 1)
    U, V, W = (variation.root.T @ field[held:] for field in fields)
    if kind == "toroidal":
        expected = L * W @ variation.twist(degree) @ W
    else:
        vector = np.concatenate([U, np.sqrt(L) * V]) if degree else U
        expected = vector @ variation.matrix(degree) @ vector
    assert second == pytest.approx(4 * np.pi / (2 * degree + 1) * expected, rel=2e-5)


@pytest.mark.parametrize("sphere", [SOLID, HOLLOW], ids=["solid", "hollow"])
def test_moving_as_a_whole_costs_nothing_and_is_left_out(sphere: Sphere) -> None:
    variation = SphericalVariation.of(sphere_state(sphere, 300.0))
    translation, rotation = variation._rigid()
    for matrix, motion in ((variation.matrix(1), translation), (variation.twist(1), rotation)):
        assert motion @ matrix @ motion == pytest.approx(
            0.0, abs=1e-9 * np.linalg.norm(matrix) * motion @ motion
        )
        assert np.abs(np.linalg.eigvalsh(matrix)).min() < 1e-6 * sphere.young_modulus
    assert variation.lowest(1) > 1e-3 * sphere.young_modulus / sphere.outer_radius**2


def test_state_is_in_balance_and_has_the_least_energy() -> None:
    for sphere in (SOLID, HOLLOW, CLAMPED):
        state = sphere_state(sphere, 400.0)
        assert state.residual < 1e-9
        # the free surface carries no load
        surface = state.response(sphere.outer_radius).stress[0, 0]
        assert abs(surface) < 1e-6 * sphere.young_modulus
        x = (state.line.nodes - sphere.inner_radius) / sphere.outer_radius
        for other in (1e-3 * x, -1e-3 * x**2):
            moved = replace(state, displacement=state.displacement + other)
            assert moved.energy > state.energy


def test_size_and_stiffness_change_nothing_but_units() -> None:
    """A millionfold larger or smaller sphere, or a stiffer one, is as near to its equilibrium."""
    state = sphere_state(SOLID, 400.0)
    for scale in (1e-6, 1e6):
        size = {"outer_radius": 36.0 * scale, "cortical_thickness": 1.5 * scale, "young_modulus": 9e3 / scale}
        other = sphere_state(replace(SOLID, **size), 400.0)
        assert other.residual < 1e-9
        assert other.displacement / scale == pytest.approx(state.displacement, rel=1e-7, abs=1e-9)


def test_uniform_growth_of_a_free_sphere_is_free_of_stress() -> None:
    sphere = Sphere(growth_ratio=1.0)
    state = sphere_state(sphere, 300.0)
    assert state.radius(np.array([10.0, 36.0])) == pytest.approx([16.0, 57.6], rel=1e-10)
    assert state.energy == pytest.approx(0.0, abs=1e-9 * sphere.young_modulus)
    variation = SphericalVariation.of(state)
    assert min(variation.lowest(degree) for degree in (0, 1, 2, 9, 40)) > 0.0


def critical_growth(sphere: Sphere, degrees: range) -> float:
    """Growth strain at which the first of the degrees loses stability."""

    def lowest(strain: float) -> float:
        variation = SphericalVariation.of(sphere_state(sphere, strain / sphere.growth_rate))
        return min(variation.lowest(degree) for degree in degrees)

    return float(brentq(lowest, 0.05, 0.6, xtol=1e-6))


def test_a_thin_cortex_folds_as_a_film_on_a_half_space_that_is_held_at_its_sides() -> None:
    """A large solid sphere holds its cortex along both tangents: growth with z blocked."""
    flat = critical_wrinkle(Bilayer(stiffness_ratio=3.0, poisson_ratio=0.458, loading="isotropic"))
    errors = []
    for thickness in (0.72, 0.18):
        sphere = Sphere(cortical_thickness=thickness, growth_ratio=np.inf, stiffness_ratio=3.0)
        degree = 2 * np.pi * sphere.outer_radius / (flat.wavelength * thickness * flat.load)
        around = range(int(0.7 * degree), int(1.5 * degree), max(1, int(degree / 30)))
        errors.append(abs(critical_growth(sphere, around) / (flat.load - 1.0) - 1.0))
    assert errors[1] < 0.02
    assert errors[1] < 0.5 * errors[0]


@pytest.mark.parametrize("sphere", [Sphere(), Sphere(inner_radius=18.0, law="tangential")])
def test_onset_is_where_one_degree_becomes_soft_and_no_other_is(sphere: Sphere) -> None:
    (crossing,) = critical_growth_time(sphere, [150.0, 250.0, 350.0])
    variation = SphericalVariation.of(sphere_state(sphere, crossing.growth_time))
    degree = crossing.mode_number
    assert crossing.becomes == "unstable"
    assert abs(variation.lowest(degree)) < 1e-5 * variation.lowest(2)
    assert all(variation.lowest(other) > 0.0 for other in (0, 1, 2, degree - 1, degree + 1, 3 * degree))
    r = float(variation.state.radius(sphere.outer_radius))
    assert crossing.wavelength == pytest.approx(2 * np.pi * r / np.sqrt(degree * (degree + 1)))
    after = SphericalVariation.of(sphere_state(sphere, 1.01 * crossing.growth_time))
    assert after.lowest(degree) < 0.0


@pytest.mark.parametrize(
    ("ratio", "law", "time", "degree"),
    [(1.0, "isotropic", 295.63, 18), (1.0, "tangential", 272.55, 29), (10.0, "tangential", 66.71, 15)],
)
def test_onset_of_the_documented_spheres(ratio: float, law: str, time: float, degree: int) -> None:
    (crossing,) = critical_growth_time(Sphere(stiffness_ratio=ratio, law=law), [0.9 * time, 1.1 * time])
    assert (crossing.value, crossing.mode_number) == (pytest.approx(time, abs=0.006), degree)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("young_modulus", np.inf),
        ("inner_radius", -1.0),
        ("inner_radius", 34.5),
        ("growth_ratio", 0.0),
        ("hole", "glued"),
        ("poisson_ratio", 0.5),
    ],
)
def test_values_out_of_bounds_are_refused(field: str, value: object) -> None:
    with pytest.raises(ConfigError):
        Sphere(**{field: value})  # type: ignore[arg-type]
    with pytest.raises(ConfigError, match="not negative"):
        sphere_state(SOLID, -1.0)
