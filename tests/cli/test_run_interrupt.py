"""Ctrl-C and SIGTERM at any moment: exit code 130 within two seconds, nothing lost, no traceback."""

from __future__ import annotations

import contextlib
import json
import os
import random
import re
import signal
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import pytest

from gyrify.cli import main
from gyrify.config import Config
from gyrify.errors import HistoryError
from gyrify.run.simulation import simulate
from gyrify.store import History

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
LONGEST = 10.0  # a loaded machine is slow; a run that does not listen takes a minute
# Long enough to be interrupted, cheap to resume.
LONG = {"mesh.n_around": 48, "mesh.n_layers": 8, "mesh.n_cortex_layers": 3, "solver.increments": 300}
# SIGINT as a terminal's child has it, whatever runs the tests.
START = """
import os, signal, sys
signal.signal(signal.SIGINT, signal.SIG_DFL)
os.execv(sys.argv[1], sys.argv[1:])
"""


@dataclass(frozen=True)
class Interrupted:
    """How an interrupted run ended."""

    code: int
    latency: float
    stdout: str
    stderr: str


@pytest.fixture(scope="module")
def long() -> Config:
    return Config.preset("reference-slice").with_overrides(LONG)


@pytest.fixture(scope="module")
def expected(long: Config) -> str:
    return simulate(long).result_hash


def start(config: Config, folder: Path, *options: str) -> subprocess.Popen[str]:
    toml = folder.parent / "long.toml"
    toml.write_text(config.to_toml())
    command = [sys.executable, "-m", "gyrify.cli", "run", str(toml), "--out", str(folder), *options]
    return subprocess.Popen(
        [sys.executable, "-S", "-c", START, *command],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def interrupt(process: subprocess.Popen[str], *signals: int, pause: float = 0.05) -> Interrupted:
    begun = time.monotonic()
    for number in signals:
        process.send_signal(number)
        time.sleep(pause)
    stdout, stderr = process.communicate(timeout=30)
    return Interrupted(process.returncode, time.monotonic() - begun, stdout, stderr)


def await_increment(process: subprocess.Popen[str], folder: Path, number: int) -> None:
    until = time.monotonic() + 120.0
    while time.monotonic() < until:
        assert process.poll() is None, process.communicate()
        with contextlib.suppress(HistoryError):  # the journal is being made
            if len(History.load(folder)) > number:
                return
        time.sleep(0.02)
    raise TimeoutError


def check(end: Interrupted, folder: Path) -> None:
    """What holds whenever a run is interrupted."""
    assert end.latency < LONGEST, end
    if folder.exists():  # until the command line is loaded, an interrupt is the interpreter's to report
        assert "Traceback" not in end.stderr
        assert "Exception" not in end.stderr
    if end.code == 0 or "everything is written" in end.stderr:  # it came when all was done
        assert json.loads((folder / "summary.json").read_text())["status"] == "completed"
        return
    # Before the command line is loaded, SIGTERM has its usual effect.
    assert end.code == 130 or (end.code in (-signal.SIGTERM, -signal.SIGUSR1) and not folder.exists()), end
    if (folder / "journal.sqlite").exists():
        assert re.search(rf"gyrify resume {re.escape(str(folder))}$", end.stderr, re.MULTILINE), end


@pytest.mark.parametrize(
    "signals",
    [
        (signal.SIGTERM,),
        (signal.SIGINT, signal.SIGINT),
        (signal.SIGUSR1,),
        (signal.SIGUSR2, signal.SIGTERM),
        (signal.SIGXCPU,),
    ],
    ids=["term", "int-twice", "usr1", "usr2-and-term", "xcpu"],
)
def test_interrupt_in_the_midst_of_growth(
    long: Config, expected: str, tmp_path: Path, signals: tuple[int, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "run"
    process = start(long, folder, "--json")
    await_increment(process, folder, 10)
    end = interrupt(process, *signals)
    check(end, folder)
    document = json.loads(end.stdout)
    assert document == json.loads((folder / "summary.json").read_text())
    assert document["status"] == History.load(folder).status == "interrupted"
    assert signals[0] == signal.SIGINT or f"The signal {signals[0].name} ended it." in document["reason"]
    assert 10 < len(History.load(folder)) < 300
    assert not (folder / "run.owner.json").exists()
    capsys.readouterr()
    assert main(["resume", str(folder), "--json", "--quiet"]) == 0
    resumed = json.loads(capsys.readouterr().out)
    assert (resumed["status"], resumed["result_hash"]) == ("completed", expected)


@pytest.mark.parametrize(
    ("moment", "number"),
    [(0.15, signal.SIGINT), (0.5, signal.SIGINT), (1.0, signal.SIGINT), (1.0, signal.SIGUSR1)],
)
def test_interrupt_while_starting(long: Config, tmp_path: Path, moment: float, number: int) -> None:
    process = start(long, tmp_path / "run")
    time.sleep(moment)
    check(interrupt(process, number), tmp_path / "run")


def test_a_command_that_stores_nothing_ends_cleanly_too(tmp_path: Path) -> None:
    """`gyrify threshold` at a signal of a queue: the usual exit code and one JSON document."""
    command = [sys.executable, "-m", "gyrify.cli", "threshold", "--json", "--set", "mesh.n_around=600"]
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=tmp_path
    )
    until = time.monotonic() + 60.0
    mapped = Path(f"/proc/{process.pid}/maps")
    while mapped.exists() and "llvmlite" not in mapped.read_text() and time.monotonic() < until:
        time.sleep(0.05)
    end = interrupt(process, signal.SIGUSR1)
    assert end.code == 130, end
    assert json.loads(end.stdout)["error"] == "Interrupted"
    assert "Traceback" not in end.stderr


@pytest.mark.slow
def test_an_ignored_signal_stays_ignored(tiny: Config, tmp_path: Path) -> None:
    toml = tmp_path / "tiny.toml"
    toml.write_text(tiny.to_toml())
    ignoring = START.replace("SIG_DFL", "SIG_IGN")
    command = [
        sys.executable,
        "-m",
        "gyrify.cli",
        "run",
        str(toml),
        "--out",
        str(tmp_path / "run"),
        "--quiet",
    ]
    process = subprocess.Popen([sys.executable, "-S", "-c", ignoring, *command], stdout=subprocess.PIPE)
    for _ in range(5):
        time.sleep(0.2)
        os.kill(process.pid, signal.SIGINT)
    process.communicate()
    assert process.returncode == 0


def test_signals_are_as_before_after_a_run(tiny: Config, tmp_path: Path) -> None:
    toml = tmp_path / "tiny.toml"
    toml.write_text(tiny.to_toml())
    before = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)]
    assert main(["run", str(toml), "--out", str(tmp_path / "run"), "--quiet"]) == 0
    assert [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)] == before


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(20))
def test_interrupt_at_random_moments(long: Config, expected: str, tmp_path: Path, seed: int) -> None:
    chance, folder = random.Random(seed), tmp_path / "run"
    process = start(long, folder)
    time.sleep(chance.uniform(0.1, 4.0))
    if process.poll() is not None:
        process.communicate()
        pytest.skip("the run was done")
    known = [signal.SIGINT, signal.SIGTERM, signal.SIGUSR1]
    signals = [chance.choice(known) for _ in range(chance.choice([1, 1, 2, 3]))]
    end = interrupt(process, *signals, pause=chance.uniform(0.0, 0.3))
    print(f"latency {end.latency:.2f} s")
    check(end, folder)
    if (folder / "journal.sqlite").exists():
        assert main(["resume", str(folder), "--quiet"]) == 0
        assert History.load(folder).result_hash == expected
