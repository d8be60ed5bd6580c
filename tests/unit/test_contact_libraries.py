"""Contact by gyrify's own kernels: against the equations, against ipctk, and never through the contour."""

from __future__ import annotations

import bodies
import numpy as np
import pytest
from differences import assert_derivatives, dense_hessian
from hypothesis import example, given, settings
from hypothesis import strategies as st
from oracle import barrier
from shapely import LinearRing, LineString
from test_strip_contact import D_HAT, PERIOD, PHASES, STIFFNESS, N, energy_by_hand, flat, mushrooms

from gyrify.energy import planar
from gyrify.energy.contact import ContactEnergy, ContactSurface
from gyrify.energy.contact_libraries import LibraryName, contact_library

OFFSETS = st.floats(-1.0, 1.0, allow_nan=False, width=32)


def closed(points: np.ndarray, d_hat: float, library: LibraryName = "gyrify") -> ContactEnergy:
    surface = ContactSurface(points, np.arange(len(points)), True, None, library)
    return ContactEnergy(surface, d_hat, 7.0)


def pinched(library: LibraryName = "gyrify") -> tuple[ContactEnergy, np.ndarray]:
    known, u, d_hat = bodies.pinched_contact()
    return closed(np.array(known.surface.reference), d_hat, library), u


def strip(library: LibraryName = "gyrify") -> ContactEnergy:
    return ContactEnergy(ContactSurface(flat(), np.arange(N), False, PERIOD, library), D_HAT, STIFFNESS)


def test_the_library_that_is_asked_for_is_the_one_that_works() -> None:
    assert contact_library("gyrify") == "gyrify"
    assert type(strip().surface.collisions) is planar.PlanarContour


def test_energy_and_forces_equal_the_barrier_written_down(rng: np.random.Generator) -> None:
    own, u = pinched()
    for _ in range(20):
        v = u + 0.01 * rng.standard_normal(u.shape)
        found = own.evaluate(v, 1)
        energy, gradient = barrier(own.surface.reference, own.surface.vertices(v), own.d_hat, 7.0)
        assert energy > 0.0
        assert found.value == pytest.approx(energy, rel=1e-12)
        assert found.gradient == pytest.approx(gradient, abs=1e-11 * abs(gradient).max())


@pytest.mark.parametrize("phase", PHASES)
def test_images_count_once(phase: float) -> None:
    assert strip().evaluate(mushrooms(phase), 0).value == pytest.approx(
        energy_by_hand(mushrooms(phase))[0], rel=1e-12
    )


def test_derivatives(rng: np.random.Generator) -> None:
    own, u = pinched()
    assert_derivatives(own, u, rng.standard_normal(u.shape), 10.0 ** -np.arange(3.0, 10.5, 0.5), lowest=1e-7)
    u = mushrooms(4.5)
    assert_derivatives(strip(), u, 0.1 * rng.standard_normal(u.shape), np.logspace(-1, -9, 17), lowest=1e-7)


def test_projected_stiffness_is_semi_definite_and_above_the_exact_one() -> None:
    own, u = pinched()
    exact, projected = (dense_hessian(own.evaluate(u, 2, p).hessian, u.size) for p in (False, True))
    scale = abs(exact).max()
    assert np.linalg.eigvalsh(exact).min() < -1e-3 * scale
    assert np.linalg.eigvalsh(projected).min() > -1e-12 * scale
    assert np.linalg.eigvalsh(projected - exact).min() > -1e-12 * scale


@pytest.mark.parametrize("project_psd", [False, True])
def test_both_libraries_give_the_same(project_psd: bool, rng: np.random.Generator) -> None:
    pytest.importorskip("ipctk", reason="needs ipctk to compare with")
    own, u = pinched()
    cases = [(pinched("ipctk")[0], own, u + 0.01 * rng.standard_normal(u.shape)) for _ in range(20)]
    cases += [(strip("ipctk"), strip(), mushrooms(phase)) for phase in PHASES]
    for toolkit, planar_one, v in cases:
        a, b = toolkit.evaluate(v, 2, project_psd), planar_one.evaluate(v, 2, project_psd)
        A, B = (dense_hessian(found.hessian, v.size) for found in (a, b))
        assert b.value == pytest.approx(a.value, rel=1e-10)
        assert b.gradient == pytest.approx(a.gradient, abs=1e-10 * abs(a.gradient).max())
        assert pytest.approx(A, abs=1e-10 * abs(A).max()) == B
        couplings = [term.surface.couplings(v, 0.5) for term in (toolkit, planar_one)]
        assert np.array_equal(*couplings)


def test_both_libraries_stop_at_the_same_place(rng: np.random.Generator) -> None:
    pytest.importorskip("ipctk", reason="needs ipctk to compare with")
    (toolkit, u), (own, _) = pinched("ipctk"), pinched()
    blocked = 0
    for _ in range(50):
        du = 0.3 * rng.standard_normal(u.shape)
        steps = [term.max_step(u, du) for term in (toolkit, own)]
        free = [term.surface.is_path_collision_free(u, u + du) for term in (toolkit, own)]
        assert 0.85 * steps[0] <= steps[1] <= 1.01 * steps[0]
        assert free[0] == free[1] == (steps[0] == 1.0)
        blocked += steps[0] < 1.0
    assert blocked > 30


def test_a_sliding_strip_is_free_and_a_crossing_one_is_not() -> None:
    surface, u = strip().surface, mushrooms(4.5)
    assert surface.is_path_collision_free(u, u + np.array([3 * PERIOD, 0.0]))
    walls, push = np.zeros((N, 2)), np.zeros((N, 2))
    walls[[1, N - 1], 1], push[1, 0] = 20.0, -4 * PERIOD / N
    assert not surface.is_path_collision_free(walls, walls + push)
    assert ContactEnergy(surface, 0.1, STIFFNESS).max_step(walls, push) == pytest.approx(0.45, abs=0.02)
    assert surface.is_path_collision_free(walls, walls + 0.45 * push)


def test_a_contour_that_touches_or_moves_without_bounds_makes_no_step() -> None:
    own, u = pinched()
    du = np.ones_like(u)
    for bad in (np.inf, np.nan):
        du[3] = bad
        assert own.max_step(u, du) == 0.0
    touching = u.copy()
    touching[0] = own.surface.reference[-2] + u[-2] - own.surface.reference[0]
    assert own.evaluate(touching, 2).value == np.inf
    away = np.linspace(0, 1, u.size).reshape(-1, 2)
    assert own.max_step(touching, away) == 0.0
    assert not own.surface.is_path_collision_free(touching, touching + away)


def first_meeting(start: np.ndarray, end: np.ndarray) -> float:
    """Smallest t in [0, 1] at which the first point lies on the segment of the others, infinite if none.

    The three are in line at the roots of a quadratic; between them and within rounding of one another, the
    point is on the segment where it is between its ends.
    """
    q, e = start[0] - start[1], start[2] - start[1]
    dq, de = end[0] - end[1] - q, end[2] - end[1] - e
    cross = [np.linalg.det([dq, de]), np.linalg.det([q, de]) + np.linalg.det([dq, e]), np.linalg.det([q, e])]
    meetings = [
        t.real
        for t in np.roots(cross)
        if abs(t.imag) < 1e-9 and 0.0 <= t.real <= 1.0 and _is_between(q + t.real * dq, e + t.real * de)
    ]
    return min(meetings, default=np.inf)


def _is_between(q: np.ndarray, e: np.ndarray) -> bool:
    if not e @ e > 0.0:
        return False
    along = q @ e / (e @ e)
    # A segment that shrinks to a point is in line with everything: the point must also be near it.
    return bool(1e-9 <= along <= 1.0 - 1e-9 and np.linalg.norm(q - along * e) < 1e-6)


@settings(max_examples=300, deadline=None)
@given(st.lists(OFFSETS, min_size=12, max_size=12))
@example([-0.5, 0.0, 0.0, -0.5, -1.0, -0.5, 0.0, 0.875, 0.0, 0.0, 0.0, 0.0])
@example([0.0, 0.0, 1.1754943508222875e-38, 0.0, 1.0, 0.0, 0.0, -0.25, 0.0, -1.0, 0.0, 0.0])
def test_no_step_reaches_the_first_meeting(numbers: list[float]) -> None:
    start, end = np.array(numbers).reshape(2, 3, 2)
    edges, pairs = np.array([[1, 2]]), np.array([[0, 0]])
    meeting = first_meeting(start, end)
    step = planar.kernels.free_step(start, end, edges, pairs, planar.GAP)
    assert step < meeting or step == 0.0
    if np.isinf(meeting):
        near = min(
            LineString(x[1:]).distance(LineString(x[:1].repeat(2, 0)))
            for x in (start + t * (end - start) for t in np.linspace(0, 1, 201))
        )
        assert step == 1.0 or near < 0.1  # what passes close by may stop it


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1), st.floats(0.1, 30.0))
def test_random_steps_never_let_the_contour_cross_itself(seed: int, size: float) -> None:
    rng = np.random.default_rng(seed)
    own, u = pinched()
    for _ in range(4):
        du = size * rng.standard_normal(u.shape)
        step = own.max_step(u, du)
        for t in np.linspace(0.0, step, 9):
            assert LinearRing(own.surface.vertices(u + t * du)).is_simple
        u = u + step * du
        assert np.isfinite(own.evaluate(u, 0).value)
