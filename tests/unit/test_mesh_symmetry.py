"""Meshes that are their own mirror image: points to the last bit, cells, patches and jitter."""

from __future__ import annotations

import numpy as np
import pytest
from bodies import elliptic_ring

from gyrify import Config, ConfigError, MeshError
from gyrify.energy.total import FreePattern
from gyrify.energy.unknowns import Unknowns
from gyrify.mesh.layered_grid import Layers
from gyrify.mesh.mesh import Mesh
from gyrify.mesh.symmetry import Mirror, representatives, symmetric_field
from gyrify.model.meshing import build_mesh

SMALL = {"mesh.n_around": 48, "mesh.n_layers": 7, "mesh.n_cortex_layers": 3, "mesh.split": "symmetric"}
STRIP = {"geometry.shape": "strip", "geometry.length": 40.0 / 3.0}
VARIANTS = [
    {},
    {"mesh.element": "quadratic"},
    {"mesh.refine": 1},
    {"mesh.refine_cortex": 2},
    {"mesh.refine_cortex": 1, "mesh.element": "quadratic"},
    {"mesh.grading": "uniform"},
    STRIP,
    STRIP | {"mesh.element": "quadratic", "mesh.n_around": 50},
    STRIP | {"mesh.refine_cortex": 1},
]


def mesh_of(**changes: object) -> Mesh:
    return build_mesh(Config().with_overrides(SMALL | changes))


def sets(rows: np.ndarray) -> set[tuple[int, ...]]:
    return set(map(tuple, np.sort(rows, axis=1).tolist()))


@pytest.mark.parametrize("jitter", [0.0, 0.05])
@pytest.mark.parametrize("change", VARIANTS, ids=str)
def test_mesh_is_its_own_mirror_image(change: dict, jitter: float) -> None:
    mesh = mesh_of(**change, **{"mesh.node_jitter": jitter})
    assert len(mesh.mirrors) == (1 if mesh.period else 2)
    for mirror in mesh.mirrors:
        image = mirror.image
        assert np.array_equal(image[image], np.arange(mesh.n_points))
        if mesh.period is None:
            assert np.array_equal(mirror.of(mesh.points), mesh.points)
        else:
            across = (mesh.points[:, 0] + mesh.points[image, 0]) % mesh.period
            assert np.array_equal(across, np.zeros(mesh.n_points))
            assert np.array_equal(mesh.points[image, 1], mesh.points[:, 1])
        assert sets(image[mesh.cells]) == sets(mesh.cells)
        assert sets(image[mesh.cells[mesh.region == 1]]) == sets(mesh.cells[mesh.region == 1])
        for line in (mesh.contour, mesh.interface, mesh.clamped):
            assert np.array_equal(np.sort(image[line]), np.sort(line))
        cell_of = {
            cell: number for number, cell in enumerate(map(tuple, np.sort(mesh.cells, axis=1).tolist()))
        }
        twin = [cell_of[cell] for cell in map(tuple, np.sort(image[mesh.cells], axis=1).tolist())]
        flip = np.where(np.arange(2) == mirror.axis, -1.0, 1.0)
        assert mesh.across[twin] == pytest.approx(mesh.across * flip, abs=1e-12)
        quads = {tuple(np.unique(mesh.cells[mesh.patch == p, :3])) for p in np.unique(mesh.patch)}
        assert {tuple(sorted(image[list(quad)].tolist())) for quad in quads} == quads


def test_jitter_is_drawn_for_one_part_and_mirrored() -> None:
    smooth, jittered = (mesh_of(**{"mesh.node_jitter": jitter}).points for jitter in (0.0, 0.05))
    moved = np.linalg.norm(jittered - smooth, axis=1)
    assert np.count_nonzero(moved > 1e-6) > 0.9 * moved.size
    other = build_mesh(Config().with_overrides(SMALL | {"mesh.node_jitter": 0.05, "seed": 1})).points
    assert np.abs(other - jittered).max() > 1e-3


def test_symmetric_split_alternates_and_moves_points_by_rounding_alone() -> None:
    change = {"mesh.node_jitter": 0.0}
    alternating, symmetric = mesh_of(**change | {"mesh.split": "alternating"}), mesh_of(**change)
    assert np.array_equal(alternating.cells, symmetric.cells)
    assert alternating.mirrors == ()
    assert np.abs(alternating.points - symmetric.points).max() < 1e-13
    assert not np.array_equal(alternating.points, symmetric.points)


def test_alternating_split_of_other_numbers_of_columns_is_not_symmetric() -> None:
    """What the symmetric split refuses: 50 columns of alternating diagonals have no mirror in x."""
    mesh = elliptic_ring((40.0, 30.0), 0.5, 1.5, Layers(50, 7, 3))
    n = 50
    row, j = np.divmod(np.arange(mesh.n_points), n)
    image = row * n + (n // 2 - j) % n
    assert np.abs(mesh.points[image] * [-1.0, 1.0] - mesh.points).max() < 1e-12
    assert sets(image[mesh.cells]) != sets(mesh.cells)


@pytest.mark.parametrize(("change", "advice"), [({}, "52 or 56"), (STRIP, "50 or 52"), ({}, "24 or 28")])
def test_columns_that_cannot_be_symmetric_are_refused_with_advice_that_works(
    change: dict, advice: str
) -> None:
    n_around = int(advice[:2]) + 1
    with pytest.raises(ConfigError) as caught:
        Config().with_overrides(SMALL | change | {"mesh.n_around": n_around})
    assert advice in str(caught.value)
    for number in advice.split(" or "):
        build_mesh(Config().with_overrides(SMALL | change | {"mesh.n_around": int(number)}))


def test_odd_columns_are_refused_by_the_mesh_itself() -> None:
    with pytest.raises(MeshError, match="n_around = 48"):
        elliptic_ring((40.0, 30.0), 0.5, 1.5, Layers(50, 7, 3, split="symmetric"))


def test_a_branch_that_may_break_the_symmetry_is_refused() -> None:
    with pytest.raises(ConfigError, match="break the symmetry"):
        Config().with_overrides(
            {"mesh.split": "symmetric", "dissipation.kind": "none", "stability.follow_branch": True}
        )


def test_hash_of_other_configurations_stays() -> None:
    assert Config.preset("reference-slice").config_hash.startswith("70e224fd81e3")


def test_components_on_a_line_vanish_and_others_follow() -> None:
    """Three points in a row, the middle one on the line x = 0."""
    mirror = Mirror(0, np.array([2, 1, 0]))
    source, sign = representatives([mirror], 3, 2)
    assert source.tolist() == [0, 1, 2, 3, 0, 1]
    assert sign.tolist() == [1.0, 1.0, 0.0, 1.0, -1.0, 1.0]
    field = symmetric_field([mirror], np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]))
    assert field.tolist() == [[1.0, 2.0], [0.0, 4.0], [-1.0, 2.0]]


def test_reduced_matrix_is_the_full_one_on_the_symmetric_displacements() -> None:
    rng = np.random.default_rng(3)
    mirrors = [Mirror(0, np.array([2, 1, 0, 5, 4, 3])), Mirror(1, np.array([3, 4, 5, 0, 1, 2]))]
    source, sign = representatives(mirrors, 6, 2)
    free = np.arange(12)
    unknowns = Unknowns.of(source, sign, free)
    basis = np.column_stack([unknowns.scatter(column) for column in np.eye(unknowns.size)])
    for mirror in mirrors:
        for column in basis.T:
            field = column.reshape(6, 2)
            assert np.array_equal(mirror.of(field), field)
    rows, cols = np.triu_indices(12)
    values = rng.standard_normal(rows.size)
    full = np.zeros((12, 12))
    full[rows, cols] = full[cols, rows] = values
    pattern = FreePattern(free, 12, rows, cols, unknowns)
    data = np.zeros(pattern.rows.size)

    class Term:
        pass

    term = Term()
    term.rows, term.cols = rows, cols  # type: ignore[attr-defined]
    pattern.add(term, values, data)  # type: ignore[arg-type]
    reduced = np.zeros((unknowns.size, unknowns.size))
    reduced[pattern.rows, pattern.cols] = reduced[pattern.cols, pattern.rows] = data
    assert reduced == pytest.approx(basis.T @ full @ basis, abs=1e-13)
    gradient = rng.standard_normal(12)
    assert unknowns.gather(gradient) == pytest.approx(basis.T @ gradient, abs=1e-14)
    mass = np.repeat(rng.random(6), 2)
    assert unknowns.gather_mass(mass) == pytest.approx(np.diag(basis.T @ np.diag(mass) @ basis))
