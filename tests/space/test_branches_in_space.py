"""A perfect patch leaves its smooth equilibrium to the chosen side, and stays in a stable one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from solids import config
from test_thresholds_in_space import FILM

from gyrify.errors import SolveError
from gyrify.run.running import Progress
from gyrify.run.simulation import resume, simulate
from gyrify.run.summary import summarise, write_metrics, write_summary
from gyrify.verify.recheck import verify

ALONE = {
    **FILM,
    "growth.duration": 150.0,
    "dissipation.kind": "none",
    "mesh.node_jitter": 0.0,
    "stability.detect": True,
    "solver.increments": 6,
}


@pytest.mark.parametrize("sign", [1, -1])
def test_a_branch_is_followed_to_the_chosen_side(sign: int) -> None:
    body = config(ALONE, **{"stability.follow_branch": True, "stability.sign": sign})
    history = simulate(body)
    summary, onset = summarise(history), history.onset
    assert history.status == "completed"
    assert onset is not None
    assert onset.growth_time == pytest.approx(114.8, abs=0.1)
    assert (onset.kind, onset.mode_number) == ("fold", 1)
    assert summary["stable"] is True
    assert summary["gi"]["area"]["closing"] > 1.05
    # flat until then, and where the mode points outwards the fold does, or the other way round
    heights = [history.points(index)[history.mesh.contour, 2] for index in range(len(history))]
    flat = history.growth_times < onset.growth_time
    assert np.ptp(heights[np.flatnonzero(flat)[-1]]) < 1e-6
    mode = onset.vector[history.mesh.contour, 2]
    assert sign * (mode @ (heights[-1] - heights[-1].mean())) > 0.5 * np.linalg.norm(mode)
    # folding lowers the energy below that of the flat state
    energy = history.slice.elastic_energy(history.slice.kinematics(float(history.growth_times[-1])))
    folded = energy.evaluate(history.state_vector(), 0).value
    rising = np.zeros_like(history.state_vector())
    scale = (np.mean(heights[-1]) - 20.0) / 20.0
    rising[:, 2] = history.mesh.points[:, 2] * scale
    assert folded < energy.evaluate(rising, 0).value


def test_a_followed_branch_is_taken_up_to_the_same_bytes_and_verified(tmp_path: Path) -> None:
    class Enough(Exception):
        pass

    def stop(progress: Progress) -> None:
        if progress.state.index == 5:  # the first one past the onset
            raise Enough

    body = config(ALONE, **{"stability.follow_branch": True})
    with pytest.raises(Enough):
        simulate(body, tmp_path / "cut", observers=[stop])
    resumed = resume(tmp_path / "cut")
    assert resumed.result_hash == simulate(body).result_hash
    assert resumed.onset is not None
    assert resumed.onset.vector.shape == resumed.mesh.points.shape
    write_metrics(resumed, tmp_path / "cut" / "metrics.csv")
    write_summary(summarise(resumed), tmp_path / "cut" / "summary.json")
    found = verify(tmp_path / "cut")
    assert [check.sentence for check in found.checks if not check.passed] == []
    assert {"energy balance", "descent", "metrics.csv"} <= {check.name for check in found.checks}


def test_without_a_side_the_run_ends_with_the_evidence() -> None:
    with pytest.raises(SolveError, match="Buckling instability") as failure:
        simulate(config(ALONE))
    assert "mode 1" in str(failure.value)
    assert "stability.follow_branch" in failure.value.advice
