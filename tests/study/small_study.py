"""A study that is cheap and still folds, and helpers to run it as a command."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from gyrify.study import Study

BASE: dict[str, Any] = {
    "preset": "reference-slice",
    "mesh": {"n_around": 48, "n_layers": 6, "n_cortex_layers": 2},
    "solver": {"increments": 8},
}
GROWTH = {"key": "growth.ratio", "values": [1.0, 3.6]}
STIFFNESS = {"key": "material.stiffness_ratio", "values": ["1/1.36", 1.0]}
# Without drag and jitter, a stiff cortex buckles where no increment can follow.
FAILING = {"dissipation.kind": "none", "mesh.node_jitter": 0.0, "material.stiffness_ratio": 3.0}

TEXT = """
[base]
preset = "reference-slice"
mesh.n_around = 48
mesh.n_layers = 6
mesh.n_cortex_layers = 2
solver.increments = {increments}

[design]
kind = "grid"

[[design.parameter]]
key = "growth.ratio"
values = [1.0, 3.6]

[[design.parameter]]
key = "dissipation.number"
values = ["1/2", 1.3]
"""
LISTENING = """
import os, signal, sys
signal.signal(signal.SIGINT, signal.SIG_DFL)
os.execv(sys.argv[1], sys.argv[1:])
"""


def study(*parameters: dict[str, Any], kind: str = "grid", **design: Any) -> Study:
    """A study of the small slice."""
    return Study.from_mapping(
        {"base": BASE, "design": {"kind": kind, "parameter": list(parameters), **design}}
    )


def rows(table: Any) -> list[dict[str, Any]]:
    """Rows without what differs from one run of a study to the next."""
    return [{key: value for key, value in row.items() if key != "wall_s"} for row in table.to_pylist()]


def start(file: Path, out: Path, *options: str) -> subprocess.Popen[str]:
    """``gyrify study`` as a process that listens to Ctrl-C, in a group of its own."""
    command = [sys.executable, "-m", "gyrify.cli", "study", str(file), "--out", str(out), *options]
    return subprocess.Popen(
        [sys.executable, "-S", "-c", LISTENING, *command],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def end_when(
    process: subprocess.Popen[str], is_time: Callable[[], bool], number: int
) -> tuple[int, str, str]:
    """Send a signal to the whole group once it is time; return code, stdout and stderr."""
    deadline = time.monotonic() + 120.0
    while not is_time():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.02)
    os.killpg(process.pid, number) if number != signal.SIGKILL else process.kill()
    printed, said = process.communicate(timeout=60)
    return process.returncode, printed, said
