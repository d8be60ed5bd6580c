"""Forces and stiffness of the other elements against finite differences."""

from __future__ import annotations

from typing import Any

import bodies
import numpy as np
import pytest
from bodies import KAPPA, MU, elliptic_ring
from differences import assert_derivatives, dense_hessian

from gyrify.energy.axial import AxialElasticEnergy, axial_pattern
from gyrify.energy.elastic import CellPattern, ElasticEnergy
from gyrify.energy.kinematics import ElasticKinematics, Simplices
from gyrify.energy.mean_dilatation import MeanDilatationEnergy, PatchPattern
from gyrify.mesh import Mesh
from gyrify.mesh.layered_grid import Layers
from gyrify.physics.materials import NEO_HOOKEAN
from gyrify.physics.stress import energy_density, first_piola

STEPS = 10.0 ** -np.arange(1.0, 9.5, 0.5)


def small_ring(element: str, **options: Any) -> Mesh:
    return elliptic_ring((4.0, 3.0), 0.5, 0.5, Layers(12, 4, 2, element=element, **options))


def term_of(mesh: Mesh, element: str, axial: bool = False) -> Any:
    """Elastic term of the element, with a growth that differs from point to point."""
    simplices = Simplices.of(mesh.cell_points, mesh.cells, mesh.n_points)
    n = simplices.volumes.size
    stretch = 1.0 + 0.5 * np.random.default_rng(1).random(n)
    k = ElasticKinematics.of(simplices, stretch[:, None, None] * np.eye(2), stretch)
    material = (np.stack([np.full(n, MU), np.full(n, KAPPA)]), k.volumes * k.J_g)
    if axial:
        return AxialElasticEnergy(k, *material, axial_pattern(simplices.cells, mesh.n_points), 3.0)
    pattern = CellPattern(simplices.cells, 2)
    if element == "mean_dilatation":
        patches = PatchPattern(simplices.cells, mesh.patch, 2, pattern.pattern)
        return MeanDilatationEnergy(k, *material, pattern, patches)
    return ElasticEnergy(k, *material, pattern)


@pytest.mark.parametrize("element", ["linear", "quadratic", "mean_dilatation"])
@pytest.mark.parametrize("refine_cortex", [0, 1])
def test_error_of_differences_is_a_v(rng: np.random.Generator, element: str, refine_cortex: int) -> None:
    mesh = small_ring(element, refine_cortex=refine_cortex)
    u, du = 0.003 * rng.standard_normal((2, *mesh.points.shape))
    assert_derivatives(term_of(mesh, element), u, du, STEPS)


@pytest.mark.parametrize("element", ["linear", "quadratic"])
def test_error_of_differences_is_a_v_with_a_common_axial_stretch(
    rng: np.random.Generator, element: str
) -> None:
    mesh = small_ring(element)
    u, du = 0.003 * rng.standard_normal((2, mesh.n_points + 1, 2))
    u[-1], du[-1] = (0.4, 0.0), (0.02, 0.0)
    assert_derivatives(term_of(mesh, element, axial=True), u, du, STEPS)


@pytest.mark.parametrize("element", ["linear", "quadratic"])
def test_axial_force_is_the_net_stress_along_z(rng: np.random.Generator, element: str) -> None:
    """Energy and force on w = (F33 - 1) L, L = 3, from density and stress of every point."""
    mesh = small_ring(element)
    term, u = term_of(mesh, element, axial=True), np.zeros((mesh.n_points + 1, 2))
    u[:-1], u[-1, 0] = 0.003 * rng.standard_normal(mesh.points.shape), 0.4
    k = term.kinematics
    f33 = (1.0 + 0.4 / 3.0) * k.f33
    material = (NEO_HOOKEAN, k.deformation(u), f33, term.parameters)
    found = term.evaluate(u, 1)
    assert found.value == pytest.approx(np.sum(term.weight * energy_density(*material)), rel=1e-13)
    net = np.sum(term.weight * first_piola(*material)[1] * k.f33) / 3.0
    assert found.gradient[-1, 0] == pytest.approx(net, rel=1e-12)
    assert found.gradient[-1, 1] == 0.0
    u[-1, 0] = -3.0
    assert term.evaluate(u, 2).value == np.inf


def test_projected_axial_stiffness_is_exact_in_tension(rng: np.random.Generator) -> None:
    """Stretched by 3 % on all sides every tangent is definite, so that nothing is cut off."""
    points, cells, _ = bodies.distorted_square(rng, 9)
    k, n = bodies.kinematics(points, cells), len(cells)
    pattern = axial_pattern(cells, len(points))
    term = AxialElasticEnergy(k, np.stack([np.full(n, MU), np.full(n, KAPPA)]), k.volumes, pattern, 3.0)
    u = np.concatenate([0.03 * points + 1e-4 * rng.standard_normal(points.shape), [[0.09, 0.0]]])
    exact, projected = (dense_hessian(term.evaluate(u, 2, p).hessian, u.size) for p in (False, True))
    assert abs(projected - exact).max() < 1e-12 * abs(exact).max()
    assert abs(exact[-2]).max() > 0.1


@pytest.mark.parametrize("kind", ["quadratic", "mean_dilatation", "axial"])
def test_projected_stiffness_is_positive_and_differs_only_where_it_must(
    rng: np.random.Generator, kind: str
) -> None:
    mesh = small_ring("linear" if kind == "axial" else kind)
    term = term_of(mesh, kind, axial=kind == "axial")
    u = np.zeros((mesh.n_points + (kind == "axial"), 2))
    u[: mesh.n_points] = -0.25 * mesh.points + 0.004 * rng.standard_normal(mesh.points.shape)
    exact, projected = (dense_hessian(term.evaluate(u, 2, p).hessian, u.size) for p in (False, True))
    assert np.linalg.eigvalsh(exact).min() < -0.1
    assert np.linalg.eigvalsh(projected).min() > -1e-9 * np.abs(exact).max()
    assert np.linalg.eigvalsh(projected - exact).min() > -1e-9 * np.abs(exact).max()
