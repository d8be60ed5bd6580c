"""One process at a time on a folder; a dead owner is explained, a living one named."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from gyrify.errors import HistoryError
from gyrify.store.lock import OWNER, has_owner, run_lock

HOLD = """
import sys, time, pathlib
from gyrify.store.lock import run_lock
with run_lock(pathlib.Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(60)
"""


@pytest.fixture
def holder(tmp_path: Path) -> subprocess.Popen[str]:
    process = subprocess.Popen([sys.executable, "-c", HOLD, tmp_path], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stdout.readline() == "held\n"
    yield process
    process.kill()
    process.wait()
    process.stdout.close()


def test_second_process_is_refused_with_the_pid_of_the_first(
    holder: subprocess.Popen[str], tmp_path: Path
) -> None:
    with pytest.raises(HistoryError, match=f"in use by process {holder.pid} on {socket.gethostname()}"):
        run_lock(tmp_path).__enter__()
    assert has_owner(tmp_path)


def test_killed_owner_is_explained_and_taken_over(holder: subprocess.Popen[str], tmp_path: Path) -> None:
    os.kill(holder.pid, signal.SIGKILL)
    holder.wait()
    assert not has_owner(tmp_path)
    with run_lock(tmp_path) as note:
        assert note.startswith(f"Process {holder.pid} on ")
        assert "ended without closing" in note
        assert has_owner(tmp_path)
        assert json.loads((tmp_path / OWNER).read_text())["pid"] == os.getpid()
    with run_lock(tmp_path) as note:
        assert note == ""


def test_lock_is_let_go_when_the_block_fails(tmp_path: Path) -> None:
    with pytest.raises(ZeroDivisionError), run_lock(tmp_path):
        raise ZeroDivisionError
    assert not (tmp_path / OWNER).exists()
    with run_lock(tmp_path) as note:
        assert note == ""


def test_the_same_process_cannot_enter_twice(tmp_path: Path) -> None:
    with run_lock(tmp_path), pytest.raises(HistoryError, match=f"process {os.getpid()} "):
        run_lock(tmp_path).__enter__()


@pytest.mark.parametrize("text", ["", "{}", "[]", '{"pid": "x", "host": 1}', "\xff"])
def test_unreadable_owner_is_no_obstacle(tmp_path: Path, text: str) -> None:
    (tmp_path / OWNER).write_text(text, encoding="latin-1")
    assert not has_owner(tmp_path)
    with run_lock(tmp_path) as note:
        assert "unknown process" in note


def test_an_owner_on_another_machine_counts_as_alive(tmp_path: Path) -> None:
    (tmp_path / OWNER).write_text(json.dumps({"pid": 1, "host": "elsewhere"}))
    assert has_owner(tmp_path)
