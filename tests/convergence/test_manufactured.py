"""Rates of every element on a manufactured solution, and what each loses near incompressibility.

Relative errors of the displacement in L2 and in the H1 seminorm. Squares are distorted at random and split
at random, another mesh at every level; rings have curved edges.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from bodies import elliptic_ring
from manufactured import Manufactured
from panels import ELEMENTS, Panel, rates, square, straight_square

from gyrify.mesh.layered_grid import Layers

LEVELS = {"linear": (16, 32, 64), "mean_dilatation": (16, 32, 64), "quadratic": (8, 16, 32)}
RING_LEVELS = (1, 2, 4)
OPTIMAL = {"linear": (2.0, 1.0), "mean_dilatation": (2.0, 1.0), "quadratic": (3.0, 2.0)}
ALMOST = 0.4999


def ring(level: int, element: str, **options: int) -> Panel:
    """Elliptic ring, 1.2 x 1.0 mm, held on both ellipses."""
    layers = Layers(24 * level, 6 * level, 2 * level, "uniform", element=element, **options)  # type: ignore[arg-type]
    return Panel.of_ring(elliptic_ring((1.2, 1.0), 0.5, 0.15, layers), element)


@cache
def on_squares(element: str, poisson_ratio: float) -> np.ndarray:
    """(3 levels, 2 norms) errors."""
    return np.array([Manufactured(poisson_ratio).errors(square(n, element)) for n in LEVELS[element]])


@cache
def on_rings(element: str, poisson_ratio: float) -> np.ndarray:
    solution = Manufactured(poisson_ratio, size=2.0)
    return np.array([solution.errors(ring(level, element)) for level in RING_LEVELS])


@cache
def on_straight_squares(element: str, poisson_ratio: float, diagonals: str) -> np.ndarray:
    solution = Manufactured(poisson_ratio)
    return np.array([solution.errors(straight_square(n, element, diagonals)) for n in LEVELS[element]])


def mean_rates(errors: np.ndarray) -> np.ndarray:
    """Order over two halvings, in both norms."""
    return np.log(errors[0] / errors[-1]) / np.log(2.0) / (len(errors) - 1)


@pytest.mark.parametrize("poisson_ratio", [0.3, 0.458])
@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("family", [on_squares, on_rings])
def test_rates_are_optimal(family, element: str, poisson_ratio: float) -> None:
    assert mean_rates(family(element, poisson_ratio)) == pytest.approx(OPTIMAL[element], abs=0.1)


@pytest.mark.parametrize("family", [on_squares, on_rings])
def test_mean_dilatation_does_not_lock(family) -> None:
    """Its rates stay, and its errors are at most half as large again as those of the compressible body."""
    almost, tissue = family("mean_dilatation", ALMOST), family("mean_dilatation", 0.458)
    assert mean_rates(almost) == pytest.approx(OPTIMAL["mean_dilatation"], abs=0.1)
    assert np.all(almost <= 1.6 * tissue)


def test_linear_triangles_lock() -> None:
    """Against the same meshes with mean dilatation: four times the error in L2, then ten times."""
    linear, free = on_squares("linear", ALMOST), on_squares("mean_dilatation", ALMOST)
    assert linear[0, 0] >= 4.0 * free[0, 0]
    assert linear[1, 0] >= 8.0 * free[1, 0]
    assert linear[1, 1] >= 2.5 * free[1, 1]
    assert rates(linear[:2, 0])[0] < 1.2


def test_linear_triangles_lock_wholly_where_their_diagonals_are_parallel() -> None:
    """L2 order 2 becomes less than 1, where mean dilatation keeps it."""
    assert mean_rates(on_straight_squares("linear", ALMOST, "parallel"))[0] < 0.8
    kept = mean_rates(on_straight_squares("mean_dilatation", ALMOST, "parallel"))
    assert kept == pytest.approx(OPTIMAL["mean_dilatation"], abs=0.1)


def test_quadratic_triangles_lock_where_their_diagonals_are_parallel() -> None:
    """There they lose half an order and more, and five times the accuracy."""
    almost, tissue = (on_straight_squares("quadratic", nu, "parallel") for nu in (ALMOST, 0.458))
    assert mean_rates(tissue) == pytest.approx(OPTIMAL["quadratic"], abs=0.1)
    assert mean_rates(almost)[1] < 1.5
    assert np.all(almost[-1] >= 4.0 * tissue[-1])


@pytest.mark.parametrize("family", [on_squares, on_rings])
def test_quadratic_triangles_keep_their_rate_on_other_meshes(family) -> None:
    """At least the optimal order: coarse meshes lose a factor of up to 2.5, fine ones regain it."""
    almost, tissue = family("quadratic", ALMOST), family("quadratic", 0.458)
    assert np.all(mean_rates(almost) >= np.array(OPTIMAL["quadratic"]) - 0.1)
    assert np.all(almost[-1] <= 2.3 * tissue[-1])


@pytest.mark.parametrize("element", ELEMENTS)
def test_refinement_of_the_cortex_alone_costs_no_accuracy(element: str) -> None:
    """Bands that double their columns: errors fall short of those without, at nearly the same rate.

    Nearly, because the band is finer than the rest, and its share of the wall falls with the mesh width.
    """
    solution = Manufactured(0.458, size=2.0)
    errors = np.array([solution.errors(ring(n, element, refine_cortex=1)) for n in RING_LEVELS[:2]])
    assert np.all(errors < on_rings(element, 0.458)[:2])
    assert np.all(mean_rates(errors) >= np.array(OPTIMAL[element]) - 0.25)


@pytest.mark.parametrize(("diagonals", "raw_order"), [("parallel", 1.9), ("alternating", 0.0)])
def test_mean_dilatation_pressure_is_right_on_the_mean_of_four_quadrilaterals(
    diagonals: str, raw_order: float
) -> None:
    """With alternating diagonals the pressure carries a checkerboard; blocks of 2 x 2 do not see it."""
    raw, smooth = np.array([pressure_errors(n, diagonals) for n in (8, 16, 32)]).T
    assert np.all(rates(smooth) >= 1.8)
    assert np.all(rates(raw) >= raw_order)
    assert (raw[-1] > 50.0 * smooth[-1]) == (diagonals == "alternating")


def pressure_errors(n: int, diagonals: str) -> tuple[float, float]:
    """Root mean square over mu of the error of the pressure, its mean aside: per quadrilateral, per four.

    The mean over the whole square is aside because the displacements of its rim alone decide it.
    """
    solution, panel = Manufactured(ALMOST), straight_square(n, "mean_dilatation", diagonals)
    mu, kappa = solution.moduli
    u = panel.solve(mu, kappa, panel.load(solution.body_force), solution.displacement(panel.points))
    ratio = panel.patches.sums(panel.simplices.volume_ratio(u)) / 2.0
    centres = (np.stack(np.meshgrid(np.arange(n), np.arange(n)), axis=2) + 0.5) / n
    error = kappa * (ratio.reshape(n, n) - np.linalg.det(solution.deformation(centres))) / mu
    blocks = error.reshape(n // 2, 2, n // 2, 2).mean(axis=(1, 3))
    return float(error.std()), float(blocks.std())


def test_the_load_is_the_stress_s() -> None:
    """The deformation gradient is the map's and the force the stress's, by central differences."""
    solution, h = Manufactured(0.3), 1e-5
    places = np.random.default_rng(0).random((6, 2))
    force = np.zeros((6, 2))
    for j, shift in enumerate(h * np.eye(2)):
        slope = (solution.map(places + shift) - solution.map(places - shift)) / (2 * h)
        assert slope == pytest.approx(solution.deformation(places)[..., j], abs=1e-8)
        force -= ((solution.stress(places + shift) - solution.stress(places - shift)) / (2 * h))[..., j]
    assert force == pytest.approx(solution.body_force(places), abs=1e-7)
