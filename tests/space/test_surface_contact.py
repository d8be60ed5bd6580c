"""Contact of surfaces: derivatives, the barrier, paths that stop, images of a periodic surface."""

from __future__ import annotations

import numpy as np
import pytest
from differences import assert_derivatives

from gyrify.energy.contact import ContactEnergy, ContactSurface
from gyrify.energy.triangle_sheet import smallest_height

STIFFNESS = 5.0


def two_plates(gap: float, shift: tuple[float, float] = (0.31, 0.17)) -> tuple[np.ndarray, np.ndarray]:
    """Two squares of triangles that face each other."""
    i, j = (k.ravel() for k in np.meshgrid(np.arange(4.0), np.arange(4.0), indexing="ij"))
    low = np.stack([i, j, 0.05 * np.sin(i + 2.0 * j)], axis=1)
    high = np.stack([i + shift[0], j + shift[1], gap + 0.05 * np.cos(i - j)], axis=1)
    quads = [(4 * a + b, 4 * a + b + 4, 4 * a + b + 5, 4 * a + b + 1) for a in range(3) for b in range(3)]
    up = [t for p, q, r, s in quads for t in ((p, q, r), (p, r, s))]
    down = [(a + 16, c + 16, b + 16) for a, b, c in up]
    return np.concatenate([low, high]), np.array(up + down)


def plates(gap: float = 0.2, d_hat: float = 0.3) -> tuple[ContactEnergy, np.ndarray]:
    points, faces = two_plates(gap)
    surface = ContactSurface(points, np.arange(32), faces=faces)
    return ContactEnergy(surface, d_hat, STIFFNESS), np.zeros_like(points)


def test_derivatives(rng: np.random.Generator) -> None:
    term, u = plates()
    assert term.evaluate(u, 0).value > 0.0
    assert_derivatives(term, u, rng.standard_normal(u.shape), 10.0 ** -np.arange(3.0, 9.5, 0.5), lowest=1e-6)


def test_forces_push_the_plates_apart_and_balance() -> None:
    term, u = plates()
    gradient = term.evaluate(u, 1).gradient
    assert gradient[:16, 2].sum() > 0.0 > gradient[16:, 2].sum()
    assert gradient.sum(axis=0) == pytest.approx(0.0, abs=1e-12 * np.abs(gradient).sum())


def test_energy_does_not_change_with_the_place_or_the_turn(rng: np.random.Generator) -> None:
    term, u = plates()
    x = term.surface.reference
    turn, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    moved = x @ turn.T + [3.0, -2.0, 7.0] - x
    assert term.evaluate(moved, 0).value == pytest.approx(term.evaluate(u, 0).value, rel=1e-9)


def test_a_path_stops_before_the_plates_meet() -> None:
    term, u = plates(gap=0.5)
    du = np.zeros_like(u)
    du[16:, 2] = -1.0
    step = term.max_step(u, du)
    assert 0.3 < step < 0.5
    assert np.isfinite(term.evaluate(u + step * du, 0).value)
    assert not term.surface.is_path_collision_free(u, u + du)
    assert term.surface.is_path_collision_free(u, u + step * du)


def test_two_edges_that_cross_in_the_air_repel() -> None:
    """Vertex-face pairs alone would miss them: no vertex is over the other triangle."""
    points = np.array(
        [[-2, 0, 0], [2, 0, 0], [0, 0.2, -3], [0, -2, 0.1], [0, 2, 0.1], [0.2, 0, 3.0]], dtype=float
    )
    surface = ContactSurface(points, np.arange(6), faces=np.array([[0, 1, 2], [3, 5, 4]]))
    term = ContactEnergy(surface, 0.2, STIFFNESS)
    found = term.evaluate(np.zeros_like(points), 1)
    assert found.value > 0.0
    assert found.gradient[:2, 2].sum() > 0.0 > found.gradient[3:5, 2].sum()


def periodic_bumps(period: float = 6.0) -> tuple[np.ndarray, np.ndarray]:
    """A sheet of 6 x 6 squares with two walls that nearly meet across the end of the period in x."""
    n = 6
    i, j = (k.ravel() for k in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    x = np.stack([i * period / n, j * period / n, np.zeros(n * n)], axis=1)
    x[i == 0] += [0.0, 0.0, 2.0]
    x[i == 5] += [0.0, 0.0, 2.2]
    faces = []
    for a in range(n):
        for b in range(n):
            p, q = a * n + b, ((a + 1) % n) * n + b
            r, s = ((a + 1) % n) * n + (b + 1) % n, a * n + (b + 1) % n
            faces += [(p, q, r), (p, r, s)]
    return x, np.array(faces)


def rolled(x: np.ndarray, faces: np.ndarray, by: int) -> tuple[np.ndarray, np.ndarray]:
    """The same periodic surface, cut elsewhere: moved by some columns, points beyond the end taken back."""
    moved = x.copy()
    moved[:, 0] = (x[:, 0] + by) % 6.0
    return moved, faces


def test_a_pair_across_the_period_counts_once_wherever_the_period_is_cut() -> None:
    values = []
    for by in range(6):
        x, faces = rolled(*periodic_bumps(), by)
        surface = ContactSurface(x, np.arange(36), True, 6.0, faces=faces, period_y=6.0)
        u = np.zeros_like(x)
        # the two walls lean towards each other
        u[0:6, 0] -= 0.35
        u[30:36, 0] += 0.35
        term = ContactEnergy(surface, 0.45, STIFFNESS)
        found = term.evaluate(u, 1)
        values.append(found.value)
        assert found.gradient.sum(axis=0) == pytest.approx(0.0, abs=1e-9 * np.abs(found.gradient).sum())
    assert values[0] > 0.0
    assert values == pytest.approx([values[0]] * 6, rel=1e-9)


def test_derivatives_across_the_period(rng: np.random.Generator) -> None:
    x, faces = periodic_bumps()
    surface = ContactSurface(x, np.arange(36), True, 6.0, faces=faces, period_y=6.0)
    u = 0.01 * rng.standard_normal(x.shape)
    u[0:6, 0] -= 0.35
    u[30:36, 0] += 0.35
    term = ContactEnergy(surface, 0.45, STIFFNESS)
    assert_derivatives(term, u, rng.standard_normal(u.shape), 10.0 ** -np.arange(3.0, 9.5, 0.5), lowest=1e-6)


def test_spacing_is_the_smallest_height() -> None:
    corners = np.array([[[0.0, 0, 0], [4, 0, 0], [0, 3, 0]]])
    assert smallest_height(corners) == pytest.approx(12.0 / 5.0)


def test_couplings_reach_across_a_gap() -> None:
    term, u = plates()
    pairs = term.surface.couplings(u, 0.3)
    assert ((pairs[:, 0] < 16) & (pairs[:, 1] >= 16)).any()
    assert (pairs[:, 0] < pairs[:, 1]).all()
