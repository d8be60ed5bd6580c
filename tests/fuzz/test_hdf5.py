"""Damaged time series: gyrify refuses each without HDF5, and HDF5 opens them where a crash does no harm."""

from __future__ import annotations

import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
from guard import guarded
from hdf5_damage import Damage, metadata_places, stored_run
from hdf5_opening import Opener
from series_target import series_reader, unopened

from gyrify.verify import verify

INPUTS = 150
# What `gyrify verify` does, then whether it has so much as loaded the library.
_VERIFY = """
import sys
from gyrify.cli import main
code = main(["verify", sys.argv[1]])
sys.exit(99 if "h5py" in sys.modules else code)
"""


@pytest.fixture
def run(tmp_path: Path) -> Path:
    """A run folder with a journal and a time series."""
    for name, data in stored_run().items():
        (tmp_path / name).write_bytes(data)
    return tmp_path


def test_each_damaged_file_is_refused_unopened_and_hdf5_survives_apart(tmp_path: Path) -> None:
    read, source = series_reader(tmp_path), Damage(stored_run()["history.vtkhdf"], 5)
    found: Counter[str] = Counter()
    with Opener() as opener:
        for _ in range(INPUTS):
            data = source.next()
            with unopened():
                outcome = guarded(read, data, tmp_path, limit=10.0)
            assert outcome.kind == "refused", outcome
            found[opener.open(tmp_path / "history.vtkhdf").kind] += 1
    assert found.total() == INPUTS
    assert min(found["read"], found["refused"]) > INPUTS // 10
    assert set(found) <= {"read", "refused", "memory", "crash", "hang"}


def test_the_whole_file_is_accepted_and_read(run: Path) -> None:
    whole = stored_run()["history.vtkhdf"]
    with unopened():
        assert guarded(series_reader(run), whole, run, limit=10.0).kind == "read"
    with Opener() as opener:
        assert opener.open(run / "history.vtkhdf").kind == "read"


@pytest.mark.parametrize("is_damaged", [False, True])
def test_verify_does_not_load_hdf5(run: Path, is_damaged: bool) -> None:
    if is_damaged:
        file = run / "history.vtkhdf"
        file.write_bytes(file.read_bytes()[:-1])
    ended = subprocess.run(
        [sys.executable, "-c", _VERIFY, str(run)], capture_output=True, text=True, check=False
    )
    assert ended.returncode == int(is_damaged), ended.stderr
    found = {check.name: check.passed for check in verify(run).checks}
    assert found["time series"] is not is_damaged


def test_an_open_by_hdf5_would_be_seen(run: Path) -> None:
    import h5py

    with unopened(), pytest.raises(AssertionError, match="asked to open"):
        h5py.File(run / "history.vtkhdf", "r")


@pytest.mark.parametrize(
    ("answer", "kind"),
    [
        ("os.kill(os.getpid(), 11)", "crash"),
        ("os._exit(0)", "crash"),
        ("time.sleep(60)", "hang"),
        ("os.kill(os.getpid(), 27)", "hang"),
        ("print('refused OSError', flush=True)", "refused"),
    ],
)
def test_what_becomes_of_the_process_is_counted(answer: str, kind: str, tmp_path: Path) -> None:
    program = f"import os, time\nprint('ready', flush=True)\nwhile input():\n    {answer}"
    with Opener((sys.executable, "-c", program), longest=1.0) as opener:
        assert [opener.open(tmp_path).kind for _ in range(2)] == [kind, kind]
        assert not opener.open(tmp_path).is_fault


def test_the_process_has_little_memory_and_may_not_write(tmp_path: Path) -> None:
    import h5py
    import numpy as np

    with h5py.File(tmp_path / "huge", "w") as file:
        file.create_dataset("x", shape=(2**28,), dtype=np.float64, chunks=(2**16,))
    with Opener() as opener:
        assert opener.open(tmp_path / "huge").kind == "memory"
        assert opener.open(tmp_path / "not there").told == "FileNotFoundError"


def test_damage_is_different_repeatable_and_mostly_to_what_describes() -> None:
    whole = stored_run()["history.vtkhdf"]
    metadata = set(metadata_places(whole))
    assert len(whole) * 0.3 < len(metadata) < len(whole)
    assert set(range(8)) <= metadata
    source, again = Damage(whole, 1), Damage(whole, 1)
    found = [source.next() for _ in range(200)]
    assert found == [again.next() for _ in range(200)]
    assert whole not in found
    assert len(set(found)) > 190
    assert any(len(data) < len(whole) // 2 for data in found)
    assert any(len(data) > len(whole) for data in found)
