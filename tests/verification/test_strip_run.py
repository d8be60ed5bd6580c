"""A strip that folds until its sulci close, one of them across the seam."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import shapely
from test_contact import crossings

from gyrify import simulate
from gyrify.config import Config
from gyrify.model.slice import Slice
from gyrify.run.summary import measure_state, summarise
from gyrify.store import History

STRIP = {
    "geometry.shape": "strip",
    "geometry.length": 16.0,
    "geometry.depth": 10.0,
    "material.stiffness_ratio": 3.0,
    "mesh.n_around": 64,
    "mesh.n_layers": 8,
    "mesh.n_cortex_layers": 4,
    "growth.duration": 350.0,
    "solver.increments": 20,
    "seed": 0,
}


@pytest.fixture(scope="module")
def strip() -> History:
    """Run of a strip with drag, jitter and contact."""
    return simulate(Config.preset("reference-slice").with_overrides(STRIP))


def outline(history: History, index: int) -> np.ndarray:
    """Closed line of three periods of the contour, closed far below."""
    period, line = history.mesh.period, history.contour(index)
    top = np.concatenate([line + np.array([k * period, 0.0]) for k in (-1, 0, 1)])
    return np.concatenate([top, [[2 * period, -100.0], [-period, -100.0]]])


def gap_to_images(history: History) -> float:
    """Smallest distance from a vertex to the two images in the last state, its neighbours left out."""
    period, line = history.mesh.period, history.contour()
    to_right = shapely.LineString(
        np.concatenate([line[3:], line[:1] + np.array([period, 0.0])]) + np.array([period, 0.0])
    )
    to_left = shapely.LineString(line[:-3] - np.array([period, 0.0]))
    return min(shapely.distance(shapely.points(line), image).min() for image in (to_left, to_right))


def test_the_run_folds_and_closes_a_sulcus_across_the_seam(strip: History) -> None:
    measures = measure_state(strip)
    assert strip.status == "completed"
    assert measures.n_gyri >= 2
    assert measures.gi_hull > 1.5
    d_hat = strip.config.contact.activation_fraction * strip.config.geometry.cortical_thickness
    assert 0 < measures.min_gap < d_hat
    assert gap_to_images(strip) < d_hat
    assert not measures.self_intersecting


def test_no_path_between_increments_crosses_itself_or_an_image(strip: History) -> None:
    lines = [outline(strip, k) for k in range(len(strip))]
    assert all(shapely.LinearRing(line).is_simple for line in lines)
    assert sum(crossings(a, b) for a, b in pairwise(lines)) == 0


def test_without_contact_the_same_strip_goes_through_its_images(strip: History) -> None:
    overlapping = simulate(strip.config.replace(**{"contact.enabled": False}))
    assert not shapely.LinearRing(outline(overlapping, -1)).is_simple
    assert measure_state(overlapping).self_intersecting


def test_forces_on_the_last_state_balance_across_the_seam(strip: History) -> None:
    """The residual stored is that of the whole strip: every free point is in equilibrium, seam or not."""
    summary = summarise(strip)
    assert summary["solver"]["residual"] <= summary["solver"]["tolerance"]
    assert summary["min_J_elastic"] > 0


def test_the_same_strip_gives_the_same_bits(strip: History) -> None:
    assert simulate(strip.config).result_hash == strip.result_hash


@pytest.mark.parametrize("columns", [0, 10])
def test_nothing_marks_the_seam(strip: History, columns: int) -> None:
    """Energy of the folded state, moved along by an even number of columns of a regular mesh."""
    regular = strip.config.replace(**{"mesh.node_jitter": 0.0, "mesh.split": "alternating"})
    problem = Slice(regular)
    layers = problem.config.mesh.n_layers + 1
    u = strip.displacement()
    moved = np.roll(u.reshape(layers, -1, 2), columns, axis=1).reshape(-1, 2)
    energy, energy_moved = (problem.tissue_energy(1.0, state).value(state) for state in (u, moved))
    assert energy_moved == pytest.approx(energy, rel=1e-12)
