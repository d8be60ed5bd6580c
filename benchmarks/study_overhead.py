"""Measures what a study costs beyond its runs: overhead per run, two processes to one, dask to local.

Usage: python benchmarks/study_overhead.py [--runs N] [--standard] [--dask]

Overhead is the time that a study takes beyond solving and measuring, per run, in one process. Processes are
begun once per study, not once per run; their start is told apart. Quote only what an idle machine shows.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from gyrify import Study, run_study
from gyrify.study.solve import solve_point

SMALL = {
    "preset": "reference-slice",
    "mesh": {"n_around": 48, "n_layers": 6, "n_cortex_layers": 2},
    "solver": {"increments": 8},
}
MIDDLE = {"preset": "reference-slice", "mesh": {"n_around": 120}, "solver": {"increments": 40}}
STANDARD = {"preset": "reference-slice"}


def study(base: dict[str, Any], runs: int) -> Study:
    """Runs that differ in their seed, and so cost nearly the same."""
    seeds = {"key": "seed", "values": list(range(runs))}
    return Study.from_mapping({"base": base, "design": {"kind": "grid", "parameter": [seeds]}})


def timed(case: Study, **options: Any) -> tuple[float, float]:
    """Time of a study, and of its runs inside their workers [s]."""
    with tempfile.TemporaryDirectory() as folder:
        begun = time.perf_counter()
        found = run_study(case, Path(folder), **options)
        wall = time.perf_counter() - begun
    assert found.status == "completed"
    return wall, sum(record.wall_s for record in found.records.values())


def overhead(runs: int) -> None:
    """Print what a study in one process takes beyond its runs."""
    case = study(SMALL, runs)
    solve_point(case.points()[0].config)
    wall, inside = timed(case)
    print(f"one process, {runs} small runs: {1e3 * (wall - inside) / runs:.1f} ms per run beyond them")


@contextmanager
def warm_processes(number: int) -> Iterator[Executor]:
    """Processes that have loaded and compiled everything."""
    config = study(MIDDLE, 1).points()[0].config
    with ProcessPoolExecutor(number, get_context("spawn")) as pool:
        for future in [pool.submit(solve_point, config) for _ in range(2 * number)]:
            future.result()
        yield pool


def scaling(base: dict[str, Any], runs: int) -> float:
    """Print the ratio of one process to two; return the time that two take [s]."""
    case, walls = study(base, runs), []
    for number in (1, 2):
        with warm_processes(number) as pool:
            walls.append(timed(case, executor=pool)[0])
    cold = timed(case, workers=2)[0]
    print(f"{runs} runs: one process {walls[0]:.1f} s, two {walls[1]:.1f} s: ratio {walls[0] / walls[1]:.2f}")
    print(f"two processes with their start: {cold:.1f} s, ratio {walls[0] / cold:.2f}")
    return walls[1]


def with_dask(base: dict[str, Any], runs: int, local: float) -> None:
    """Print what two dask workers take, against two local processes."""
    import dask
    from distributed import LocalCluster

    # as docs/how-to-cluster.md advises
    environ = {"MALLOC_TRIM_THRESHOLD_": 2**30, "MALLOC_MMAP_THRESHOLD_": 2**28}
    dask.config.set({f"distributed.nanny.pre-spawn-environ.{name}": value for name, value in environ.items()})
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        address = cluster.scheduler_address
        timed(study(base, 4), scheduler=address)
        wall, _ = timed(study(base, runs), scheduler=address)
    print(f"dask, two workers: {wall:.1f} s, {100 * (wall / local - 1):+.0f} % of local")


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=24)
    parser.add_argument("--standard", action="store_true", help="whole standard runs instead of small ones")
    parser.add_argument("--dask", action="store_true")
    options = parser.parse_args()
    print(f"load average before: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    overhead(8 * options.runs)
    base = STANDARD if options.standard else MIDDLE
    local = scaling(base, options.runs)
    if options.dask:
        with_dask(base, options.runs, local)
    print(f"load average after: {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    main()
