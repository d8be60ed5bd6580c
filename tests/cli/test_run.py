"""``gyrify run`` and ``gyrify resume``: what goes where, exit codes, progress, two processes, full disks."""

from __future__ import annotations

import contextlib
import json
import os
import re
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from gyrify.cli import main
from gyrify.config import Config
from gyrify.run.simulation import simulate
from gyrify.store import History

Capture = pytest.CaptureFixture[str]
WRITTEN = {"config.toml", "folded.png", "journal.sqlite", "metrics.csv", "summary.json"}
GYRIFY = (sys.executable, "-m", "gyrify.cli")


@pytest.fixture
def toml(tiny: Config, tmp_path: Path) -> str:
    path = tmp_path / "tiny.toml"
    path.write_text(tiny.to_toml())
    return str(path)


def test_a_run_writes_its_folder_and_says_what_it_came_to(toml: str, tmp_path: Path, capsys: Capture) -> None:
    assert main(["run", toml, "--out", str(tmp_path / "run")]) == 0
    out, err = capsys.readouterr()
    assert {file.name for file in (tmp_path / "run").iterdir()} >= WRITTEN
    assert out.startswith("GI ")
    assert str(tmp_path / "run") in out
    lines = [line for line in err.splitlines() if line.startswith("gyrify: growth time")]
    assert 8 <= len(lines) <= 11
    pattern = (
        r"gyrify: growth time [\d.]+ of 500, GI \d\.\d{3}, increment \d+, \d+ iterations, about \d+ s left"
    )
    assert all(re.fullmatch(pattern, line) for line in lines)


def test_json_is_one_document_and_quiet_leaves_nothing_but_warnings(
    toml: str, tmp_path: Path, capsys: Capture
) -> None:
    assert main(["run", toml, "--out", str(tmp_path / "run"), "--json", "--quiet"]) == 0
    out, err = capsys.readouterr()
    warnings = json.loads(out)["warnings"]
    assert err == "".join(f"gyrify: Warning: {warning}\n" for warning in warnings)
    assert any("points of the contour" in warning for warning in warnings)
    assert json.loads(out) == json.loads((tmp_path / "run" / "summary.json").read_text())
    assert json.loads(out)["status"] == "completed"


def test_json_beside_progress(toml: str, tmp_path: Path, capsys: Capture) -> None:
    assert main(["run", toml, "--out", str(tmp_path / "run"), "--json"]) == 0
    out, err = capsys.readouterr()
    assert json.loads(out)["status"] == "completed"
    assert "growth time 500 of 500" in err


def test_twice_into_the_default_folder(
    toml: str, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["run", toml, "--quiet"]) == 0
    (folder,) = (tmp_path / "runs").iterdir()
    assert folder.name == Config.load(toml).config_hash[:12]
    before = {file.name: file.read_bytes() for file in folder.iterdir()}
    capsys.readouterr()
    assert main(["run", toml, "--quiet"]) == 0
    assert capsys.readouterr().out.startswith("GI ")
    assert {file.name: file.read_bytes() for file in folder.iterdir()} == before
    (folder / "notes.txt").write_text("mine")
    assert main(["run", toml, "--quiet", "--overwrite"]) == 0
    assert (folder / "notes.txt").read_text() == "mine"
    assert main(["run", toml, "--quiet", "--seed", "1"]) == 0
    assert len(list((tmp_path / "runs").iterdir())) == 2


@pytest.mark.parametrize("limit", ["limits.wall_time=1e-6", "limits.memory=1"])
def test_a_limit_stops_cleanly_and_the_run_resumes(
    toml: str, tiny: Config, tmp_path: Path, capsys: Capture, limit: str
) -> None:
    folder = tmp_path / "run"
    assert main(["run", toml, "--out", str(folder), "--set", limit, "--json"]) == 3
    out, _ = capsys.readouterr()
    summary = json.loads(out)
    assert summary["status"] == "stopped"
    assert "limit" in summary["reason"]
    assert {file.name for file in folder.iterdir()} >= WRITTEN
    key = limit.partition("=")[0]
    assert main(["resume", str(folder), "--set", f"{key}=0", "--json"]) == 0
    out, _ = capsys.readouterr()
    assert json.loads(out)["result_hash"] == simulate(tiny).result_hash


def test_a_failed_run_keeps_what_it_had(toml: str, tmp_path: Path, capsys: Capture) -> None:
    folder = tmp_path / "run"
    options = ["--set", "solver.max_newton=2", "--set", "solver.min_increment=0.1"]
    assert main(["run", toml, "--out", str(folder), "--set", "mesh.n_layers=7", *options]) == 1
    err = capsys.readouterr().err
    assert "The run failed" in err
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["status"] == "failed"
    assert summary["advice"]
    assert len(History.load(folder)) >= 1


def test_two_processes_on_one_folder(tmp_path: Path, capsys: Capture) -> None:
    folder = tmp_path / "run"
    # A run that takes its time.
    first = subprocess.Popen(
        [*GYRIFY, "run", "--out", folder, "--quiet", "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    try:
        wait_for(folder / "journal.sqlite", first)
        for arguments in (["run", "--overwrite", "--out", str(folder)], ["resume", str(folder)]):
            assert main(arguments) == 2
            assert f"in use by process {first.pid} on " in capsys.readouterr().err
            assert first.poll() is None
    finally:
        first.kill()
        first.communicate()
    shown = History.load(folder)
    assert shown.status == "interrupted"
    assert "ended unexpectedly" in shown.reason


def wait_for(path: Path, process: subprocess.Popen[bytes]) -> None:
    until = time.monotonic() + 60.0
    while not path.exists():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < until
        time.sleep(0.01)


@pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminal")
def test_live_bar_on_a_terminal(toml: str, tmp_path: Path) -> None:
    text = in_terminal([*GYRIFY, "run", toml, "--out", str(tmp_path / "run")], columns=80)
    assert "100%" in text
    assert "time 500/500" in text
    assert re.search(r"GI \d\.\d{3}  increment \d+  \d+ iterations", text)
    assert re.search(r"\d\d:\d\d", text), "remaining time"
    assert text.count("\n") < 12, "the bar stays on its line"


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminal")
def test_no_bar_on_a_terminal_when_quiet(toml: str, tmp_path: Path) -> None:
    text = in_terminal([*GYRIFY, "run", toml, "--quiet", "--out", str(tmp_path / "run")], columns=80)
    lines = [line for line in text.splitlines() if not line.startswith("gyrify: Warning: ")]
    assert lines[0].startswith("GI ")


def in_terminal(arguments: list[str], columns: int) -> str:
    """Run a command in a pseudo-terminal, and return all that it shows."""
    import fcntl
    import pty
    import struct
    import termios

    parent, child = pty.openpty()
    fcntl.ioctl(child, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    environment = {
        key: value for key, value in os.environ.items() if key not in ("COLUMNS", "LINES", "NO_COLOR")
    }
    process = subprocess.Popen(
        arguments, stdin=child, stdout=child, stderr=child, env={**environment, "TERM": "xterm"}
    )
    os.close(child)
    shown = bytearray()
    with contextlib.suppress(OSError):  # the other end has closed
        while data := os.read(parent, 65536):
            shown += data
    os.close(parent)
    assert process.wait() == 0
    return re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", shown.decode())


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A disk of its own, too small for a run."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=140k", "none", str(disk)]
    try:
        is_mounted = subprocess.run(mount, capture_output=True, check=False).returncode == 0
    except OSError:
        is_mounted = False
    if not is_mounted:
        pytest.skip("mounting a small disk takes a superuser and Linux")
    yield disk
    subprocess.run(["umount", "-l", str(disk)], check=True)


def test_a_full_disk_keeps_what_was_accepted(
    toml: str, tiny: Config, small_disk: Path, capsys: Capture
) -> None:
    folder = small_disk / "run"
    assert main(["run", toml, "--out", str(folder)]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert "gyrify resume" in err
    assert err.count("space") == 1
    stored = History.load(folder)
    assert 1 < len(stored) < 9
    assert not list(folder.glob("*.partial"))
    assert main(["resume", str(folder), "--quiet"]) in (1, 2)
    assert len(History.load(folder)) == len(stored)
    capsys.readouterr()
    subprocess.run(["mount", "-o", "remount,size=4m", str(small_disk)], check=True)
    assert main(["resume", str(folder), "--json", "--quiet"]) == 0
    assert json.loads(capsys.readouterr().out)["result_hash"] == simulate(tiny).result_hash


def test_a_disk_without_a_byte_is_refused_at_once(toml: str, small_disk: Path, capsys: Capture) -> None:
    with contextlib.suppress(OSError):
        (small_disk / "filler").write_bytes(bytes(1_000_000))
    assert main(["run", toml, "--out", str(small_disk / "run")]) == 2
    _, err = capsys.readouterr()
    assert "Free space" in err
    assert "Traceback" not in err


def test_memory_that_runs_out_is_said_and_no_traceback(monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    def exhausted(*_: object, **__: object) -> None:
        raise MemoryError

    monkeypatch.setattr("gyrify.cli.app.app", exhausted)
    assert main(["run"]) == 1
    assert "Memory ran out." in capsys.readouterr().err
