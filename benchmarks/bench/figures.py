"""A measured number with its unit, and the record of a run of the benchmarks."""

from __future__ import annotations

import datetime
import json
import os
import platform
import subprocess
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from importlib import metadata
from pathlib import Path
from typing import Any

from bench.environment import HERE, ROOT
from bench.timing import Sample

HISTORY = HERE / "history.jsonl"
LIBRARIES = ("gyrify", "numpy", "scipy", "numba", "ipctk", "mkl", "scikit-fem", "felupe", "pyamg")


@dataclass(frozen=True)
class Figure:
    """One number.

    Attributes
    ----------
    name : str
        What it is, unique in its case.
    value : float
        Median of the measurements, or the number itself.
    unit : str
        Unit, ``x`` for a ratio, empty for a count.
    low, high : float or None
        Quartiles of repeated measurements.
    is_extrapolated : bool
        Whether it was calculated from measured constants instead of measured.
    """

    name: str
    value: float
    unit: str = ""
    low: float | None = None
    high: float | None = None
    is_extrapolated: bool = False

    @staticmethod
    def of(name: str, sample: Sample, unit: str = "s") -> Figure:
        """Median and quartiles of repeated measurements."""
        return Figure(name, sample.median, unit, sample.low, sample.high)


Figures = list[Figure]


def machine() -> dict[str, Any]:
    """The machine in words, with nothing that tells whose it is."""
    return {"cpu": _cpu(), "cores": os.cpu_count(), "system": f"{platform.system()} {platform.machine()}"}


def _cpu() -> str:
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.exists() else []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()


def versions() -> dict[str, str]:
    """Version by name, of Python and of the libraries that are installed."""
    found = {"python": platform.python_version()}
    for name in LIBRARIES:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    return found


def commit() -> str:
    """Abbreviated commit, with a plus where the sources differ from it."""
    try:
        name = _git("rev-parse", "--short=10", "HEAD")
        changed = _git("status", "--porcelain", "--untracked-files=no", "--", "src", "benchmarks/bench")
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return f"{name}+" if changed else name


def _git(*words: str) -> str:
    done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=True)
    return done.stdout.strip()


def record(found: dict[str, Figures], *, quick: bool) -> dict[str, Any]:
    """Everything of one run of the benchmarks."""
    return {
        "date": datetime.datetime.now(datetime.UTC).date().isoformat(),
        "commit": commit(),
        "quick": quick,
        "machine": machine(),
        "versions": versions(),
        "cases": {case: [_written(figure) for figure in figures] for case, figures in found.items()},
    }


def _written(figure: Figure) -> dict[str, Any]:
    return {key: value for key, value in asdict(figure).items() if value is not None and value is not False}


def append(entry: dict[str, Any], path: Path = HISTORY) -> None:
    """Add a record to the history, one line of JSON."""
    with path.open("a", encoding="utf-8") as file:
        file.write(json.dumps(entry, allow_nan=False) + "\n")


def latest(path: Path = HISTORY) -> dict[str, tuple[dict[str, Any], dict[str, Figure]]]:
    """For every case its latest record, a full one before a quick one, and its figures by name."""
    entries = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines() if line]
    found: dict[str, tuple[dict[str, Any], dict[str, Figure]]] = {}
    for entry in sorted(entries, key=lambda e: not e["quick"]):
        for case, figures in entry["cases"].items():
            found[case] = (entry, by_name(Figure(**figure) for figure in figures))
    return found


def by_name(figures: Iterable[Figure]) -> dict[str, Figure]:
    """Figures by name."""
    return {figure.name: figure for figure in figures}
