"""A resumed run ends with the bytes of an uninterrupted one, wherever and however it stopped."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from gyrify.config import Config
from gyrify.errors import HistoryError
from gyrify.run.simulation import Progress, resume, simulate
from gyrify.store import History

ROOT = Path(__file__).parents[2]


class Stop(Exception):
    """Ends a run after an increment."""


def stop_after(number: int) -> object:
    def observe(progress: Progress) -> None:
        if progress.state.index == number:
            raise Stop

    return observe


@pytest.mark.parametrize("number", [1, 12, 17, 20])
def test_resumed_run_is_the_same_to_the_last_bit(
    folding: Config, folded: History, tmp_path: Path, number: int
) -> None:
    with pytest.raises(Stop):
        simulate(folding, tmp_path, observers=[stop_after(number)])
    assert len(History.load(tmp_path)) == number + 1
    history = resume(tmp_path)
    assert history.status == "completed"
    assert history.positions == folded.positions
    for index in range(len(folded)):
        assert history.displacement(index).tobytes() == folded.displacement(index).tobytes()
    assert history.result_hash == folded.result_hash
    np.testing.assert_array_equal(history.residuals, folded.residuals)
    assert history.stats == folded.stats


def test_run_stopped_after_each_increment(tiny: Config, tmp_path: Path) -> None:
    expected = simulate(tiny)
    with pytest.raises(Stop):
        simulate(tiny, tmp_path, observers=[stop_after(1)])
    for number in range(2, len(expected) - 1):
        with pytest.raises(Stop):
            resume(tmp_path, observers=[stop_after(number)])
    assert resume(tmp_path).result_hash == expected.result_hash


def test_resuming_a_complete_run_changes_nothing(tiny: Config, tmp_path: Path) -> None:
    expected = simulate(tiny, tmp_path).result_hash
    seen: list[Progress] = []
    history = resume(tmp_path, observers=[seen.append])
    assert (history.status, history.result_hash, seen) == ("completed", expected, [])


def test_resuming_nothing(tmp_path: Path) -> None:
    with pytest.raises(HistoryError, match="no run in"):
        resume(tmp_path)
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(sys.platform == "win32", reason="needs fork and SIGKILL")
@pytest.mark.parametrize("options", [("3", "1"), pytest.param(("20", "5"), marks=pytest.mark.slow)])
def test_killed_runs_lose_nothing(options: tuple[str, str]) -> None:
    kills, commits = options
    command = [sys.executable, "tools/kill_runs.py", "--kills", kills, "--commits", commits]
    environment = {**os.environ, "PYTHONWARNINGS": "ignore"}
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    print(done.stdout, done.stderr)
    assert done.returncode == 0
    assert "\n0 accepted increments lost, 0 runs differ." in done.stdout
    found = re.search(r"(\d+) runs, (\d+) kills, (\d+) inside a commit", done.stdout)
    assert found is not None
    assert int(found[1]) >= int(kills)
    assert int(found[3]) >= int(commits)
