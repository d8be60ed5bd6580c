"""Energies of the elements against sums by hand, patch tests, rigid motions."""

from __future__ import annotations

import numpy as np
import pytest
from bodies import elliptic_ring, rotation

from gyrify.config import Config
from gyrify.energy.element import reference_element
from gyrify.energy.kinematics import Simplices
from gyrify.energy.total import TotalEnergy
from gyrify.errors import ConfigError
from gyrify.mesh import Mesh
from gyrify.mesh.layered_grid import Layers
from gyrify.model.tissue import Tissue

ELEMENTS = ["linear", "quadratic", "mean_dilatation"]
CIRCULAR = {"mesh.n_around": 24, "mesh.n_layers": 4, "mesh.n_cortex_layers": 2, "mesh.node_jitter": 0.02}


def tissue(element: str, **overrides: object) -> Tissue:
    config = Config.preset("reference-slice").with_overrides({**CIRCULAR, "mesh.element": element})
    return Tissue(config.replace(**overrides))


def energy_by_hand(F: np.ndarray, f33: np.ndarray, mu: np.ndarray, kappa: np.ndarray) -> np.ndarray:
    """W = mu/2 (J^(-2/3) I1 - 3) + kappa/2 (J - 1)^2."""
    J = np.linalg.det(F) * f33
    I1 = np.square(F).sum(axis=(1, 2)) + f33**2
    return mu / 2 * (J ** (-2 / 3) * I1 - 3) + kappa / 2 * (J - 1) ** 2


def bent(mesh: Mesh, amount: float = 0.02) -> np.ndarray:
    """A smooth displacement that is not affine."""
    x, y = mesh.points.T / 30.0
    return amount * 30.0 * np.stack([np.sin(2 * y) + x * y, np.cos(3 * x) - y**2], axis=1)


@pytest.mark.parametrize("n_nodes", [3, 6])
def test_slopes_are_those_of_functions_that_sum_to_one_and_carry_linear_fields(n_nodes: int) -> None:
    nodes = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]])[:n_nodes]
    slopes, weights = reference_element(n_nodes, 2)
    assert weights.sum() == pytest.approx(0.5)
    assert slopes.sum(axis=1) == pytest.approx(0.0, abs=1e-15)
    for slope in slopes:
        assert nodes.T @ slope == pytest.approx(np.eye(2), abs=1e-15)


def test_quadratic_slopes_carry_quadratic_fields() -> None:
    """Gradient (2x, y; x) of x^2 and xy at the three places (2/3, 1/6) and so on, corner by corner."""
    nodes = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]])
    slopes, _ = reference_element(6, 2)
    for slope, (x, y) in zip(slopes, [(1 / 6, 1 / 6), (2 / 3, 1 / 6), (1 / 6, 2 / 3)], strict=True):
        assert nodes[:, 0] ** 2 @ slope == pytest.approx([2 * x, 0], abs=1e-14)
        assert (nodes[:, 0] * nodes[:, 1]) @ slope == pytest.approx([y, x], abs=1e-14)


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("refine_cortex", [0, 1])
def test_affine_states_are_reproduced_and_in_balance(element: str, refine_cortex: int) -> None:
    """Patch test on curved cells: F is exact everywhere, and no inner point feels a force."""
    A = np.array([[1.2, 0.3], [-0.1, 0.9]])
    body = tissue(element, **{"mesh.refine_cortex": refine_cortex})
    mesh, k = body.mesh, body.kinematics(0.0)
    u = mesh.points @ (A - np.eye(2)).T
    assert np.allclose(k.deformation(u), A, atol=1e-12)
    evaluation = body.elastic_energy(k).evaluate(u, 1)
    inner = np.setdiff1d(np.arange(mesh.n_points), np.concatenate([mesh.contour, mesh.clamped]))
    forces = np.abs(evaluation.gradient)
    assert forces[inner].max() < 1e-11 * forces.max()
    W = energy_by_hand(A[None], np.ones(1), body.parameters[0][:1], body.bulk_modulus[:1])[0]
    assert evaluation.value == pytest.approx(W * body.simplices.volumes.sum(), rel=1e-12)


@pytest.mark.parametrize("element", ELEMENTS)
def test_rigid_motions_cost_nothing_and_turn_forces(element: str) -> None:
    body = tissue(element)
    term, Q = body.elastic_energy(body.kinematics(100.0)), rotation(0.7)
    u = bent(body.mesh)
    turned = (body.mesh.points + u) @ Q.T + [3.0, -2.0] - body.mesh.points
    still, moved = term.evaluate(u, 1), term.evaluate(turned, 1)
    assert moved.value == pytest.approx(still.value, rel=1e-11)
    assert np.allclose(moved.gradient, still.gradient @ Q.T, atol=1e-9 * np.abs(still.gradient).max())


def test_mean_dilatation_energy_is_the_sum_of_its_equation() -> None:
    """Patch by patch, two stiffnesses, growth, three triangles where columns double."""
    body = tissue("mean_dilatation", **{"mesh.refine_cortex": 1, "material.stiffness_ratio": 2.0})
    k = body.kinematics(200.0)
    u = bent(body.mesh)
    F, J = k.deformation(u), np.linalg.det(k.deformation(u)) * k.f33
    weight, expected = k.volumes * k.J_g, 0.0
    for patch in np.unique(body.mesh.patch):
        inside = np.flatnonzero(body.mesh.patch == patch)
        I1 = np.square(F[inside]).sum(axis=(1, 2)) + k.f33[inside] ** 2
        mean = np.average(J[inside], weights=weight[inside])
        expected += np.sum(weight[inside] * body.parameters[0][inside] / 2 * (J[inside] ** (-2 / 3) * I1 - 3))
        expected += weight[inside].sum() * body.bulk_modulus[inside[0]] / 2 * (mean - 1) ** 2
    assert body.elastic_energy(k).evaluate(u, 0).value == pytest.approx(expected, rel=1e-12)
    plain = np.sum(weight * energy_by_hand(F, k.f33, body.parameters[0], body.bulk_modulus))
    assert expected < 0.9999 * plain


@pytest.mark.parametrize("element", ["linear", "quadratic"])
def test_axial_energy_is_the_plane_one_with_another_stretch(element: str) -> None:
    """F33 = 1 + w / L enters as F33 / F_g,33; its force is the axial one over L."""
    body = tissue(element, **{"growth.out_of_plane": "generalised"})
    k, L = body.kinematics(200.0), body.axial_length
    u = np.vstack([bent(body.mesh), [[0.12 * L, 0.0]]])
    f33 = 1.12 * k.f33
    W = energy_by_hand(k.deformation(u), f33, body.parameters[0], body.bulk_modulus)
    term = body.elastic_energy(k)
    assert term.evaluate(u, 0).value == pytest.approx(np.sum(k.volumes * k.J_g * W), rel=1e-12)
    h = 1e-6 * L
    up, down = u.copy(), u.copy()
    up[-1, 0] += h
    down[-1, 0] -= h
    slope = (term.evaluate(up, 0).value - term.evaluate(down, 0).value) / (2 * h)
    gradient = term.evaluate(u, 1).gradient
    assert gradient[-1, 0] == pytest.approx(slope, rel=1e-6)
    assert gradient[-1, 1] == 0.0


def test_axial_step_stops_before_the_slice_vanishes() -> None:
    """From F33 = 1.5, a step to F33 = -1.5 may go 0.9 of half of the way."""
    body = tissue("linear", **{"growth.out_of_plane": "generalised"})
    term, L = body.elastic_energy(body.kinematics(0.0)), body.axial_length
    u, du = np.zeros((2, *body.state_shape))
    u[-1, 0], du[-1, 0] = 0.5 * L, -3.0 * L
    assert term.max_step(u, du) == pytest.approx(0.45)
    assert term.max_step(u, -du) == 1.0
    assert np.isinf(TotalEnergy([term]).value(u + 0.51 * du))


@pytest.mark.parametrize("element", ELEMENTS)
def test_lumped_areas_are_positive_and_sum_to_the_area(element: str) -> None:
    mesh = elliptic_ring((4.0, 3.0), 0.5, 0.5, Layers(12, 4, 2, element=element, refine_cortex=1))  # type: ignore[arg-type]
    simplices = Simplices.of(mesh.cell_points, mesh.cells, mesh.n_points)
    lumped = simplices.lumped_volumes
    assert lumped.min() > 0.0
    assert lumped.sum() == pytest.approx(simplices.volumes.sum(), rel=1e-13)
    means = simplices.cell_means(np.ones((simplices.volumes.size, 2)))
    assert means == pytest.approx(np.ones((mesh.n_cells, 2)))


@pytest.mark.parametrize(
    "refused", [{"mesh.element": "mean_dilatation"}, {"dissipation.kind": "kelvin_voigt"}]
)
def test_what_knows_no_axial_unknown_is_refused_with_it(refused: dict) -> None:
    with pytest.raises(ConfigError, match=r"generalised.*(Try|Choose) "):
        tissue("linear", **{"growth.out_of_plane": "generalised", **refused})
