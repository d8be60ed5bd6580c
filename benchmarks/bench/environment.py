"""The environment that the benchmarks run in: gyrify, PARDISO and the libraries it is compared with."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent.parent
ROOT = HERE.parent
VENV = HERE / ".venv"
REQUIREMENTS = HERE / "environment" / "requirements.txt"
# One thread everywhere: that is what a study runs with, and what makes the comparisons fair.
_THREADS = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS")
ONE_THREAD = dict.fromkeys(_THREADS, "1")


def is_inside() -> bool:
    """Whether this interpreter is the one of the environment, with one thread."""
    return Path(sys.prefix).resolve() == VENV and all(os.environ.get(n) == v for n, v in ONE_THREAD.items())


def enter() -> int:
    """Make the environment if it is missing or outdated, and run this command again inside it."""
    python = VENV / "bin" / "python"
    stamp, wanted = VENV / "installed", _wanted()
    if not python.exists():
        print(f"Making {VENV.relative_to(ROOT)} (once).", file=sys.stderr)
        subprocess.run([sys.executable, "-m", "venv", VENV], check=True)
    if not stamp.exists() or stamp.read_text() != wanted:
        _install(python)
        stamp.write_text(wanted)
    command = [str(python), str(HERE), *sys.argv[1:]]
    return subprocess.run(command, env={**os.environ, **ONE_THREAD}, check=False).returncode


def _wanted() -> str:
    """Digest of everything that decides what is installed."""
    sources = (REQUIREMENTS, ROOT / "pyproject.toml", ROOT / "constraints.txt")
    return hashlib.sha256(b"".join(source.read_bytes() for source in sources)).hexdigest()


def _install(python: Path) -> None:
    pip = [str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    constraints = ["-c", str(ROOT / "constraints.txt")]
    fast = [*pip, *constraints, "-e", f"{ROOT}[fast]"]
    if subprocess.run(fast, check=False).returncode != 0:  # no PARDISO for this machine
        subprocess.run([*pip, *constraints, "-e", str(ROOT)], check=True)
    subprocess.run([*pip, *constraints, "-r", str(REQUIREMENTS)], check=True)
