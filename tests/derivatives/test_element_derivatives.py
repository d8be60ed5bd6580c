"""Forces and stiffness of the other elements against finite differences."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from bodies import KAPPA, MU
from differences import assert_derivatives, dense_hessian

from gyrify.energy.axial import AxialElasticEnergy, axial_pattern
from gyrify.energy.elastic import CellPattern, ElasticEnergy
from gyrify.energy.kinematics import ElasticKinematics, Simplices
from gyrify.energy.mean_dilatation import MeanDilatationEnergy, PatchPattern
from gyrify.mesh import Mesh
from gyrify.mesh.ring import elliptic_ring
from gyrify.mesh.sheet import Layers

STEPS = 10.0 ** -np.arange(1.0, 9.5, 0.5)


def small_ring(element: str, **options: Any) -> Mesh:
    return elliptic_ring((4.0, 3.0), 0.5, 0.5, Layers(12, 4, 2, element=element, **options))


def term_of(mesh: Mesh, element: str, axial: bool = False) -> Any:
    """Elastic term of the element, with a growth that differs from point to point."""
    simplices = Simplices.of(mesh.cell_points, mesh.cells, mesh.n_points)
    n = simplices.volumes.size
    stretch = 1.0 + 0.5 * np.random.default_rng(1).random(n)
    k = ElasticKinematics.of(simplices, stretch[:, None, None] * np.eye(2), stretch)
    material = (np.full(n, MU), np.full(n, KAPPA), k.volumes * k.J_g)
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
