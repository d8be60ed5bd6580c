"""Calls in a fresh process: memory that is the call's own, and nothing warm from an earlier one."""

from __future__ import annotations

import importlib
import json
import os
import resource
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any

from bench.environment import HERE, ONE_THREAD


def isolated(function: str, *arguments: Any) -> dict[str, Any]:
    """Call ``module:name`` with JSON arguments in a process of its own.

    Returns
    -------
    dict
        What the function returned, with ``peak_memory`` [MB] of the process, and ``base_memory`` [MB] that it
        had when the function was called.

    Raises
    ------
    RuntimeError
        If the process fails; the message is the end of what it said.
    """
    command = [sys.executable, "-m", "bench.isolated", function, json.dumps(arguments)]
    done = subprocess.run(
        command, cwd=HERE, env={**os.environ, **ONE_THREAD}, capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        raise RuntimeError(f"{function} failed: {done.stderr.strip()[-2000:]}")
    return dict(json.loads(done.stdout.splitlines()[-1]))


def peak_memory() -> float:
    """Largest resident memory of this process so far [MB].

    Linux hands the peak of ``getrusage`` down from the parent, so that its own account is read where there is
    one.
    """
    own = _account("VmHWM")
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0 if own is None else own


def fresh_peak() -> float:
    """Forget the peak so far where the system allows it; the memory that the next one starts from [MB]."""
    with suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")
        return _account("VmRSS") or peak_memory()
    return peak_memory()


def _account(entry: str) -> float | None:
    """One entry of the process's account [MB]."""
    with suppress(OSError):
        for line in Path("/proc/self/status").read_text().splitlines():
            if line.startswith(f"{entry}:"):
                return float(line.split()[1]) / 1024.0
    return None


def _main() -> None:
    module, name = sys.argv[1].split(":")
    function = getattr(importlib.import_module(module), name)
    base = peak_memory()
    found = function(*json.loads(sys.argv[2]))
    print(json.dumps({**found, "base_memory": base, "peak_memory": peak_memory()}))


if __name__ == "__main__":
    _main()
