"""Loss of stability in runs: found, located, stored, resumed, left, or reported."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from slices import FOLDING

from gyrify.config import Config
from gyrify.errors import ConfigError, SolveError
from gyrify.model.slice import Slice
from gyrify.run.onset.smooth import IDEAL, grown
from gyrify.run.onset.visible_time import visible_time
from gyrify.run.simulation import Progress, resume, simulate
from gyrify.run.summary import summarise
from gyrify.store import History
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
    assert without.stability_changes == ()
    assert without.negative_pivots == {}
    assert without.stable is None
    assert without.relaxed is None


def ideal(history: History) -> Slice:
    """The slice of a run without jitter and dissipation."""
    return Slice(history.config.with_overrides(IDEAL))


def test_the_onset_is_an_equilibrium_without_jitter_and_drag(folded: History) -> None:
    onset, problem = folded.onset, ideal(folded)
    assert onset is not None
    u = onset.displacement + folded.mesh.points - problem.mesh.points
    fraction = onset.growth_time / folded.config.growth.duration
    nearest = min(onset.bracket, key=lambda time: abs(time - onset.growth_time))
    energy = problem.tissue_energy(nearest / folded.config.growth.duration, u)
    gradient = sum(term.gradient for term in energy.evaluate(u, project_psd=False)).ravel()
    assert np.abs(gradient[problem.free]).max() <= 1.01 * problem.stepping.criterion.force
    tangent = problem.tangent(fraction, u, u, problem.system(NO_PAIRS))
    K, v = tangent.matrix(), onset.vector.ravel()[problem.free]
    norm = float(np.sqrt(np.square(K.data).sum()))
    assert np.linalg.norm(K @ v) <= 1e-5 * norm * np.linalg.norm(v)


def test_the_onset_hangs_neither_on_drag_nor_on_jitter(folding: Config, folded: History) -> None:
    onset = folded.onset
    assert onset is not None
    for values in ({"dissipation.number": 13.0}, {"mesh.node_jitter": 0.0}, {"dissipation.number": 0.13}):
        other = simulate(folding.with_overrides({**values, "growth.duration": 350.0, "growth.rate": 0.002}))
        assert other.onset is not None
        assert other.onset.growth_time == pytest.approx(onset.growth_time, rel=1e-4)
        assert other.onset.mode_number == onset.mode_number


def test_every_change_of_stability_is_stored(folded: History) -> None:
    changes, onset = folded.stability_changes, folded.onset
    assert onset is not None
    assert changes[0].growth_time == onset.growth_time
    assert (changes[0].n_before, changes[0].kind) == (0, "fold")
    assert len(changes) >= 2
    for before, after in pairwise(changes):
        assert after.n_before == before.n_after
        assert before.bracket[1] <= after.bracket[1]
        assert after.bracket[0] <= after.growth_time <= after.bracket[1]
    problem, duration = ideal(folded), folded.config.growth.duration
    for change in changes:
        state = grown(problem, problem.system(NO_PAIRS), change.bracket[1] / duration)
        assert state.tangent(problem.system(NO_PAIRS)).n_negative >= 1
    told = summarise(folded)["stability_changes"]
    assert [row["n_unstable"] for row in told] == [[c.n_before, c.n_after] for c in changes]


def test_drag_delays_the_folds_that_are_seen(folding: Config, folded: History) -> None:
    delays = [summarise(folded)["onset"]["visible_delay"]]
    less = simulate(folding.replace(**{"dissipation.number": 0.13}))
    delays.append(summarise(less)["onset"]["visible_delay"])
    assert delays[0] > delays[1] > 0.0
    assert summarise(folded)["visible_growth_time"] == visible_time(folded)


def test_a_state_held_by_drag_is_told_from_one_that_stays(folding: Config, folded: History) -> None:
    assert folded.relaxed is not None
    assert folded.stable is folded.relaxed.is_kept
    held = simulate(folding.with_overrides({"dissipation.number": 100.0, "growth.duration": 450.0}))
    assert held.stable is False
    assert held.relaxed is not None
    assert held.relaxed.gi_closing > 1.05
    summary = summarise(held)
    assert summary["gi"]["closing"] < 1.01
    assert "held by dissipation" in summary["stability_note"]
    assert summary["relaxed"]["n_gyri"] == held.relaxed.n_gyri
    smooth = simulate(folding.with_overrides({"dissipation.number": 100.0, "growth.duration": 200.0}))
    assert smooth.stable is True
    assert smooth.onset is None


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
    assert resumed.stability_changes == whole.stability_changes
    assert resumed.relaxed == whole.relaxed
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
    """Without dissipation a jittered slice drifts into folds along stable states, past its onset."""
    history = simulate(configured({**PERFECT, "mesh.node_jitter": 1e-3}))
    assert history.status == "completed"
    assert not any(history.negative_pivots.values())
    assert history.stable is True
    summary = summarise(history)
    threshold = critical_growth(history.config, "growth.time", range=(240.0, 360.0), points=4)
    assert summary["onset"]["growth_time"] == pytest.approx(threshold.critical_value, rel=1e-4)
    assert summary["gi"]["closing"] > 1.2


def test_following_needs_a_path_without_dissipation() -> None:
    with pytest.raises(ConfigError, match=r"stability\.follow_branch"):
        simulate(configured({**FOLDING, "stability.follow_branch": True}))
