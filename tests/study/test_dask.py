"""A real dask scheduler with two worker processes, of which one is killed: nothing lost, equal hashes."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from small_study import BASE, GROWTH, rows

from gyrify import Study, read_results, run_study
from gyrify.errors import ConfigError
from gyrify.study import StudyProgress

distributed = pytest.importorskip("distributed")

# Long enough that both workers are at work when the first point ends.
SEEDS = {"key": "seed", "values": list(range(4))}
SLOWER = {**BASE, "solver": {"increments": 30}}
STUDY = Study.from_mapping({"base": SLOWER, "design": {"kind": "grid", "parameter": [GROWTH, SEEDS]}})


@contextmanager
def process(*arguments: str) -> Iterator[subprocess.Popen[str]]:
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "DASK_DISTRIBUTED__LOGGING__DISTRIBUTED": "info"}
    command = [sys.executable, "-m", *arguments, "--no-dashboard"]
    found = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=environment)
    try:
        yield found
    finally:
        found.kill()
        found.communicate()


@pytest.fixture(scope="module")
def cluster() -> Iterator[tuple[str, list[subprocess.Popen[str]]]]:
    """Address of a scheduler, and its two workers."""
    with process("distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0") as scheduler:
        assert scheduler.stderr is not None
        lines = (re.search(r"Scheduler at:\s+(tcp://\S+)", line) for line in scheduler.stderr)
        address = next(found[1] for found in lines if found)
        worker = ("distributed.cli.dask_worker", address, "--nthreads", "1", "--no-nanny")
        with process(*worker) as first, process(*worker) as second:
            with distributed.Client(address, set_as_default=False) as client:
                client.wait_for_workers(2, timeout=60)
            yield address, [first, second]


def busy(address: str, pid: int) -> bool:
    """Whether the scheduler has given work to a worker process."""
    with distributed.Client(address, set_as_default=False) as client:
        workers = {client.run(os.getpid, workers=[name])[name]: name for name in client.processing()}
        return bool(client.processing()[workers[pid]])


def test_a_killed_worker_loses_nothing(cluster: tuple[str, Any], tmp_path: Path) -> None:
    address, workers = cluster
    killed = []

    def kill(progress: StudyProgress) -> None:
        if progress.done == 2:
            killed.append(busy(address, workers[0].pid))
            workers[0].kill()

    found = run_study(STUDY, tmp_path / "dask", scheduler=address, observer=kill)
    assert killed == [True]
    assert workers[0].wait(10) != 0
    assert (found.status, found.computed) == ("completed", 8)
    local = run_study(STUDY, tmp_path / "local")
    assert rows(found.table) == rows(local.table)
    both = [(tmp_path / name / "results.parquet").read_bytes() for name in ("dask", "local")]
    assert both[0] == both[1]


@pytest.mark.slow
def test_a_study_begun_elsewhere_continues_here(cluster: tuple[str, Any], tmp_path: Path) -> None:
    def stop(progress: StudyProgress) -> None:
        if progress.done == 1:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_study(STUDY, tmp_path, scheduler=cluster[0], observer=stop)
    assert run_study(STUDY, tmp_path).computed == 8 - 1
    assert read_results(tmp_path).num_rows == 8
    assert run_study(STUDY, tmp_path, scheduler="tcp://127.0.0.1:1").computed == 0  # nobody is asked


def test_a_scheduler_that_is_not_there_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gyrify.study.executors._PATIENCE", "1s")
    for address in ("tcp://127.0.0.1:1", "nonsense://x", "tcp://"):
        with pytest.raises(ConfigError, match="No dask scheduler answers"):
            run_study(STUDY, tmp_path, scheduler=address)
