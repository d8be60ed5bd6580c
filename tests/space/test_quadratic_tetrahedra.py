"""Quadratic tetrahedra: nodes, shares, bounds of the determinant over whole cells, onset of folding."""

from __future__ import annotations

from math import comb

import numpy as np
import pytest
from solids import BALL, PATCH, config

from gyrify.energy import bernstein_space
from gyrify.energy.element import EDGES
from gyrify.energy.term import FloatArray
from gyrify.mesh import Mesh
from gyrify.model.slice import Slice, build_mesh
from gyrify.run.onset.onset_search import OnsetSearch
from gyrify.run.validity.exact_bodies import sphere_of
from gyrify.theory import critical_growth_time

QUADRATIC = {"mesh.element": "quadratic", "mesh.node_jitter": 0.05, "contact.enabled": False}


def ball(**overrides: object) -> Mesh:
    return build_mesh(config(BALL, **{**QUADRATIC, "mesh.edge_length": 14.0, **overrides}))


def determinants(nodes: FloatArray, places: FloatArray) -> FloatArray:
    """det(dx/dxi) of (n, 10, 3) nodes at (m, 4) volume coordinates."""
    slope, (a, b) = np.concatenate([-np.ones((1, 3)), np.eye(3)]), np.array(EDGES[3]).T
    corners = (4.0 * places - 1.0)[:, :, None] * slope
    between = 4.0 * (places[:, a, None] * slope[b] + places[:, b, None] * slope[a])
    mapping = np.einsum("cai,qaj->cqij", nodes, np.concatenate([corners, between], axis=1))
    return np.asarray(np.linalg.det(mapping))


def test_nodes_of_the_surface_and_the_interface_lie_on_them() -> None:
    mesh = ball()
    radius = np.linalg.norm(mesh.points, axis=1)
    assert radius[mesh.contour] == pytest.approx(36.0, rel=1e-12)
    assert radius[mesh.interface] == pytest.approx(33.0, rel=1e-12)
    # closed: every edge of the parts of the triangles belongs to two of them, once in each direction
    for faces in (mesh.faces, mesh.interface_faces):
        ends = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
        assert {tuple(edge) for edge in ends} == {tuple(edge[::-1]) for edge in ends}
    assert np.array_equal(np.unique(mesh.faces), mesh.contour)


def test_volumes_are_those_of_the_body_and_so_are_the_shares_of_points() -> None:
    problem = Slice(config(BALL, **QUADRATIC))
    exact = 4.0 / 3.0 * np.pi * 36.0**3
    errors = []
    for refine in (0, 1):
        problem = Slice(config(BALL, **{**QUADRATIC, "mesh.edge_length": 14.0, "mesh.refine": refine}))
        errors.append(abs(problem.simplices.volumes.sum() / exact - 1.0))
        assert problem.lumped_area.sum() == pytest.approx(problem.simplices.volumes.sum(), rel=1e-12)
        assert problem.lumped_area.min() > 0.0
    # a surface of second degree: of fourth order, where flat triangles would be of second
    assert errors[1] < errors[0] / 10.0


def test_a_patch_of_quadratic_cells_fills_its_period() -> None:
    problem = Slice(config(PATCH, **QUADRATIC))
    assert problem.simplices.volumes.sum() == pytest.approx(10.0 * 8.0 * 12.0, rel=1e-12)


def test_least_volume_ratios_bound_what_is_sampled(rng: np.random.Generator) -> None:
    problem = Slice(config(BALL, **{**QUADRATIC, "mesh.edge_length": 20.0, "mesh.n_layers": 3}))
    mesh, places = problem.mesh, rng.dirichlet(np.full(4, 0.5), 500)
    u = 0.3 * rng.standard_normal(mesh.points.shape)
    nodes = mesh.cell_points
    sampled = (determinants(nodes + u[mesh.cells], places) / determinants(nodes, places)).min(axis=1)
    least = problem.simplices.least_volume_ratio(u)
    assert np.all(least <= sampled + 1e-9)
    assert np.median(sampled - least) < 0.02
    assert np.count_nonzero(least < problem.simplices.volume_ratio(u).reshape(-1, 4).min(axis=1) - 0.05) > 0


def test_a_step_ends_where_some_cell_inverts_anywhere_in_it(rng: np.random.Generator) -> None:
    """Beside the integration points too: those alone would let the step go further."""
    problem = Slice(config(BALL, **{**QUADRATIC, "mesh.edge_length": 20.0, "mesh.n_layers": 3}))
    curved, none = problem.simplices.curved, np.zeros(problem.state_shape)
    du = 20.0 * rng.standard_normal(problem.state_shape)
    assert curved is not None
    step = curved.largest_step(none, du)
    assert 0.0 < step < 0.5
    end = step / 0.9  # it stops short by a tenth
    assert all(curved.first_inverted(part * end * du) is None for part in (0.2, 0.6, 0.99))
    assert curved.first_inverted(1.02 * end * du) is not None
    assert problem.simplices.volume_ratio(1.02 * end * du).min() > 0.0


def test_coefficients_in_time_are_those_of_a_cubic(rng: np.random.Generator) -> None:
    powers, forms = rng.standard_normal((4, bernstein_space.N)), np.empty((4, bernstein_space.N))
    bernstein_space.in_time(powers, 0.3, 0.5, forms)
    for part in (0.0, 0.2, 0.7, 1.0):
        weights = [comb(3, k) * part**k * (1.0 - part) ** (3 - k) for k in range(4)]
        time = 0.3 + 0.5 * part
        assert weights @ forms == pytest.approx(time ** np.arange(4) @ powers, rel=1e-12, abs=1e-12)


def test_onset_on_few_quadratic_cells_is_that_of_exact_theory() -> None:
    """Four cells on a wave; that many averaged ones are late by a half (docs/space.md)."""
    given = {
        "geometry.semi_axes": (12.0, 12.0, 12.0), "geometry.cortical_thickness": 5.0,
        "mesh.edge_length": 7.0, "mesh.n_layers": 4, "mesh.n_cortex_layers": 2, "mesh.node_jitter": 0.0,
        "growth.law": "area", "growth.duration": 400.0, "material.stiffness_ratio": 3.0,
    }  # fmt: skip
    setup = config(BALL, **{**QUADRATIC, **given})
    exact = critical_growth_time(sphere_of(setup), [100.0, 200.0, 300.0, 400.0])[0]
    found = OnsetSearch(Slice(setup)).onset_by(1.0)
    assert found is not None
    assert found.growth_time == pytest.approx(exact.value, rel=0.05)
    assert found.mode_number == exact.mode_number
