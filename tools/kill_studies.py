"""Kill studies at random moments, on processes of their own and on a dask cluster, and run them again.

``python tools/kill_studies.py [--route processes|dask] [--kills 10] [--seed 0] [--records FILE]`` prints a
table and exits with 1 if a run that was finished is lost or computed again, or if the table of the study, or
a result hash in it, differs from that of a study that nobody killed.

Each trial is one command, ``gyrify study``, of which the whole process group, the command alone, or one of
its workers dies by SIGKILL. After a worker's death the command must come to its end by itself; after any
other, the same command is given again. The runs keep their folders, so that one that was killed resumes.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

os.environ.setdefault("OMP_NUM_THREADS", "1")

from gyrify import read_results

TEXT: Final = """
keep = "all"

[base]
preset = "reference-slice"
mesh.n_around = 72
mesh.n_layers = 7
mesh.n_cortex_layers = 3
solver.increments = 40

[design]
kind = "grid"

[[design.parameter]]
key = "growth.ratio"
values = [1.0, 3.6, 36.0]

[[design.parameter]]
key = "seed"
values = [0, 1]
"""
VICTIMS: Final = {"processes": ("group", "command", "worker"), "dask": ("worker", "command", "both workers")}


@dataclass
class Trial:
    """One study, what of it died and when, and what was left."""

    route: str
    number: int
    victim: str
    moment_s: float
    killed: bool = False
    finished: int = 0
    begun: int = 0
    n_lost: int = 0
    same: bool = False


class Cluster:
    """A dask scheduler and two workers, each a process; a worker that died is replaced."""

    def __init__(self) -> None:
        self._scheduler = self._start("dask_scheduler", "--host", "127.0.0.1", "--port", "0")
        assert self._scheduler.stderr is not None
        found = (re.search(r"Scheduler at:\s+(tcp://\S+)", line) for line in self._scheduler.stderr)
        self.address = next(match[1] for match in found if match)
        self.workers: list[subprocess.Popen[str]] = []
        self.heal()

    @staticmethod
    def _start(name: str, *arguments: str) -> subprocess.Popen[str]:
        command = [sys.executable, "-m", f"distributed.cli.{name}", *arguments, "--no-dashboard"]
        where = subprocess.PIPE if name == "dask_scheduler" else subprocess.DEVNULL
        log = {**os.environ, "DASK_DISTRIBUTED__LOGGING__DISTRIBUTED": "info"}
        return subprocess.Popen(command, stderr=where, text=True, env=log)

    def heal(self) -> None:
        """Have two living workers again, known to the scheduler."""
        from distributed import Client

        self.workers = [worker for worker in self.workers if worker.poll() is None]
        while len(self.workers) < 2:
            self.workers.append(self._start("dask_worker", self.address, "--nthreads", "1", "--no-nanny"))
        with Client(self.address, set_as_default=False) as client:
            client.wait_for_workers(2, timeout=120)

    def close(self) -> None:
        """End all processes."""
        for process in (*self.workers, self._scheduler):
            process.kill()
            process.wait()


def command(out: Path, cluster: Cluster | None) -> subprocess.Popen[bytes]:
    """``gyrify study`` as a process group of its own."""
    how = ["--workers", "2"] if cluster is None else ["--scheduler", cluster.address]
    words = [sys.executable, "-m", "gyrify.cli", "study", str(out.parent / "study.toml"), "--out", str(out)]
    nowhere = subprocess.DEVNULL
    return subprocess.Popen([*words, *how, "--quiet"], stdout=nowhere, stderr=nowhere, start_new_session=True)


def children(pid: int) -> list[int]:
    """Processes that a process began and that do its work: not the one that tracks what they share."""
    found = []
    for entry in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError, IndexError):
            parent = int((entry / "stat").read_text().rsplit(")", 1)[1].split()[1])
            if parent == pid and b"resource_tracker" not in (entry / "cmdline").read_bytes():
                found.append(int(entry.name))
    return sorted(found)


def strike(trial: Trial, process: subprocess.Popen[bytes], cluster: Cluster | None) -> None:
    """Kill what the trial names, if it is alive."""
    if process.poll() is not None:
        return
    pids: list[int] = [process.pid]
    if "worker" in trial.victim:
        pids = children(process.pid) if cluster is None else [worker.pid for worker in cluster.workers]
        pids = pids if trial.victim == "both workers" else pids[:1]
    for pid in pids:
        (os.killpg if trial.victim == "group" else os.kill)(pid, signal.SIGKILL)
    trial.killed = bool(pids)


def attempt(trial: Trial, folder: Path, cluster: Cluster | None) -> Path:
    """One study that is killed, and brought to its end."""
    out = folder / "out"
    folder.mkdir()
    (folder / "study.toml").write_text(TEXT, encoding="utf-8")
    process = command(out, cluster)
    deadline = time.monotonic() + trial.moment_s
    while not any(out.glob("runs/*/journal.sqlite")) and process.poll() is None:
        time.sleep(0.01)
        deadline = time.monotonic() + trial.moment_s  # counted from when it computes
    time.sleep(max(0.0, deadline - time.monotonic()))
    strike(trial, process, cluster)
    if cluster is not None:
        time.sleep(0.3)
        cluster.heal()
    if trial.victim in ("worker", "both workers"):
        trial.same = process.wait() == 0
        return out
    process.wait()
    time.sleep(0.7)  # workers notice that their command is gone, and let go of their folders
    before = finished(out)
    trial.finished = len(before)
    trial.begun = len(list(out.glob("runs/*/journal.sqlite"))) - len(before)
    trial.same = command(out, cluster).wait() == 0
    after = finished(out)
    trial.n_lost = sum(after.get(path) != when for path, when in before.items())
    return out


def finished(out: Path) -> dict[Path, int]:
    """Runs that are on record as ended, with the time of that."""
    files = out.glob("runs/*/point.json")
    return {
        path: path.stat().st_mtime_ns for path in files if '"summary"' in path.read_text(encoding="utf-8")
    }


def rows(out: Path) -> list[dict[str, Any]]:
    """The table of a study, with the hash of every run's states, without what time it took."""
    table = read_results(out).to_pylist()
    hashes = {
        path.parent.name: json.loads(path.read_text())["summary"]["result_hash"] for path in finished(out)
    }
    left_out = ("wall_s", "solver_wall_s")
    return [
        {"result_hash": hashes.get(row["key"]), **{k: v for k, v in row.items() if k not in left_out}}
        for row in table
    ]


def trials(route: str, count: int, seconds: float, chance: random.Random) -> Iterator[Trial]:
    """What is killed, in turn, and when."""
    for number in range(1, count + 1):
        victim = VICTIMS[route][number % 3]
        yield Trial(route, number, victim, chance.uniform(0.1, 0.9) * seconds)


def campaign(given: argparse.Namespace, folder: Path, cluster: Cluster | None) -> int:
    """Kill, compare, print, and return the number of studies that lost something or differ."""
    (folder / "study.toml").write_text(TEXT, encoding="utf-8")
    begun = time.perf_counter()
    assert command(folder / "whole", cluster).wait() == 0
    seconds = time.perf_counter() - begun
    expected, wrong, n_killed = rows(folder / "whole"), 0, 0
    print(f"undisturbed: {len(expected)} runs in {seconds:.1f} s\n")
    print("study  victim        after/s  finished  begun  lost  same result")
    for trial in trials(given.route, given.kills, 0.6 * seconds, random.Random(given.seed)):
        out = attempt(trial, folder / str(trial.number), cluster)
        trial.same = trial.same and rows(out) == expected
        wrong, n_killed = wrong + (trial.n_lost > 0 or not trial.same), n_killed + trial.killed
        left = f"{trial.finished:8d}  {trial.begun:5d}  {trial.n_lost:4d}  {'yes' if trial.same else 'NO'}"
        dead = trial.victim if trial.killed else "none"
        print(f"{trial.number:5d}  {dead:12}  {trial.moment_s:7.2f}  {left}", flush=True)
        if given.records is not None:
            with given.records.open("a", encoding="utf-8") as file:
                file.write(json.dumps(asdict(trial)) + "\n")
    print(f"\n{n_killed} studies killed; {wrong} lost something or differ.")
    return wrong


def main() -> int:
    """Kill studies, and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--route", choices=tuple(VICTIMS), default="processes")
    parser.add_argument("--kills", type=int, default=10)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--records", type=Path, help="file to append one JSON line per study to")
    given = parser.parse_args()
    folder = Path(tempfile.mkdtemp(prefix="kill-studies-"))
    cluster = Cluster() if given.route == "dask" else None
    try:
        return 1 if campaign(given, folder, cluster) else 0
    finally:
        if cluster is not None:
            cluster.close()
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(main())
