"""The pool: results as they come, and a process that dies costs no more than its own item."""

from __future__ import annotations

import os
import signal
import sys
from contextlib import closing
from functools import partial
from pathlib import Path

import pytest

from gyrify.base.pool import Watcher, each
from gyrify.errors import GyrifyError


def triple(item: int, watch: Watcher) -> int:
    watch()
    if item < 0:
        os.kill(os.getpid(), signal.SIGKILL)
    return 3 * item


def threads(_: int, __: Watcher) -> str:
    return os.environ["OMP_NUM_THREADS"] + os.environ["MKL_NUM_THREADS"]


def linger(item: int, watch: Watcher, folder: Path) -> int:
    """Say that it began, and end only when it is told to."""
    if item == 0:
        return 0
    (folder / "begun").touch()
    try:
        while True:
            watch()
    finally:
        (folder / "ended").touch()


@pytest.mark.parametrize("workers", [1, 2])
def test_every_item_has_its_result(workers: int) -> None:
    assert sorted(each(triple, range(7), workers, lambda item: item)) == [3 * n for n in range(7)]


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_a_process_that_dies_costs_its_own_item_alone() -> None:
    found = list(each(triple, [1, 2, -1, 3, 4, 5], 2, lambda item: 100 * item))
    assert sorted(found) == [-100, 3, 6, 9, 12, 15]


def test_processes_compute_with_one_thread() -> None:
    before = dict(os.environ)
    assert set(each(threads, range(2), 2, str)) == {"11"}
    assert dict(os.environ) == before


def test_closing_ends_processes_at_a_safe_place(tmp_path: Path) -> None:
    with closing(each(partial(linger, folder=tmp_path), [0, 1], 2, int)) as found:
        assert next(found) == 0
        while not (tmp_path / "begun").exists():
            pass
    assert (tmp_path / "ended").exists()


def test_processes_that_cannot_begin_are_told_from_items_that_kill(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gyrify.base.pool._begin_worker", dies_at_once)
    with pytest.raises(GyrifyError, match="No process for the runs could be started"):
        list(each(triple, [1, 2], 2, lambda item: item))


def dies_at_once(*_: object) -> None:
    os._exit(1)
