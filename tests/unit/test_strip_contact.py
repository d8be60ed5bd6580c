"""Contact of a periodic contour with itself and its images, against a sum over pairs done by hand."""

from __future__ import annotations

import numpy as np
import pytest
from differences import assert_derivatives, dense_hessian

from gyrify.energy.contact import ContactEnergy, ContactSurface

N, PERIOD, D_HAT, STIFFNESS = 60, 40.0, 0.5, 7.0
# where the pattern lies along x; in all but one, sulci close across the seam
PHASES = [0.9, 1.8, 3.0, 4.5, 5.4, 5.7]


def mushrooms(phase: float) -> np.ndarray:
    """Displacement of a flat contour to four overhanging gyri with nearly closed sulci, none like another."""
    s = PERIOD * np.arange(N) / N
    angle = 8 * np.pi * s / PERIOD + phase
    rng = np.random.default_rng(1)
    x = s + 1.9 * np.sin(2 * angle) + rng.uniform(-0.05, 0.05, N)
    y = 5 * np.sin(angle) + rng.uniform(-0.05, 0.05, N)
    return np.stack([x - s, y], axis=1)


def flat() -> np.ndarray:
    return np.stack([PERIOD * np.arange(N) / N, np.zeros(N)], axis=1)


def contact(d_hat: float = D_HAT) -> ContactEnergy:
    return ContactEnergy(ContactSurface(flat(), np.arange(N), False, PERIOD), d_hat, STIFFNESS)


def barrier(squared: np.ndarray) -> float:
    """Sum of k d_hat b(d^2 / d_hat^2) of pairs closer than the activation distance."""
    s = squared[squared < D_HAT**2] / D_HAT**2
    return float(STIFFNESS * D_HAT * np.sum(-((s - 1) ** 2) * np.log(s)))


def energy_by_hand(u: np.ndarray) -> tuple[float, int]:
    """Energy and number of close pairs with an image.

    Half of each vertex's length times the barrier to all edges in all periods, less the barrier to all
    vertices, because the nearest point of a chain of edges may be a vertex and then counts with both.
    """
    x = flat() + u
    total, images = 0.0, 0
    area = PERIOD / N
    for i in range(N):
        for k in (-2, -1, 0, 1, 2):
            start = x + np.array([k * PERIOD, 0])
            end = np.roll(x, -1, axis=0) + np.array([k * PERIOD, 0])
            end[-1, 0] += PERIOD
            t = np.clip(((x[i] - start) * (end - start)).sum(axis=1) / ((end - start) ** 2).sum(axis=1), 0, 1)
            to_edges = ((x[i] - start - t[:, None] * (end - start)) ** 2).sum(axis=1)
            to_points = ((x[i] - start) ** 2).sum(axis=1)
            number = np.arange(N) + k * N
            not_own = (number != i) & (number + 1 != i)
            total += 0.5 * area * (barrier(to_edges[not_own]) - barrier(to_points[number != i]))
            images += int(np.count_nonzero(to_edges[not_own] < D_HAT**2)) if k else 0
    return total, images


@pytest.mark.parametrize("phase", PHASES)
def test_energy_is_the_sum_over_pairs_in_all_periods(phase: float) -> None:
    expected, _ = energy_by_hand(mushrooms(phase))
    assert expected > 0
    assert contact().evaluate(mushrooms(phase), 0).value == pytest.approx(expected, rel=1e-12)


def test_some_of_those_pairs_cross_the_seam() -> None:
    assert max(energy_by_hand(mushrooms(phase))[1] for phase in PHASES) >= 4


@pytest.mark.parametrize("columns", range(0, N, 7))
def test_sliding_the_pattern_along_x_changes_nothing(columns: int) -> None:
    """The seam is nowhere: value, forces and Hessian slide along."""
    term, u = contact(), mushrooms(4.5)
    here, there = term.evaluate(u, 2), term.evaluate(np.roll(u, columns, axis=0), 2)
    assert there.value == pytest.approx(here.value, rel=1e-12)
    scale = np.abs(here.gradient).max()
    assert np.allclose(there.gradient, np.roll(here.gradient, columns, axis=0), rtol=0, atol=1e-10 * scale)
    K, K_there = dense_hessian(here.hessian, 2 * N), dense_hessian(there.hessian, 2 * N)
    back = np.roll(np.arange(2 * N), 2 * columns)
    assert np.allclose(K_there, K[np.ix_(back, back)], rtol=0, atol=1e-9 * np.abs(K).max())


@pytest.mark.parametrize("columns", [0, 4, 7])
def test_derivatives_across_the_seam(columns: int, rng: np.random.Generator) -> None:
    u = np.roll(mushrooms(4.5), columns, axis=0)
    assert_derivatives(contact(), u, 0.1 * rng.standard_normal(u.shape), np.logspace(-1, -9, 17), lowest=1e-7)


def test_forces_balance() -> None:
    """A rigid translation does no work against contact, images moving along."""
    gradient = contact().evaluate(mushrooms(4.5), 1).gradient
    assert np.allclose(gradient.sum(axis=0), 0, atol=1e-12 * np.abs(gradient).sum())


def test_step_stops_before_a_wall_meets_the_image_of_another() -> None:
    """The first point is pushed left, through the seam, into the contour's image behind the gap."""
    surface = ContactSurface(flat(), np.arange(N), False, PERIOD)
    # two walls, 20 mm high, left and right of the seam: the gap between them is 2/3 mm wide
    u = np.zeros((N, 2))
    u[[1, N - 1], 1] = 20.0
    push = np.zeros((N, 2))
    push[1, 0] = -4 * PERIOD / N
    assert not surface.is_path_collision_free(u, u + push)
    # the tip of the right wall meets that of the left one, two columns away, half-way
    term = ContactEnergy(surface, 0.1, STIFFNESS)
    # 0.9 of the way to where they meet
    assert term.max_step(u, push) == pytest.approx(0.45, abs=0.02)
    assert surface.is_path_collision_free(u, u + 0.45 * push)


def test_a_sliding_contour_is_free_to_pass_the_seam() -> None:
    """All points together move by three periods: nothing is met."""
    surface, u = ContactSurface(flat(), np.arange(N), False, PERIOD), mushrooms(4.5)
    assert surface.is_path_collision_free(u, u + np.array([3 * PERIOD, 0.0]))


def test_shortest_edge_may_be_the_one_across_the_seam() -> None:
    u = np.zeros((N, 2))
    u[-1, 0] = 0.9 * PERIOD / N
    surface = ContactSurface(flat(), np.arange(N), False, PERIOD)
    assert surface.shortest_edge(u) == pytest.approx(0.1 * PERIOD / N)


def test_couplings_are_points_of_the_mesh() -> None:
    """Point numbers of the whole mesh, images folded back: all that cells do not couple already."""
    points = np.concatenate([flat() - [0, 5], flat()])
    surface = ContactSurface(points, N + np.arange(N), False, PERIOD)
    u = np.concatenate([np.zeros((N, 2)), mushrooms(4.5)])
    pairs = surface.couplings(u, 0.5)
    assert pairs.min() >= N
    assert pairs.max() < 2 * N
    pattern = ContactEnergy(surface, D_HAT, STIFFNESS).evaluate(u, 2).hessian.pattern
    coupled = np.unique(np.stack([pattern.rows, pattern.cols], axis=1) // 2, axis=0)
    apart = (coupled[:, 1] - coupled[:, 0]) % (N - 1) > 1
    assert np.count_nonzero(apart) > 10
    assert {tuple(pair) for pair in coupled[apart].tolist()} <= {tuple(pair) for pair in pairs.tolist()}
