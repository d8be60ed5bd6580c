"""Pairs that were searched for in advance are all that can touch."""

from __future__ import annotations

import numpy as np
import pytest
from bodies import pinched_contact

from gyrify.energy.contact import ContactEnergy
from gyrify.energy.neighbourhood import Neighbourhood

STIFFNESS = 1000.0


def test_moves_within_and_beyond_the_squares_give_the_energy_of_a_new_search(
    rng: np.random.Generator,
) -> None:
    known, u, _ = pinched_contact()
    d_hat, reach = known.d_hat, 0.5 * known.d_hat
    kept = ContactEnergy(known.surface, d_hat, STIFFNESS, reach)
    active = 0
    for size in np.tile([0.2, 0.9, 3.0], 20) * reach:
        moved = u + rng.uniform(-size, size, u.shape)
        fresh = ContactEnergy(known.surface, d_hat, STIFFNESS, 0.0).evaluate(moved, 1)
        found = kept.evaluate(moved, 1)
        if np.isfinite(fresh.value):
            active += fresh.value > 0.0
            assert found.value == pytest.approx(fresh.value, rel=1e-12)
            assert found.gradient == pytest.approx(fresh.gradient, abs=1e-9 * abs(fresh.gradient).max())
    assert active > 30


def test_the_way_to_a_collision_is_as_long_as_for_a_new_search(rng: np.random.Generator) -> None:
    known, u, _ = pinched_contact()
    surface, blocked = known.surface, 0
    shortest = surface.shortest_edge(u)
    near = Neighbourhood(surface.collisions, known.d_hat, shortest)
    start = surface.vertices(u)
    near.pairs(start)
    for _ in range(40):
        end = np.asfortranarray(start + rng.uniform(-shortest, shortest, start.shape))
        assert near.holds(end)
        step = surface.collisions.free_step(start, end)
        assert near.collision_free_step(start, end) == pytest.approx(step, rel=1e-12)
        blocked += step < 1.0
    assert blocked > 10


def test_pairs_are_searched_anew_outside_of_the_squares() -> None:
    known, u, _ = pinched_contact()
    near = Neighbourhood(known.surface.collisions, known.d_hat, 0.1)
    start = known.surface.vertices(u)
    assert not near.holds(start)
    near.pairs(start)
    inside, outside = (np.asfortranarray(start + shift) for shift in (0.099, 0.101))
    assert near.holds(inside)
    assert not near.holds(outside)
    near.pairs(outside)
    assert not near.holds(start - 0.01)
