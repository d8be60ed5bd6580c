"""Materials by principal stretches: one solid by either form, and the derivatives of one of one's own."""

from __future__ import annotations

from typing import Any

import bodies
import numpy as np
import pytest
from bodies import KAPPA, MU
from differences import assert_derivatives, dense_hessian

from gyrify.config import Config
from gyrify.energy.axial import AxialElasticEnergy, axial_pattern
from gyrify.energy.elastic import CellPattern, ElasticEnergy
from gyrify.energy.mean_dilatation import MeanDilatationEnergy, PatchPattern
from gyrify.errors import ConfigError
from gyrify.physics.materials import MATERIALS, NEO_HOOKEAN, Material
from gyrify.physics.stress import energy_density, first_piola, planar_cauchy, response
from gyrify.run.validity.expected import expected_onset

STEPS = 10.0 ** -np.arange(1.0, 9.5, 0.5)


@pytest.fixture(scope="module")
def ogden(example) -> Any:
    """The material of the example; with alpha = 2 it is the neo-Hookean solid."""
    material = example("own_material").OGDEN
    MATERIALS.append(material)
    yield material
    MATERIALS.remove(material)


def parameters(n: int, alpha: float | None = None) -> np.ndarray:
    rows = [MU, KAPPA] if alpha is None else [MU, alpha, KAPPA]
    return (
        np.array(rows)[:, None]
        * np.linspace(0.9, 1.1, n) ** np.array([1.0, *[0.0] * (len(rows) - 2), 1.0])[:, None]
    )


def term_of(kind: str, material: Material, p: Any, rng: np.random.Generator) -> tuple[Any, np.ndarray]:
    """A term of some element, and the shape of its state."""
    if kind == "space":
        points = np.array([[0, 0, 0], [1, 0.1, 0], [0.1, 1, 0.1], [0, 0.2, 1], [0.9, 0.8, 0.7]])
        cells = np.array([[0, 1, 2, 3], [1, 4, 2, 3]])
        k = bodies.kinematics(points, cells, np.stack([1.4 * np.eye(3), 1.1 * np.eye(3)]), np.ones(2))
        return ElasticEnergy(k, p(2), k.volumes * k.J_g, CellPattern(cells, 3), material), points
    points, cells, _ = bodies.distorted_square(rng)
    n = len(cells)
    k = bodies.kinematics(points, cells, *bodies.random_growth(rng, n))
    weight, pattern = k.volumes * k.J_g, CellPattern(cells, 2)
    if kind == "axial":
        both = axial_pattern(cells, len(points))
        return AxialElasticEnergy(k, p(n), weight, both, 3.0, material), np.zeros((len(points) + 1, 2))
    if kind == "mean dilatation":
        patches = PatchPattern(cells, np.arange(n) // 2, 2, pattern.pattern)
        return MeanDilatationEnergy(k, p(n), weight, pattern, patches, material), points
    return ElasticEnergy(k, p(n), weight, pattern, material), points


def state(kind: str, shape: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    u = 0.02 * rng.standard_normal(shape.shape)
    if kind == "axial":
        u[-1] = (0.3, 0.0)
    return u


KINDS = ("plane strain", "axial", "space", "mean dilatation")


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("project", [False, True])
def test_a_solid_is_the_same_by_invariants_and_by_stretches(
    ogden: Material, kind: str, project: bool
) -> None:
    found = []
    for material, alpha in ((NEO_HOOKEAN, None), (ogden, 2.0)):
        rng = np.random.default_rng(5)
        term, shape = term_of(kind, material, lambda n, alpha=alpha: parameters(n, alpha), rng)
        found.append((term.evaluate(state(kind, shape, rng), 2, project), shape.size))
    (one, size), (other, _) = found
    assert other.value == pytest.approx(one.value, rel=1e-12)
    assert other.gradient == pytest.approx(one.gradient, abs=1e-11 * abs(one.gradient).max())
    K, K_other = dense_hessian(one.hessian, size), dense_hessian(other.hessian, size)
    assert K_other == pytest.approx(K, abs=1e-10 * abs(K).max())


@pytest.mark.parametrize("kind", KINDS)
def test_error_of_differences_is_a_v(ogden: Material, rng: np.random.Generator, kind: str) -> None:
    term, shape = term_of(kind, ogden, lambda n: parameters(n, 8.0), rng)
    u, du = state(kind, shape, rng), state(kind, shape, rng)
    assert_derivatives(term, u, du, STEPS, lowest=3e-8)


def test_equal_stretches_have_the_limit_of_the_difference_quotients(ogden: Material) -> None:
    """Undeformed, and nearly so: no 0 / 0."""
    rng = np.random.default_rng(2)
    points, cells, _ = bodies.distorted_square(rng)
    k, n = bodies.kinematics(points, cells), len(cells)
    matrices = []
    for size in (0.0, 1e-9, 1e-5):
        term = ElasticEnergy(k, parameters(n, 8.0), k.volumes, CellPattern(cells, 2), ogden)
        u = size * rng.standard_normal(points.shape)
        matrices.append(dense_hessian(term.evaluate(u, 2).hessian, u.size))
    assert np.isfinite(matrices[0]).all()
    for K in matrices[1:]:
        assert matrices[0] == pytest.approx(K, abs=1e-3 * abs(K).max())
    linear = ElasticEnergy(k, parameters(n), k.volumes, CellPattern(cells, 2))
    K = dense_hessian(linear.evaluate(np.zeros_like(points), 2).hessian, points.size)
    assert matrices[0] == pytest.approx(K, abs=1e-10 * abs(K).max())  # the same E and nu


def test_equal_stretches_under_stress_have_the_stiffness_of_the_other_form(ogden: Material) -> None:
    """Scaled as a whole: the stretches in the plane are equal, and the stress is not zero."""
    points, cells, _ = bodies.distorted_square(np.random.default_rng(2))
    k, n = bodies.kinematics(points, cells), len(cells)
    u = 0.2 * points
    found = []
    for material, alpha in ((NEO_HOOKEAN, None), (ogden, 2.0)):
        term = ElasticEnergy(k, parameters(n, alpha), k.volumes, CellPattern(cells, 2), material)
        found.append(dense_hessian(term.evaluate(u, 2).hessian, u.size))
    assert found[1] == pytest.approx(found[0], abs=1e-7 * abs(found[0]).max())
    F, f33 = np.tile(1.2 * np.eye(2), (n, 1, 1)), np.ones(n)
    still = np.zeros(n)
    stress, tangent = response(ogden, F, f33, parameters(n, 2.0), still)
    expected = response(NEO_HOOKEAN, F, f33, parameters(n), still)
    assert stress == pytest.approx(expected[0])
    assert tangent == pytest.approx(expected[1], abs=1e-9)


def test_stresses_of_arrays_agree_in_both_forms(ogden: Material, rng: np.random.Generator) -> None:
    n = 30
    F = np.eye(2) + 0.2 * rng.standard_normal((n, 2, 2))
    F, f33, pressure = F[np.linalg.det(F) > 0.3], rng.uniform(0.7, 1.2, n), rng.standard_normal(n)
    f33, pressure = f33[: len(F)], pressure[: len(F)]
    J = np.linalg.det(F) * f33
    one, other = parameters(len(F)), parameters(len(F), 2.0)
    assert energy_density(ogden, F, f33, other) == pytest.approx(energy_density(NEO_HOOKEAN, F, f33, one))
    for a, b in zip(first_piola(ogden, F, f33, other), first_piola(NEO_HOOKEAN, F, f33, one), strict=True):
        assert a == pytest.approx(b)
    for given in (None, pressure):
        moved = np.moveaxis(F, 0, 2)
        found = planar_cauchy(ogden, moved, f33, J, other, given)
        for a, b in zip(found, planar_cauchy(NEO_HOOKEAN, moved, f33, J, one, given), strict=True):
            assert a == pytest.approx(b, abs=1e-10)
    both = zip(
        response(ogden, F, f33, other, pressure), response(NEO_HOOKEAN, F, f33, one, pressure), strict=True
    )
    for a, b in both:
        assert a == pytest.approx(b, abs=1e-9)


def test_an_unknown_law_is_refused_by_name_and_no_theory_takes_another_one(ogden: Material) -> None:
    with pytest.raises(
        ConfigError, match=r'law = "ogdn" is not allowed: it must be "neo_hookean" or "ogden_8"'
    ):
        Config().with_overrides({"material.law": "ogdn"})
    found = expected_onset(Config().with_overrides({"material.law": ogden.name}))
    assert not found.is_known
    assert 'material.law = "ogden_8"' in found.not_covered


def test_the_standard_law_changes_no_hash() -> None:
    given = Config().with_overrides({"material.law": "neo_hookean"})
    assert given.config_hash == Config().config_hash
