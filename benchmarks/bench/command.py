"""What a user waits for: the command line from its start to its end."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from bench.figures import Figure, Figures
from bench.slices import QUICK
from bench.timing import Sample, interleaved

PYTHON = [sys.executable, "-c"]
GYRIFY = [sys.executable, "-m", "gyrify.cli"]


def command(quick: bool) -> Figures:
    """`gyrify run` with all its files, cold and warm; imports; `--help`."""
    with tempfile.TemporaryDirectory() as scratch:
        caches = {"NUMBA_CACHE_DIR": f"{scratch}/numba", "MPLCONFIGDIR": f"{scratch}/matplotlib"}
        seconds = [_run(Path(scratch) / "run", caches, quick) for _ in range(3 if quick else 6)]
    found = [
        Figure("gyrify run, nothing compiled yet", seconds[0], "s"),
        Figure.of("gyrify run", Sample(tuple(seconds[1:]))),
    ]
    starts = {
        "gyrify --help": [*GYRIFY, "--help"],
        "import gyrify": [*PYTHON, "import gyrify"],
        "from gyrify import simulate": [*PYTHON, "from gyrify import simulate"],
        "python alone": [*PYTHON, "pass"],
    }
    tasks = {name: (lambda words=words: _call(words, {})) for name, words in starts.items()}
    times = interleaved(tasks, 3 if quick else 9, least=0.0, clock=time.perf_counter)
    return found + [Figure.of(name, sample) for name, sample in times.items()]


def _run(folder: Path, caches: dict[str, str], quick: bool) -> float:
    changes = [f"--set={key}={value}" for key, value in (QUICK if quick else {}).items()]
    words = ["run", "--preset", "reference-slice", "--quiet", "--overwrite", "--out", str(folder), *changes]
    spent = seconds_of([*GYRIFY, *words], caches)
    missing = [n for n in ("folded.png", "history.vtkhdf", "summary.json") if not (folder / n).exists()]
    if missing:
        raise RuntimeError(f"gyrify run left no {missing}")
    return spent


def seconds_of(words: list[str], environment: dict[str, str]) -> float:
    """Seconds of one call of a command."""
    begun = time.perf_counter()
    _call(words, environment)
    return time.perf_counter() - begun


def _call(words: list[str], environment: dict[str, str]) -> None:
    subprocess.run(words, env={**os.environ, **environment}, check=True, capture_output=True)
