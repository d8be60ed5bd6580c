"""Full disks, no memory, clocks that jump, and two processes on one folder: a clear end, and nothing lost."""

from __future__ import annotations

import ctypes
import itertools
import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from gyrify import Config, History, Study, read_results, resume, run_study, simulate
from gyrify.cli import main
from gyrify.errors import HistoryError

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="limits of POSIX")
LINUX = pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="reads /proc")
TINY = {"n_around": 48, "n_layers": 6, "n_cortex_layers": 2}
STUDY = Study.from_mapping(
    {
        "keep": "all",
        "base": {"preset": "reference-slice", "mesh": TINY, "solver": {"increments": 8}},
        "design": {"kind": "grid", "parameter": [{"key": "seed", "values": [0, 1, 2]}]},
    }
)
# A run in a process that has so many megabytes beyond what a first run took.
STARVED = """
import resource, sys
from gyrify import Config, simulate
from gyrify.cli import main
from gyrify.report.outputs import write_outputs
tiny = {"mesh.n_around": 48, "mesh.n_layers": 6, "mesh.n_cortex_layers": 2, "solver.increments": 2}
write_outputs(simulate(Config.preset("reference-slice").with_overrides(tiny)), sys.argv[3])
pages = int(open("/proc/self/statm").read().split()[0])
size = int(pages * resource.getpagesize() + float(sys.argv[1]) * 1e6)
resource.setrlimit(resource.RLIMIT_AS, (size, size))
sys.exit(main(["run", sys.argv[2], "--out", sys.argv[3] + "/run", "--quiet"]))
"""
SECOND = "import sys; from gyrify.cli import main; sys.exit(main(sys.argv[1:]))"


@pytest.fixture
def small_files() -> Iterator[None]:
    """No file of this process may grow beyond 60 kB."""
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (60_000, hard))
    yield
    resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@POSIX
def test_a_study_on_a_full_disk_ends_by_name_and_goes_on(
    tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    expected = run_study(STUDY, tmp_path / "whole").table.column("result_hash").to_pylist()
    request.getfixturevalue("small_files")
    import resource

    try:
        told = "; ".join(run_study(STUDY, tmp_path / "study").failures.values())
    except HistoryError as fault:
        told = str(fault)
    assert "not be written" in told
    assert "Free space" in told or "Look at the space" in told

    resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    again = run_study(STUDY, tmp_path / "study", retry_failed=True)
    assert again.status == "completed"
    assert again.table.column("result_hash").to_pylist() == expected


@POSIX
@LINUX
@pytest.mark.parametrize(
    "room", [44, pytest.param(40, marks=pytest.mark.slow), pytest.param(56, marks=pytest.mark.slow)]
)
def test_a_run_without_memory_says_so_and_resumes(room: int, tmp_path: Path) -> None:
    config = Config.preset("reference-slice").with_overrides({"mesh.n_around": 432, "solver.increments": 4})
    config = config.with_overrides({"limits.wall_time": 20.0})
    (tmp_path / "config.toml").write_text(config.to_toml())
    command = [sys.executable, "-c", STARVED, str(room), str(tmp_path / "config.toml"), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode in (1, 3), done.stderr  # a machine of another kind may find enough
    assert "Traceback" not in done.stderr
    history = History.load(tmp_path / "run")
    assert history.status in ("failed", "stopped")
    assert "emory ran out" in history.reason or "wall-time" in history.reason
    assert main(["verify", str(tmp_path / "run")]) == 0


def test_pardiso_without_memory_does_not_blame_the_matrix(monkeypatch: pytest.MonkeyPatch) -> None:
    pardiso = pytest.importorskip("gyrify.solve.pardiso")
    try:
        solver = pardiso.Pardiso()
    except ImportError:
        pytest.skip("PARDISO is not installed")
    import numpy as np

    indptr, indices = np.array([0, 1, 2]), np.array([0, 1])
    solver.analyse(indptr, indices)
    assert solver.factorise(np.ones(2)).n_negative == 0

    def no_memory(*arguments: object) -> None:
        ctypes.cast(arguments[-1], ctypes.POINTER(ctypes.c_int32))[0] = -2  # type: ignore[arg-type]

    monkeypatch.setattr(solver._indefinite, "_pardiso", no_memory)
    with pytest.raises(MemoryError, match="out of memory"):
        solver.factorise(np.ones(2))
    monkeypatch.undo()


def test_memory_that_runs_out_while_preparing_is_on_record(
    tiny: Config, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def no_memory(_: object) -> None:
        raise MemoryError

    with monkeypatch.context() as patch:
        patch.setattr("gyrify.model.slice.Slice.compile", no_memory)
        file = tmp_path / "config.toml"
        file.write_text(tiny.to_toml())
        assert main(["run", str(file), "--out", str(tmp_path / "run"), "--quiet"]) == 1
    assert History.load(tmp_path / "run").reason == "Memory ran out."
    assert resume(tmp_path / "run").result_hash == simulate(tiny).result_hash


@pytest.mark.parametrize("jump", [1e9, -1e9])
def test_a_clock_that_jumps_changes_nothing(
    tiny: Config, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, jump: float
) -> None:
    expected = simulate(tiny).result_hash
    clock, jumps = time.time, itertools.count()
    monkeypatch.setattr(time, "time", lambda: clock() + (next(jumps) % 2) * jump)
    monkeypatch.setattr(time, "time_ns", lambda: int(1e9 * time.time()))
    file = tmp_path / "config.toml"
    file.write_text(tiny.with_overrides({"limits.wall_time": 600.0}).to_toml())
    assert main(["run", str(file), "--out", str(tmp_path / "run"), "--quiet"]) == 0
    history = History.load(tmp_path / "run")
    assert history.result_hash == expected
    assert 0.0 < history.wall_s < 600.0
    assert main(["verify", str(tmp_path / "run")]) == 0
    assert run_study(STUDY, tmp_path / "study").status == "completed"
    for file in tmp_path.rglob("*.json"):
        os.utime(file, (0, 0))  # files as old as can be are as good
    assert run_study(STUDY, tmp_path / "study").computed == 0


def test_of_two_processes_that_begin_one_run_exactly_one_does(tiny: Config, tmp_path: Path) -> None:
    expected, file, folder = simulate(tiny).result_hash, tmp_path / "config.toml", tmp_path / "run"
    file.write_text(tiny.to_toml())
    words = [sys.executable, "-c", SECOND, "run", str(file), "--out", str(folder), "--quiet"]
    racers = [subprocess.Popen(words, stderr=subprocess.PIPE, text=True) for _ in range(2)]
    said = [racer.communicate()[1] for racer in racers]
    assert sorted(racer.returncode for racer in racers) == [0, 2], said
    refused = said[[racer.returncode for racer in racers].index(2)]
    assert "in use by process" in refused or "already holds a run" in refused
    assert json.loads((folder / "summary.json").read_text())["result_hash"] == expected
    assert main(["verify", str(folder)]) == 0


def test_of_two_processes_on_one_study_one_is_refused(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(STUDY.to_toml())
    words = [sys.executable, "-c", SECOND, "study", str(tmp_path / "study.toml")]
    words += ["--out", str(tmp_path / "study"), "--workers", "1", "--quiet"]
    racers = [subprocess.Popen(words, stderr=subprocess.PIPE, text=True) for _ in range(2)]
    said = [racer.communicate()[1] for racer in racers]
    codes = sorted(racer.returncode for racer in racers)
    assert codes in ([0, 2], [0, 0]), said  # the second may come when the first has ended
    assert "Traceback" not in "".join(said)
    assert read_results(tmp_path / "study").num_rows == 3
