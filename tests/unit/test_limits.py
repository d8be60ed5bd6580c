"""Limits on wall time and memory, and what an observer's exception leaves behind."""

from __future__ import annotations

import mmap
from pathlib import Path

import pytest

from gyrify.config import Config
from gyrify.errors import ConfigError, HistoryError, LimitReachedError
from gyrify.run.limits import Watch, resident_memory
from gyrify.run.simulation import Progress, new_run, resume, simulate
from gyrify.store import History


def test_watch_without_limits_never_raises() -> None:
    Watch(0.0, 0.0)()


def test_each_limit_raises_with_its_name() -> None:
    with pytest.raises(LimitReachedError, match=r"wall-time limit of 1e-09 s.*limits\.wall_time"):
        Watch(1e-9, 0.0)()
    with pytest.raises(LimitReachedError, match=r"memory limit of 1 MB.*limits\.memory"):
        Watch(0.0, 1.0)()


@pytest.mark.parametrize(("now", "is_reached"), [(99.9, False), (100.0, True), (1e6, True)])
def test_a_limit_is_reached_at_its_value_and_not_before(
    monkeypatch: pytest.MonkeyPatch, now: float, is_reached: bool
) -> None:
    clock = [5.0]
    monkeypatch.setattr("gyrify.run.limits.time.monotonic", lambda: clock[0])
    monkeypatch.setattr("gyrify.run.limits.resident_memory", lambda: now)
    watches = (Watch(100.0, 0.0), Watch(0.0, 100.0))
    clock[0] += now
    for watch in watches:
        if is_reached:
            with pytest.raises(LimitReachedError):
                watch()
        else:
            watch()


def test_resident_memory_is_of_this_process() -> None:
    # straight from the system: what earlier tests have freed is not used again
    before, block = resident_memory(), mmap.mmap(-1, 50_000_000)
    block.write(b"1" * 50_000_000)
    assert 30.0 < resident_memory() - before < 200.0
    block.close()


@pytest.mark.parametrize("limit", [{"limits.memory": 1.0}, {"limits.wall_time": 1e-6}])
def test_a_stopped_run_resumes_with_new_limits_to_the_same_result(
    tiny: Config, tmp_path: Path, limit: dict[str, float]
) -> None:
    stopped = simulate(tiny.with_overrides(limit), tmp_path)
    assert stopped.status == "stopped"
    assert next(iter(limit)) in stopped.advice
    assert resume(tmp_path).status == "stopped"
    history = resume(tmp_path, overrides=dict.fromkeys(limit, 0.0))
    assert history.status == "completed"
    assert history.reason == history.advice == ""
    assert history.result_hash == simulate(tiny).result_hash
    assert Config.load(tmp_path / "config.toml") == history.config == tiny


def test_nothing_else_of_a_stored_run_can_change(tiny: Config, tmp_path: Path) -> None:
    simulate(tiny, tmp_path)
    with pytest.raises(ConfigError, match="limits and output"):
        resume(tmp_path, overrides={"growth.ratio": 2.0})
    assert History.load(tmp_path).config == tiny


def test_an_observers_exception_propagates_and_leaves_the_state_saved(tiny: Config, tmp_path: Path) -> None:
    def observe(progress: Progress) -> None:
        if progress.state.index == 3:
            raise ValueError("enough")

    with pytest.raises(ValueError, match="enough"):
        simulate(tiny, tmp_path, observers=[observe])
    history = History.load(tmp_path)
    assert (len(history), history.status) == (4, "failed")
    assert "ValueError" in history.reason
    assert "enough" in history.reason
    assert resume(tmp_path).result_hash == simulate(tiny).result_hash


def test_an_interrupt_propagates_and_leaves_the_state_saved(tiny: Config, tmp_path: Path) -> None:
    def observe(progress: Progress) -> None:
        if progress.state.index == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        simulate(tiny, tmp_path, observers=[observe])
    assert (len(History.load(tmp_path)), History.load(tmp_path).status) == (3, "interrupted")
    assert resume(tmp_path).status == "completed"


def test_a_folder_is_held_until_the_block_ends(tiny: Config, tmp_path: Path) -> None:
    with new_run(tiny, tmp_path) as run:
        assert run.history.status == "running"
        with pytest.raises(HistoryError, match="in use"):
            resume(tmp_path)
        run.grow()
        with pytest.raises(HistoryError, match="in use"):
            simulate(tiny, tmp_path, overwrite=True)
    assert History.load(tmp_path).status == "completed"


def test_a_run_killed_before_its_first_state_resumes(tiny: Config, tmp_path: Path) -> None:
    expected = simulate(tiny, tmp_path).result_hash
    with new_run(tiny, tmp_path, overwrite=True) as run:
        run.journal._connection.execute("DELETE FROM increments")
    assert resume(tmp_path).result_hash == expected
