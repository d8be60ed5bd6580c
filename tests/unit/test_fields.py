"""Fields of a state against hand arithmetic."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from gyrify.config import Config
from gyrify.config.run_sections import ALL_FIELDS
from gyrify.errors import HistoryError
from gyrify.metrics.curvature import curvature
from gyrify.model.slice import Slice
from gyrify.physics.materials import NEO_HOOKEAN
from gyrify.physics.stress import first_piola
from gyrify.store import History
from gyrify.store.fields import (
    CONTOUR_FIELDS,
    UNITS,
    FieldMaker,
    fields,
)
from gyrify.store.state_fields import POINT_FIELDS, StateFields

SMALL = {"mesh.n_around": 48, "mesh.n_layers": 6, "mesh.n_cortex_layers": 2}


def problem(**overrides: object) -> Slice:
    return Slice(Config.preset("reference-slice").with_overrides({**SMALL, **overrides}))


def state(slice_: Slice, u: np.ndarray, fraction: float) -> StateFields:
    return FieldMaker(slice_).state(u, fraction, u)


def stretched(slice_: Slice, F: np.ndarray) -> np.ndarray:
    """Displacement of a uniform deformation gradient."""
    return slice_.mesh.points @ (F - np.eye(2)).T


def test_uniaxial_stretch_without_growth():
    slice_ = problem(**{"material.stiffness_ratio": 1.0})
    got = state(slice_, stretched(slice_, np.diag([1.2, 1.0])), 0.0)
    mu, kappa = 9210.87 / (2 * 1.458), 9210.87 / (3 * (1 - 2 * 0.458))
    # sigma_i = mu J^(-5/3) (lambda_i^2 - I1/3) + kappa (J - 1), J = 1.2, I1 = 1.44 + 1 + 1
    deviator, pressure = mu * 1.2 ** (-5 / 3) * np.array([1.44 - 3.44 / 3, 1 - 3.44 / 3]), kappa * 0.2
    sigma = got["cauchy_stress"]
    assert got["J"] == pytest.approx(1.2, rel=1e-12)
    assert got["J_elastic"] == pytest.approx(1.2, rel=1e-12)
    assert got["J_growth"] == pytest.approx(1.0, rel=1e-12)
    assert sigma[:, 0, 0] == pytest.approx(deviator[0] + pressure, rel=1e-9)
    assert sigma[:, 1, 1] == pytest.approx(deviator[1] + pressure, rel=1e-9)
    assert sigma[:, 2, 2] == pytest.approx(deviator[1] + pressure, rel=1e-9)
    assert np.abs(sigma[:, [0, 0, 1], [1, 2, 2]]).max() < 1e-6
    assert got["mean_stress"] == pytest.approx(pressure, rel=1e-9)
    assert got["von_mises"] == pytest.approx(deviator[0] - deviator[1], rel=1e-9)


def test_simple_shear_of_an_incompressible_state_gives_the_shear_stress_by_hand():
    slice_ = problem()
    got = state(slice_, stretched(slice_, np.array([[1.0, 0.3], [0.0, 1.0]])), 0.0)
    mu = 9210.87 / (2 * 1.458)
    # F F^T = [[1.09, 0.3], [0.3, 1]], J = 1: sigma_12 = 0.3 mu, sigma_11 - sigma_22 = 0.09 mu
    sigma = got["cauchy_stress"]
    assert sigma[:, 0, 1] == pytest.approx(0.3 * mu, rel=1e-9)
    assert sigma[:, 1, 0] == pytest.approx(0.3 * mu, rel=1e-9)
    assert sigma[:, 0, 0] - sigma[:, 1, 1] == pytest.approx(0.09 * mu, rel=1e-9)
    assert got["von_mises"] == pytest.approx(mu * np.sqrt(0.09**2 + 3 * 0.09), rel=1e-9)


def test_free_growth_in_the_plane_has_no_stress():
    slice_ = problem(**{"growth.out_of_plane": "none", "growth.ratio": 1.0})
    got = state(slice_, 0.6 * slice_.mesh.points, 0.6)  # lambda_g = 1 + 0.002 * 300
    assert got["growth_stretch"] == pytest.approx(1.6, rel=1e-12)
    assert got["J_growth"] == pytest.approx(2.56, rel=1e-12)
    assert got["J"] == pytest.approx(2.56, rel=1e-9)
    assert got["J_elastic"] == pytest.approx(1.0, rel=1e-9)
    for name in ("cauchy_stress", "von_mises", "mean_stress", "circumferential_stress"):
        assert np.abs(got[name]).max() < 1e-8 * 9210.87, name


def test_fully_constrained_blocked_growth_is_under_hydrostatic_pressure():
    slice_ = problem(**{"growth.ratio": 2.0})
    got = state(slice_, np.zeros((slice_.mesh.n_points, 2)), 1.0)
    grey = slice_.mesh.region == 1
    stretch = np.where(grey, 2.0, 1.5)
    assert got["growth_stretch"] == pytest.approx(stretch, rel=1e-12)
    assert got["J_growth"] == pytest.approx(stretch**3, rel=1e-12)
    # F_e = I / lambda_g in all three directions: sigma = kappa (lambda_g^-3 - 1) I
    pressure = slice_.bulk_modulus * (stretch**-3 - 1.0)
    assert got["mean_stress"] == pytest.approx(pressure, rel=1e-9)
    assert got["circumferential_stress"] == pytest.approx(pressure, rel=1e-9)
    assert np.abs(got["von_mises"]).max() < 1e-8 * 9210.87


@pytest.mark.parametrize("law", ["isotropic", "tangential"])
@pytest.mark.parametrize("out_of_plane", ["blocked", "none"])
def test_stress_is_that_of_the_first_piola_stress(law, out_of_plane, rng):
    slice_ = problem(**{"growth.law": law, "growth.out_of_plane": out_of_plane})
    u = 0.02 * rng.standard_normal((slice_.mesh.n_points, 2))
    got = state(slice_, u, 0.3)
    kinematics = slice_.kinematics(150.0)
    F_e = kinematics.deformation(u)
    P, P33 = first_piola(NEO_HOOKEAN, F_e, kinematics.f33, slice_.parameters)
    J_e = np.linalg.det(F_e) * kinematics.f33
    sigma = got["cauchy_stress"]
    expected = P @ np.swapaxes(F_e, 1, 2) / J_e[:, None, None]
    assert sigma[:, :2, :2] == pytest.approx(expected, rel=1e-9, abs=1e-6)
    assert sigma[:, 2, 2] == pytest.approx(P33 * kinematics.f33 / J_e, rel=1e-9, abs=1e-6)
    assert got["J_elastic"] == pytest.approx(J_e, rel=1e-12)
    assert got["J_growth"] == pytest.approx(kinematics.J_g, rel=1e-12)
    assert got["J"] == pytest.approx(got["J_elastic"] * got["J_growth"], rel=1e-12)


def test_von_mises_is_zero_for_a_sphere_of_stress_and_unchanged_by_rotation(rng):
    slice_ = problem()
    u = 0.02 * rng.standard_normal((slice_.mesh.n_points, 2))
    c, s = np.cos(0.7), np.sin(0.7)
    Q = np.array([[c, -s], [s, c]])
    rotated = (slice_.mesh.points + u) @ Q.T - slice_.mesh.points
    one, other = state(slice_, u, 0.2), state(slice_, rotated, 0.2)
    for name in ("J", "J_elastic", "von_mises", "mean_stress", "circumferential_stress"):
        assert other[name] == pytest.approx(one[name], rel=1e-9, abs=1e-6), name
    turned = Q @ one["cauchy_stress"][:, :2, :2] @ Q.T
    assert other["cauchy_stress"][:, :2, :2] == pytest.approx(turned, rel=1e-9, abs=1e-6)


def test_circumferential_direction_is_perpendicular_to_the_pushed_forward_normal(rng):
    slice_ = problem()
    u = 0.02 * rng.standard_normal((slice_.mesh.n_points, 2))
    got = state(slice_, u, 0.2)
    F = np.moveaxis(FieldMaker(slice_).deformation(u), 2, 0)
    normal = np.linalg.solve(np.swapaxes(F, 1, 2), slice_.mesh.across[:, :, None])[:, :, 0]
    tangent = np.stack([-normal[:, 1], normal[:, 0]], axis=1)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    sigma = got["cauchy_stress"][:, :2, :2]
    expected = np.einsum("ci,cij,cj->c", tangent, sigma, tangent)
    assert got["circumferential_stress"] == pytest.approx(expected, rel=1e-9, abs=1e-6)


def test_stresses_integrate_to_the_gradient_of_the_elastic_energy(folded: History):
    slice_, u = folded.slice, folded.displacement()
    got = fields(folded)
    time = float(folded.growth_times[-1])
    gradient = slice_.elastic_energy(slice_.kinematics(time)).evaluate(u, 1).gradient
    # force on a node: integral over the current area of sigma grad_x N, grad_x N = F^-T grad_X N
    F = np.moveaxis(FieldMaker(slice_).deformation(u), 2, 0)
    slopes = np.einsum("cai,cij->caj", slice_.simplices.gradients, np.linalg.inv(F))
    current = slice_.simplices.volumes * got["J"]
    per_node = np.einsum("c,cij,caj->cai", current, got["cauchy_stress"][:, :2, :2], slopes)
    force = np.zeros_like(u)
    np.add.at(force, slice_.mesh.cells, per_node)
    assert gradient is not None
    assert np.abs(force - gradient).max() < 1e-9 * np.abs(per_node).max()


def test_contact_forces_balance_and_live_on_the_contour(folded: History):
    force = fields(folded, -1, ["contact_force"])["contact_force"]
    size = np.abs(force).max()
    assert size > 1.0
    assert np.abs(force.sum(axis=0)).max() < 1e-9 * size
    x = folded.points()
    moment = x[:, 0] * force[:, 1] - x[:, 1] * force[:, 0]
    assert abs(moment.sum()) < 1e-9 * np.abs(moment).max()
    inside = np.ones(len(force), dtype=bool)
    inside[folded.mesh.contour] = False
    assert not force[inside].any()


def test_contact_force_and_elastic_and_drag_forces_are_in_equilibrium(folded: History):
    slice_, fractions = folded.slice, folded.fractions
    u, before = folded.displacement(-1), folded.displacement(-2)
    time = float(folded.growth_times[-1])
    total = slice_.elastic_energy(slice_.kinematics(time)).evaluate(u, 1).gradient
    config = folded.config
    c = config.dissipation.number * config.material.young_modulus / config.geometry.mean_radius**2
    drag = c / (fractions[-1] - fractions[-2]) * slice_.lumped_area[:, None] * (u - before)
    rest = total + drag - fields(folded, -1, ["contact_force"])["contact_force"]
    rest[folded.mesh.clamped] = 0.0
    assert np.linalg.norm(rest, axis=1).max() <= 1.001 * slice_.stepping.criterion.force


def test_contact_force_is_zero_without_contact(overlapping: History):
    assert not fields(overlapping, -1, ["contact_force"])["contact_force"].any()


def test_thickness_and_curvature_are_nan_off_the_contour(folded: History):
    got = fields(folded, 0)
    for name in ("thickness", "curvature"):
        on = np.zeros(folded.mesh.n_points, dtype=bool)
        on[folded.mesh.contour] = True
        assert np.array_equal(~np.isnan(got[name]), on), name
    assert np.nanmax(np.abs(got["thickness"] - 1.5)) < 0.05  # T = 1.5 mm, not quite normal to an ellipse


def test_curvature_of_points_on_a_circle_is_one_over_its_radius_at_any_spacing(rng):
    angle = np.sort(rng.uniform(0.0, 2.0 * np.pi, 40))
    circle = 5.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1) + [3.0, -1.0]
    assert curvature(circle) == pytest.approx(0.2, rel=1e-9)
    assert curvature(circle[::-1]) == pytest.approx(-0.2, rel=1e-9)


def test_curvature_is_negative_in_a_dent():
    angle = np.linspace(0.0, 2.0 * np.pi, 200, endpoint=False)
    radius = 10.0 + np.cos(5 * angle)
    k = curvature(radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1))
    # crown and fundus of r = 10 + cos 5 phi: k = (r^2 - r r'') / r^3 = (1 +- 25 / r) / r
    assert k[0] == pytest.approx((1 + 25 / 11) / 11, rel=5e-3)
    assert k[20] == pytest.approx((1 - 25 / 9) / 9, rel=1e-2)


def test_curvature_of_a_periodic_wave_does_not_see_where_it_is_cut():
    x = np.linspace(0.0, 4.0, 100, endpoint=False)
    k = curvature(np.stack([x, 0.1 * np.sin(np.pi * x)], axis=1), shift=4.0)
    assert k == pytest.approx(np.roll(k, 50), abs=1e-9)
    assert np.abs(k[[0, 50]]).max() < 1e-9


def test_contour_fields_of_a_strip_are_those_of_a_flat_layer():
    slice_ = problem(**{"geometry.shape": "strip", "mesh.node_jitter": 0.0})
    got = state(slice_, np.zeros((slice_.mesh.n_points, 2)), 0.0)
    contour = slice_.mesh.contour
    assert got["thickness"][contour] == pytest.approx(1.5, rel=1e-9)
    assert np.abs(got["curvature"][contour]).max() < 1e-9
    bump = np.zeros((slice_.mesh.n_points, 2))
    bump[contour[0], 1] = 0.1
    assert state(slice_, bump, 0.0)["curvature"][contour[0]] > 0.0


def test_every_field_that_the_configuration_names_exists(folded: History):
    got = fields(folded, 3)
    assert tuple(got) == ALL_FIELDS
    assert set(UNITS) == set(ALL_FIELDS)
    assert CONTOUR_FIELDS <= POINT_FIELDS
    for name, values in got.items():
        assert len(values) == (folded.mesh.n_points if name in POINT_FIELDS else folded.mesh.n_cells), name
    assert np.array_equal(got["region"], folded.mesh.region)
    assert np.array_equal(got["displacement"], folded.displacement(3))


def test_fields_of_a_state_that_does_not_exist_are_refused(folded: History):
    with pytest.raises(HistoryError, match="There is no state"):
        fields(folded, len(folded))


def test_only_the_fields_asked_for_are_computed(folded: History, monkeypatch):
    monkeypatch.setattr("gyrify.store.state_fields.distance_to_line", SimpleNamespace())
    assert list(fields(folded, -1, ["J"])) == ["J"]
