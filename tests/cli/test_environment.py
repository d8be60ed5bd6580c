"""What a command inherits from a notebook, a queue, a container or a terminal does not bring it down."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

import gyrify
from gyrify.cli.environment import tidy_environment
from gyrify.config import Config

INLINE = "module://matplotlib_inline.backend_inline"
# Refused by matplotlib on every machine; the notebook's own where its package is not installed.
UNKNOWN = "a_backend_that_is_not_here"
INHERITED = {
    "notebook": {"MPLBACKEND": INLINE},
    "unknown backend": {"MPLBACKEND": UNKNOWN},
    "no display": {"MPLBACKEND": "tkagg", "DISPLAY": ""},
    "plain locale": {"LC_ALL": "C", "LANG": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
    "unknown locale": {"LC_ALL": "xx_YY.UTF-8", "LANG": "xx"},
    "ascii streams": {"PYTHONIOENCODING": "ascii"},
    "warnings are errors": {"PYTHONWARNINGS": "error"},
    "no docstrings": {"PYTHONOPTIMIZE": "2"},
    "development mode": {"PYTHONDEVMODE": "1"},
    "threads that are none": {"OMP_NUM_THREADS": "abc", "MKL_NUM_THREADS": "-1", "NUMBA_NUM_THREADS": "0"},
    "threads in words": {"NUMBA_NUM_THREADS": "all", "PYTHONWARNINGS": "error"},
    "no width": {"COLUMNS": "0", "LINES": "0"},
    "width in words": {"COLUMNS": "wide", "LINES": "-1"},
    "dumb terminal": {"TERM": "dumb", "NO_COLOR": "1"},
    "forced colour": {"FORCE_COLOR": "1", "TERM": "xterm-256color"},
    "nothing compiled": {"NUMBA_DISABLE_JIT": "1"},
    "no folder of settings": {"MPLCONFIGDIR": "/dev/null/x", "NUMBA_CACHE_DIR": "/dev/null/x"},
}


def gyrify_with(variables: dict[str, str], *arguments: str) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(
        [sys.executable, "-m", "gyrify.cli", *arguments], env={**os.environ, **variables}, capture_output=True
    )


@pytest.fixture(scope="module")
def toml(tmp_path_factory: pytest.TempPathFactory, tiny: Config) -> Path:
    path = tmp_path_factory.mktemp("environment") / "tiny.toml"
    path.write_text(tiny.to_toml(), encoding="utf-8")
    return path


# Those that once ended in a traceback, or nearly so.
FAST = (
    "notebook",
    "unknown backend",
    "warnings are errors",
    "threads that are none",
    "no width",
    "nothing compiled",
)


@pytest.mark.parametrize(
    "variables",
    [pytest.param(v, id=k, marks=() if k in FAST else pytest.mark.slow) for k, v in INHERITED.items()],
)
def test_commands_work(variables: dict[str, str], toml: Path, tmp_path: Path) -> None:
    run = str(tmp_path / "run")
    for arguments in (
        ["--help"],
        ["config", "show", str(toml)],
        ["run", str(toml), "--out", run, "--quiet"],
        ["plot", run, "--out", str(tmp_path / "picture.png")],
    ):
        done = gyrify_with(variables, *arguments)
        assert done.returncode == 0, (arguments, done.stderr.decode(errors="replace"))
        assert b"Traceback" not in done.stderr
        assert done.stdout.strip()
    assert (tmp_path / "picture.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("command", [[], ["run"], ["config", "show"], ["study"]], ids=" ".join)
def test_help_is_whole_where_python_leaves_docstrings_out(command: list[str]) -> None:
    usual, bare = (gyrify_with(v, *command, "--help").stdout for v in ({}, {"PYTHONOPTIMIZE": "2"}))
    assert bare == usual


def test_only_what_is_wrong_is_set_aside(monkeypatch: pytest.MonkeyPatch) -> None:
    kept = {"COLUMNS": "120", "NUMBA_NUM_THREADS": "2"}
    for name, value in {**kept, "LINES": "1e3"}.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setenv("MPLBACKEND", INLINE)
    tidy_environment()
    assert {name: os.environ[name] for name in kept} == kept
    assert "LINES" not in os.environ
    assert os.environ["MPLBACKEND"] == "agg"


def test_a_backend_that_is_not_there_is_no_obstacle_in_python_either() -> None:
    code = "import gyrify.report.outputs, matplotlib, os; print(os.environ['MPLBACKEND'])"
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "MPLBACKEND": UNKNOWN},
        capture_output=True,
        text=True,
    )
    assert done.stdout.strip() == UNKNOWN, done.stderr  # left as it was for others


def read_only_copy(folder: Path) -> Path:
    """The package in a folder that nobody but the administrator can write to."""
    site = folder / "site"
    shutil.copytree(
        Path(gyrify.__file__).parent, site / "gyrify", ignore=shutil.ignore_patterns("__pycache__")
    )
    for path in (site, *site.rglob("*")):
        path.chmod(0o555 if path.is_dir() else 0o444)
    return site


STRANGER = 12345


@pytest.fixture
def as_stranger() -> list[str]:
    """Words before a command that a user without name and home carries out."""
    program = shutil.which("setpriv")
    if program is None:
        pytest.skip("needs setpriv to become another user")
    words = [program, "--reuid", str(STRANGER), "--regid", str(STRANGER), "--clear-groups"]
    if subprocess.run(
        [*words, sys.executable, "-c", "import numba"], capture_output=True, cwd="/"
    ).returncode:
        pytest.skip("only the administrator can become another user, who must be able to read this Python")
    return words


@pytest.fixture
def shared() -> Iterator[Path]:
    """A folder that other users can look into."""
    folder = Path(tempfile.mkdtemp(prefix="shared-"))
    folder.chmod(0o755)
    yield folder
    shutil.rmtree(folder)


def test_a_stranger_without_a_home_runs_a_read_only_installation(
    as_stranger: list[str], shared: Path, tiny: Config
) -> None:
    """As ``docker run --user 12345`` does, twice: the second run compiles nothing."""
    toml, site, scratch, work = shared / "tiny.toml", read_only_copy(shared), shared / "tmp", shared / "work"
    toml.write_text(tiny.to_toml(), encoding="utf-8")
    for folder in (scratch, work):
        folder.mkdir()
        folder.chmod(0o777)
    environment = {"PATH": os.environ["PATH"], "PYTHONPATH": str(site), "TMPDIR": str(scratch)}
    kept, compiled = scratch / f"gyrify-{STRANGER}", []
    for number in range(2):
        words = [sys.executable, "-m", "gyrify.cli", "run", str(toml), "--out", f"run{number}", "--quiet"]
        done = subprocess.run(
            [*as_stranger, *words], cwd=work, env=environment, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
        told = [line for line in done.stderr.splitlines() if "Warning" not in line]
        assert len(told) == 1, told
        assert f"compiled kernels are kept in {kept}. Set NUMBA_CACHE_DIR" in told[0]
        compiled.append({path.name for path in kept.rglob("*.nbc")})
    assert compiled[0]
    assert compiled[0] == compiled[1]
    assert kept.stat().st_mode & 0o777 == 0o700
    assert (kept / "matplotlib").is_dir()
    assert {path.name for path in work.iterdir()} == {"run0", "run1"}  # and no folder named ~
