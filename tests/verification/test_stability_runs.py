"""Loss of stability in runs: found, located, stored, resumed, left, or reported."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from slices import FOLDING

from gyrify.config import Config
from gyrify.errors import ConfigError, SolveError
from gyrify.simulation import Progress, resume, simulate
from gyrify.store import History
from gyrify.summary import summarise
from gyrify.threshold import critical_growth

PERFECT = {**FOLDING, "mesh.node_jitter": 0.0, "dissipation.kind": "none"}
FOLLOWED = {**PERFECT, "stability.follow_branch": True}
NO_PAIRS = np.empty((0, 2), dtype=np.int64)


def configured(values: dict[str, object]) -> Config:
    """The reference slice with some values."""
    return Config.preset("reference-slice").with_overrides(values)


@pytest.fixture(scope="module")
def followed() -> History:
    """A perfect slice that folds because its branch is followed."""
    return simulate(configured(FOLLOWED))


def test_detection_leaves_a_run_as_it_is(folding: Config, folded: History) -> None:
    without = simulate(folding.replace(**{"stability.detect": False}))
    assert without.result_hash == folded.result_hash
    assert without.onset is None
    assert without.negative_pivots == {}
    assert without.stable == folded.stable


def test_looks_are_evenly_spaced_and_half_as_many_after_onset(folded: History) -> None:
    """20 increments: each is looked at until the onset, every second one after it, and the last."""
    onset, last = folded.onset, len(folded) - 1
    assert onset is not None
    first = int(np.searchsorted(folded.growth_times, onset.growth_time))
    expected = [k for k in range(1, last + 1) if k <= first or k % 2 == 0 or k == last]
    assert sorted(folded.negative_pivots) == expected


def test_onset_is_sought_between_looks(
    folding: Config, folded: History, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With looks at every fifth increment only, bisection finds the same onset."""
    monkeypatch.setattr("gyrify.detection.LOOKS", 4)
    again = simulate(folding)
    assert len(again.negative_pivots) < len(folded.negative_pivots)
    assert again.onset is not None
    assert folded.onset is not None
    assert again.onset.growth_time == pytest.approx(folded.onset.growth_time, rel=1e-6)
    assert again.onset.mode_number == folded.onset.mode_number


def test_onset_lies_in_the_first_increment_that_ends_unstable(folded: History) -> None:
    """Sought by bisection between looks; here every increment up to it is looked at."""
    onset, problem, stepping = folded.onset, folded.slice, folded.slice.stepping
    assert onset is not None
    first = int(np.searchsorted(folded.growth_times, onset.growth_time))
    system = problem.system(NO_PAIRS)
    states = [folded.journal.state(k) for k in range(first + 1)]
    counts = [
        problem.tangent(state.position / stepping.end, state.u, state.u_before, system).n_negative
        for state in states
    ]
    assert counts[-1] > 0
    assert not any(counts[:-1])


def test_stored_eigenpair(folded: History) -> None:
    onset, problem = folded.onset, folded.slice
    assert onset is not None
    first = int(np.searchsorted(folded.growth_times, onset.growth_time))
    fraction = onset.growth_time / folded.config.growth.duration
    tangent = problem.tangent(
        fraction, onset.displacement, folded.displacement(first - 1), problem.system(NO_PAIRS)
    )
    K, v = tangent.matrix(), onset.vector.ravel()[problem.free]
    residual = np.linalg.norm(K @ v - onset.eigenvalue * tangent.mass * v)
    norm = float(np.sqrt(np.square(K.data).sum()))
    assert residual <= 1e-6 * norm * np.linalg.norm(v)
    assert onset.bracket[0] <= onset.growth_time <= onset.bracket[1]
    span = folded.growth_times[first] - folded.growth_times[first - 1]
    assert onset.bracket[1] - onset.bracket[0] <= 0.01 * span
    assert abs(onset.eigenvalue) < 0.05 * abs(problem_eigenvalue(folded, first))
    assert summarise(folded)["onset"]["mode_number"] == onset.mode_number


def problem_eigenvalue(history: History, index: int) -> float:
    """Lowest eigenvalue of the tissue at a state [Pa/mm^2]."""
    problem = history.slice
    u, before = history.displacement(index), history.displacement(index - 1)
    return (
        problem.tangent(float(history.fractions[index]), u, before, problem.system(NO_PAIRS))
        .lowest()
        .eigenvalue
    )


@pytest.mark.parametrize("values", [FOLDING, FOLLOWED], ids=["dragged", "followed"])
def test_resume_finds_the_same_onset(tmp_path: Path, values: dict[str, object]) -> None:
    class Killed(Exception):
        pass

    def kill(progress: Progress) -> None:
        if progress.state.index == 8:
            raise Killed

    config = configured({**values, "growth.duration": 360.0, "solver.increments": 12})
    whole = simulate(config)
    with pytest.raises(Killed):
        simulate(config, tmp_path / "run", observers=[kill])
    resumed = resume(tmp_path / "run")
    assert resumed.result_hash == whole.result_hash
    assert resumed.negative_pivots == whole.negative_pivots
    first, second = whole.onset, resumed.onset
    assert first is not None
    assert second is not None
    assert first.growth_time == second.growth_time
    np.testing.assert_array_equal(first.vector, second.vector)


def test_a_perfect_slice_stops_at_its_instability(tmp_path: Path) -> None:
    config = configured(PERFECT)
    for attempt in (lambda: simulate(config, tmp_path / "run"), lambda: resume(tmp_path / "run")):
        with pytest.raises(SolveError, match="Buckling instability") as failure:
            attempt()
        assert "negative pivots" in failure.value.message
        assert "eigenvalue" in failure.value.message
        assert "stability.follow_branch = true" in failure.value.advice
    history = History.load(tmp_path / "run")
    assert history.status == "failed"
    assert not any(history.negative_pivots.values())
    assert history.onset is not None
    threshold = critical_growth(config, "growth.time", range=(240.0, 360.0), points=4)
    assert history.onset.growth_time == pytest.approx(threshold.critical_value, rel=1e-3)
    assert history.onset.mode_number == threshold.mode_number


def test_following_the_branch_ends_stable_and_folded(followed: History) -> None:
    assert followed.status == "completed"
    assert followed.stable is True
    last = len(followed) - 1
    assert followed.negative_pivots[last] == 0
    assert problem_eigenvalue(followed, last) > 0.0
    summary = summarise(followed)
    assert summary["gi"]["closing"] > 1.2
    assert summary["n_gyri"] >= 12
    assert not summary["self_intersecting"]
    assert summary["onset"]["mode_number"] == pytest.approx(summary["n_gyri"], abs=2)


def test_following_hangs_neither_on_jitter_nor_on_the_sign(followed: History) -> None:
    opposite = simulate(configured({**FOLLOWED, "stability.sign": -1}))
    noisy = simulate(configured({**FOLLOWED, "mesh.node_jitter": 1e-3}))
    index = summarise(followed)["gi"]["closing"]
    for other in (opposite, noisy):
        assert other.stable is True
        assert summarise(other)["gi"]["closing"] == pytest.approx(index, abs=0.02)


@pytest.mark.parametrize("mesh", [{}, {"mesh.n_around": 216, "mesh.n_layers": 17, "mesh.n_cortex_layers": 6}])
def test_jitter_alone_leads_into_stable_folds(mesh: dict[str, int]) -> None:
    values = {**PERFECT, "mesh.node_jitter": 1e-3, "growth.duration": 360.0, "solver.increments": 12}
    history = simulate(configured({**values, **mesh}))
    assert history.status == "completed"
    assert history.stable is True
    assert summarise(history)["n_gyri"] >= 12


def test_jitter_unfolds_the_bifurcation() -> None:
    """Without dissipation a jittered slice drifts into folds along stable states; its onset is null."""
    history = simulate(configured({**PERFECT, "mesh.node_jitter": 1e-3}))
    assert history.status == "completed"
    assert history.onset is None
    assert history.stable is True
    summary = summarise(history)
    assert summary["onset"] is None
    assert "jitter" in summary["stability_note"]
    assert summary["gi"]["closing"] > 1.2


def test_following_needs_a_path_without_dissipation() -> None:
    with pytest.raises(ConfigError, match=r"stability\.follow_branch"):
        simulate(configured({**FOLDING, "stability.follow_branch": True}))
