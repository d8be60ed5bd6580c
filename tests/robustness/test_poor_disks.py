"""Disks without locks or shared memory, as a library under the process emulates them for one folder."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import signal
import socket
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

import pytest

from gyrify.cli import main
from gyrify.config import Config
from gyrify.errors import HistoryError
from gyrify.run.simulation import simulate
from gyrify.store import History, disks, soft_lock
from gyrify.store.journal import Journal
from gyrify.store.lock import SOFT_LOCK, run_lock
from gyrify.store.soft_lock import SoftLock

KINDS = ["maps", "records,maps", "records,files", "records,maps,files"]
# On a disk without speed, at least three seconds long on any machine, so that a reader finds it at work.
LONG = {"mesh.n_around": 96, "mesh.n_layers": 10, "mesh.n_cortex_layers": 4, "solver.increments": 300}


@pytest.fixture(scope="session")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The emulation, compiled."""
    compiler = shutil.which("gcc") or shutil.which("cc")
    if not sys.platform.startswith("linux") or compiler is None:
        pytest.skip("a C compiler on Linux makes the emulated disk")
    made = tmp_path_factory.mktemp("disk") / "poor_disk.so"
    source = Path(__file__).with_name("poor_disk.c")
    subprocess.run([compiler, "-shared", "-fPIC", "-o", made, source, "-ldl"], check=True)
    return made


@pytest.fixture
def disk(tmp_path: Path) -> Path:
    folder = tmp_path / "disk"
    folder.mkdir()
    return folder


def begin(library: Path, disk: Path, lacks: str, *arguments: str) -> subprocess.Popen[str]:
    """A command on a machine that has the folder on such a disk."""
    emulated = {"LD_PRELOAD": str(library), "POOR_DISK": str(disk), "POOR_DISK_LACKS": lacks}
    return subprocess.Popen(
        [sys.executable, "-m", "gyrify.cli", *arguments],
        env={**os.environ, **emulated},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def command(library: Path, disk: Path, lacks: str, *arguments: str) -> tuple[int, str, str]:
    process = begin(library, disk, lacks, *arguments)
    printed, said = process.communicate(timeout=120)
    return process.returncode, printed, said


def to_toml(config: Config, folder: Path) -> str:
    path = folder / "config.toml"
    path.write_text(config.to_toml())
    return str(path)


def test_the_emulation_lacks_what_it_should(library: Path, disk: Path) -> None:
    code = """
import sys, pathlib, mmap
from gyrify.store import disks
folder = pathlib.Path(sys.argv[1])
print(disks.has_record_locks(folder), disks.has_file_locks(folder))
with open(folder / "x", "w+b") as file:
    file.truncate(4096)
    mmap.mmap(file.fileno(), 4096)
"""
    for lacks, expected in (("records", "False True"), ("files", "True False"), ("maps", "True True")):
        emulated = {"LD_PRELOAD": str(library), "POOR_DISK": str(disk), "POOR_DISK_LACKS": lacks}
        done = subprocess.run(
            [sys.executable, "-c", code, disk], env={**os.environ, **emulated}, capture_output=True, text=True
        )
        assert done.stdout.strip() == expected
        assert ("No such device" in done.stderr) == (lacks == "maps")


@pytest.mark.parametrize("lacks", KINDS)
def test_a_run_and_what_reads_it_work(
    library: Path, disk: Path, tmp_path: Path, lacks: str, tiny: Config
) -> None:
    toml, folder = to_toml(tiny, tmp_path), disk / "run"
    code, printed, said = command(library, disk, lacks, "run", toml, "--out", str(folder), "--json")
    assert code == 0, said
    summary = json.loads(printed)
    assert summary["result_hash"] == simulate(tiny).result_hash
    for words in (["verify", str(folder)], ["plot", str(folder)], ["resume", str(folder)]):
        assert command(library, disk, lacks, *words)[0] == 0, words
    left = {path.name for path in folder.iterdir()}
    assert not {name for name in left if name.endswith(("-wal", "-shm", "-journal"))}
    assert SOFT_LOCK not in left
    # and on an ordinary machine, which sees the same disk
    assert History.load(folder).result_hash == summary["result_hash"]
    assert main(["resume", str(folder), "--quiet"]) == 0


@pytest.mark.parametrize("lacks", [pytest.param("maps", marks=pytest.mark.slow), "records,maps,files"])
def test_it_is_read_while_it_runs_then_killed_then_resumed(
    library: Path, disk: Path, tmp_path: Path, lacks: str
) -> None:
    config = Config.preset("reference-slice").with_overrides(LONG)
    folder = disk / "run"
    words = ("run", to_toml(config, tmp_path), "--out", str(folder), "--quiet")
    process = begin(library, disk, f"{lacks},speed", *words)
    seen = []
    until = time.monotonic() + 120
    while (not seen or seen[-1] < 10) and time.monotonic() < until:
        assert process.poll() is None, process.communicate()
        with contextlib.suppress(HistoryError):  # not yet made
            seen.append(len(History.load(folder)))
    assert seen[-1] >= 10
    assert seen == sorted(seen)
    process.send_signal(signal.SIGSTOP)
    code, _, said = command(library, disk, lacks, "resume", str(folder))  # it is in use
    assert code == 2
    assert f"in use by process {process.pid} on {socket.gethostname()}" in said
    process.send_signal(signal.SIGKILL)
    process.communicate()
    stored = len(History.load(folder))
    assert stored >= seen[-1]
    assert History.load(folder).status == "interrupted"
    code, printed, said = command(library, disk, lacks, "resume", str(folder), "--json", "--quiet")
    assert code == 0, said
    assert json.loads(printed)["result_hash"] == simulate(config).result_hash


def test_a_study_works(library: Path, disk: Path, tmp_path: Path) -> None:
    study = tmp_path / "study.toml"
    study.write_text(
        'keep = "all"\n[base]\nmesh = {n_around = 24, n_layers = 4, n_cortex_layers = 2}\n'
        'solver.increments = 3\n[design]\nkind = "grid"\n'
        '[[design.parameter]]\nkey = "growth.ratio"\nvalues = [2.0, 3.6]\n'
    )
    words = ["study", str(study), "--out", str(disk / "study"), "--workers", "2", "--json"]
    code, printed, said = command(library, disk, "records,maps,files", *words)
    assert code == 0, said
    assert json.loads(printed)["status"] == "completed"


def test_the_file_system_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mounts = tmp_path / "mounts"
    mounts.write_text(
        "/dev/sda1 / ext4 rw 0 0\nserver:/home /my\\040home nfs4 rw 0 0\n"
        "10.0.0.1@tcp:/scratch /scratch lustre rw 0 0\n"
    )
    monkeypatch.setattr(disks, "_MOUNTS", mounts)
    assert disks.file_system(Path("/my home/me/run")) == ("nfs4", "/my home")
    assert disks.file_system(Path("/scratch")) == ("lustre", "/scratch")
    assert disks.file_system(Path("/scratchy/run")) == ("ext4", "/")
    assert disks.is_shared(Path("/scratch/run"))
    assert not disks.is_shared(Path("/tmp"))
    from gyrify.store.database import translated

    for text in ("disk I/O error", "locking protocol", "database is locked"):
        with pytest.raises(HistoryError) as told, translated("/my home/run/journal.sqlite"):
            raise sqlite3.OperationalError(text)
        assert "It is on a disk of type nfs4 (mounted at /my home)." in told.value.message


def test_on_a_network_disk_one_process_keeps_the_journal_and_others_read(
    disk: Path, tiny: Config, monkeypatch: pytest.MonkeyPatch
) -> None:
    """SQLite's shared memory is not shared between machines: it is not used there."""
    monkeypatch.setattr(disks, "is_shared", lambda _: True)
    path = disk / "journal.sqlite"
    journal = Journal.create(path, {"config": tiny.to_toml()})
    journal.set_meta(status="running")
    assert Path(f"{path}-wal").exists()
    assert not Path(f"{path}-shm").exists()
    log = Path(f"{path}-wal").read_bytes()
    reader = Journal.open(path, read_only=True)
    assert reader.meta("status") == "running"
    reader.close()
    assert Path(f"{path}-wal").read_bytes() == log  # nothing was cleared away
    journal.set_meta(status="completed")
    journal.settle()
    assert Journal.open(path, read_only=True).meta("status") == "completed"
    assert Journal.open(path).meta("status") == "completed"  # and may be taken up


def test_a_file_that_is_locked_by_another_program_is_left_alone(disk: Path, tiny: Config) -> None:
    path = disk / "journal.sqlite"
    Journal.create(path, {"config": tiny.to_toml()}).close()
    other = sqlite3.connect(path, isolation_level=None)
    other.execute("PRAGMA locking_mode = EXCLUSIVE")
    other.execute("BEGIN EXCLUSIVE")
    with pytest.raises(HistoryError, match="Another process has locked this file"):
        Journal.open(path)
    other.close()


class TestSoftLock:
    """A lock by a file."""

    def test_one_at_a_time(self, tmp_path: Path) -> None:
        first, second = SoftLock(tmp_path / SOFT_LOCK), SoftLock(tmp_path / SOFT_LOCK)
        assert first.acquire()
        assert not second.acquire()
        second.release()  # what it does not hold
        assert (tmp_path / SOFT_LOCK).exists()
        first.release()
        assert not list(tmp_path.iterdir())
        assert second.acquire()
        second.release()

    def test_a_dead_process_of_this_machine_is_no_obstacle(self, tmp_path: Path) -> None:
        code = "import sys, os, pathlib; from gyrify.store.soft_lock import SoftLock\n"
        code += "print(SoftLock(pathlib.Path(sys.argv[1])).acquire(), flush=True); os._exit(0)"
        path = tmp_path / SOFT_LOCK
        done = subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True, check=True)
        assert done.stdout == "True\n"
        assert path.exists()
        lock = SoftLock(path)
        assert lock.acquire()
        lock.release()
        assert not list(tmp_path.iterdir())

    def test_another_machine_counts_as_alive_for_five_minutes(self, tmp_path: Path) -> None:
        path = tmp_path / SOFT_LOCK
        path.write_text(json.dumps({"pid": 1, "host": "elsewhere", "space": ""}))
        assert not SoftLock(path).acquire()
        with pytest.raises(HistoryError, match=r"remove .*run\.lock\.json"), run_lock(tmp_path):
            pass
        past = time.time() - soft_lock.STALE - 5
        os.utime(path, (past, past))
        lock = SoftLock(path)
        assert lock.acquire()
        lock.release()

    def test_the_holder_touches_its_file(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(soft_lock, "BEAT", 0.05)
        path = tmp_path / SOFT_LOCK
        lock = SoftLock(path)
        assert lock.acquire()
        os.utime(path, (0, 0))
        until = time.monotonic() + 5
        while path.stat().st_mtime < 1 and time.monotonic() < until:
            time.sleep(0.02)
        assert path.stat().st_mtime > 1
        lock.release()

    def test_of_many_processes_one_takes_a_stale_lock(self, tmp_path: Path) -> None:
        code = """
import sys, time, pathlib
from gyrify.store.soft_lock import SoftLock
while time.time() < float(sys.argv[2]): pass
print(SoftLock(pathlib.Path(sys.argv[1])).acquire(), flush=True)
time.sleep(float(sys.argv[2]) + 1.5 - time.time())
"""
        path = tmp_path / SOFT_LOCK
        path.write_text(json.dumps({"pid": 1, "host": "elsewhere", "space": ""}))
        os.utime(path, (0, 0))
        at = str(time.time() + 3.0)
        crowd = [
            subprocess.Popen([sys.executable, "-c", code, path, at], stdout=subprocess.PIPE, text=True)
            for _ in range(4)
        ]
        said = [process.communicate()[0].strip() for process in crowd]
        assert sorted(said) == ["False", "False", "False", "True"]
