"""Meshes, modes and fits behind the plan for three dimensions."""

from __future__ import annotations

from collections import Counter
from itertools import combinations

import numpy as np
import pytest
import scipy.sparse as sp
from bench.space.factors import factorised
from bench.space.plan import fit
from bench.space.shell import HOLE, SEMI_AXES, Tangent, half_ellipsoid
from bench.space.surface import Sheet


def test_shell_fills_half_an_ellipsoid_and_fits_together() -> None:
    shell = half_ellipsoid(8)
    corners = shell.points[shell.cells]
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6.0
    exact = 2.0 / 3.0 * np.pi * SEMI_AXES.prod() * (1.0 - HOLE**3)
    assert shell.cells.shape[0] == 9 * 8**3
    assert volumes.min() > 0.0
    assert volumes.sum() == pytest.approx(exact, rel=0.05)
    faces = Counter(frozenset(face) for cell in shell.cells.tolist() for face in combinations(cell, 3))
    assert set(faces.values()) == {1, 2}
    outside = [face for face, times in faces.items() if times == 1]
    edges = Counter(frozenset(edge) for face in outside for edge in combinations(sorted(face), 2))
    assert set(edges.values()) == {2}, "the boundary is closed"


def test_rigid_modes_cost_no_energy() -> None:
    tangent = Tangent(half_ellipsoid(4))
    tangent.free = np.arange(tangent.u.size)
    upper = tangent.upper()
    whole = upper + sp.triu(upper, 1).T
    modes = tangent.rigid_modes()
    assert np.linalg.matrix_rank(modes) == 6
    assert np.abs(whole @ modes).max() < 1e-9 * np.abs(whole.data).max() * np.abs(modes).max()


@pytest.mark.parametrize("name", ["pardiso", "superlu"])
def test_factorisation_that_is_timed_solves(name: str) -> None:
    if name == "pardiso":
        pytest.importorskip("pypardiso")
    found = factorised(4, name)
    assert found["cells"] == 9 * 4**3
    assert found["residual"] < 1e-10


def test_multigrid_that_is_timed_converges() -> None:
    pytest.importorskip("pyamg")
    from bench.space.factors import LOOSE, TIGHT, iterated

    found = iterated(6)
    assert found["reached, loose"] <= LOOSE
    assert found["reached, tight"] <= TIGHT


def test_fit_finds_a_power_law() -> None:
    cells = np.array([1e4, 4e4, 1.6e5])
    assert fit(cells, 3.0 * cells**1.5) == pytest.approx((1.5, 3.0))


def test_sheet_meets_itself_where_its_contour_does() -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 200, endpoint=False)
    apart = np.column_stack([10.0 * np.cos(angle), 10.0 * np.sin(angle)])
    flat = apart * [1.0, 0.004]
    assert len(Sheet(apart, 8, 0.4).collisions()) == 0
    assert len(Sheet(flat, 8, 0.4).collisions()) > 0
