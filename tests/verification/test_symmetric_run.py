"""Folds of a symmetric mesh are their own mirror image to the end; else rounding grows to millimetres."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gyrify import Config, gyrification_index, simulate, summarise
from gyrify.errors import SolveError
from gyrify.run.simulation import new_run, resume
from gyrify.solve.problem import State
from gyrify.store import History
from gyrify.verify import verify
from gyrify.verify.recheck import _check_symmetry

COARSE = {
    "mesh.n_around": 96,
    "mesh.n_layers": 8,
    "mesh.n_cortex_layers": 3,
    "mesh.split": "symmetric",
    "solver.increments": 40,
}


def coarse(**changes: object) -> Config:
    return Config().with_overrides(COARSE | changes)


def asymmetry(history: History, mirrors=None) -> float:
    """Largest difference between a state and its mirror images [mm]."""
    u = history.journal.state(len(history) - 1).u
    mirrors = history.mesh.mirrors if mirrors is None else mirrors
    assert mirrors
    return max(float(np.abs(mirror.of(u) - u).max()) for mirror in mirrors)


def side_lengths(history: History) -> tuple[float, float]:
    """Length of the deformed contour left and right of x = 0 [mm]."""
    x = history.contour(len(history) - 1)
    quarter = len(x) // 4
    lengths = np.linalg.norm(np.roll(x, -1, axis=0) - x, axis=1)
    right = np.roll(lengths, quarter)[: 2 * quarter].sum()
    return float(lengths.sum() - right), float(right)


def mirrored_halves(history: History) -> list[np.ndarray]:
    """The right half with its mirror image, and the left half with its own: two whole contours [mm]."""
    x = history.contour(len(history) - 1)
    quarter = len(x) // 4
    x = np.roll(x, quarter, axis=0)
    right, left = x[: 2 * quarter + 1], np.roll(x, -2 * quarter, axis=0)[: 2 * quarter + 1]
    return [np.concatenate([half, (half * [-1.0, 1.0])[-2:0:-1]]) for half in (right, left)]


@pytest.fixture(scope="module")
def folded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "symmetric"
    simulate(coarse(), folder)
    return folder


def test_both_sides_of_a_folded_slice_are_equal(folded: Path) -> None:
    history = History.load(folded)
    summary = summarise(history)
    assert summary["n_gyri"] >= 10
    assert summary["gi"]["hull"] > 1.1
    assert asymmetry(history) <= 1e-9
    left, right = side_lengths(history)
    assert left == pytest.approx(right, rel=1e-12)
    assert left + right == pytest.approx(summary["contour_length_mm"], rel=1e-9)
    halves = [gyrification_index(half) for half in mirrored_halves(history)]
    assert halves[0] == pytest.approx(halves[1], rel=1e-9)
    assert halves[0] > 1.1


def test_verify_checks_the_symmetry(folded: Path) -> None:
    checks = {check.name: check for check in verify(folded).checks}
    assert all(check.passed for check in checks.values())
    assert checks["symmetry"].worst <= 1e-9


def test_alternating_diagonals_do_not_keep_it() -> None:
    """The same triangles and no jitter: rounding along unstable directions breaks the symmetry."""
    change = {"mesh.n_around": 216, "mesh.n_layers": 17, "mesh.n_cortex_layers": 6, "mesh.node_jitter": 0.0}
    symmetric = simulate(coarse(**change, **{"solver.increments": 100}))
    alternating = simulate(coarse(**change, **{"solver.increments": 100, "mesh.split": "alternating"}))
    assert asymmetry(symmetric) <= 1e-9
    assert asymmetry(alternating, symmetric.mesh.mirrors) > 0.1
    assert side_lengths(symmetric)[0] == pytest.approx(side_lengths(symmetric)[1], rel=1e-12)
    # before folds are seen both are one and the same
    first, second = (history.journal.state(40).u for history in (symmetric, alternating))
    assert np.abs(first - second).max() < 1e-5


@pytest.mark.parametrize(
    "change",
    [
        {
            "mesh.element": "quadratic",
            "mesh.inversion_resistance": 0.1,
            "mesh.n_around": 48,
            "growth.duration": 400.0,
        },
        {"mesh.element": "mean_dilatation", "growth.law": "tangential"},
        {"mesh.refine_cortex": 1, "mesh.n_around": 48},
        {"geometry.shape": "strip", "mesh.n_around": 50},
        {"growth.out_of_plane": "generalised"},
        {"dissipation.kind": "kelvin_voigt", "growth.duration": 300.0},
        {"dissipation.kind": "none", "stability.detect": False, "solver.regularisation": "shift"},
    ],
    ids=str,
)
def test_every_reading_stays_symmetric(change: dict) -> None:
    history = simulate(coarse(**{"solver.increments": 20} | change))
    assert asymmetry(history) <= 1e-9
    assert np.abs(history.journal.state(len(history) - 1).u).max() > 1.0


def test_residual_is_that_of_all_points(folded: Path) -> None:
    """The symmetric state is in balance by itself: the force across the symmetry vanishes too."""
    history = History.load(folded)
    problem, last = history.slice, len(history) - 1
    before, after = history.journal.state(last - 1), history.journal.state(last)
    end = problem.stepping.end
    _, gradient = problem.energy(after.position / end, before, before.position / end).slope(after.u)
    gradient[problem.mesh.clamped] = 0.0
    largest = float(np.linalg.norm(gradient, axis=1).max())
    assert largest <= problem.stepping.criterion.force
    assert after.residual == pytest.approx(largest, rel=1e-9)


def test_a_resumed_run_has_the_same_bits(tmp_path: Path, folded: Path) -> None:
    config = coarse()
    with new_run(config, tmp_path / "run") as run:
        stop = iter(range(1000))

        def watch() -> None:
            if next(stop) == 60:
                raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            run.grow(watch=watch)
    resume(tmp_path / "run")
    assert History.load(tmp_path / "run").result_hash == History.load(folded).result_hash


def test_instability_that_would_break_the_symmetry_is_told(folded: Path) -> None:
    warnings = summarise(History.load(folded))["warnings"]
    assert any("held mirror-symmetric" in warning for warning in warnings)
    with pytest.raises(SolveError, match="Buckling instability") as caught:
        simulate(coarse(**{"dissipation.kind": "none"}))
    assert 'another mesh.split than "symmetric"' in str(caught.value)


def test_verify_sees_a_broken_symmetry(folded: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    history = History.load(folded)
    state = history.journal.state
    shift = np.zeros(history.slice.state_shape)
    shift[history.mesh.contour[5], 0] = 1e-6

    def broken(number: int) -> State:
        known = state(number)
        return replace(known, u=known.u + shift) if number == 7 else known

    assert all(check.passed for check in _check_symmetry(history))
    monkeypatch.setattr(history.journal, "state", broken)
    (check,) = _check_symmetry(history)
    assert not check.passed
    assert "in increment 7" in check.sentence
