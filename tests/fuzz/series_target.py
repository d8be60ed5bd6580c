"""``history.vtkhdf`` as `gyrify verify` sees it: known by its digest, never opened as HDF5."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NoReturn
from unittest import mock

from hdf5_damage import stored_run
from stored_targets import _patched
from target import Target

from gyrify.errors import HistoryError
from gyrify.store import History
from gyrify.verify.recheck import _check_series


def _opened(*_: object, **__: object) -> NoReturn:
    raise AssertionError("HDF5 was asked to open a file")


@contextlib.contextmanager
def unopened() -> Iterator[None]:
    """Make it a fault to have HDF5 open anything."""
    with mock.patch("h5py.h5f.open", _opened), mock.patch("h5py.h5f.create", _opened):
        yield


def series_reader(folder: Path) -> Callable[[bytes], object]:
    """Reader of a time series beside the journal of its run; refuses exactly what differs."""
    run = stored_run()
    (folder / "journal.sqlite").write_bytes(run["journal.sqlite"])
    history = History.load(folder)
    assert history.journal.meta("vtkhdf_sha256")

    def read(data: bytes) -> None:
        (folder / "history.vtkhdf").write_bytes(data)
        check = _check_series(history, folder)
        assert check.passed == (data == run["history.vtkhdf"])
        if not check.passed:
            raise HistoryError(check.sentence, "")

    return read


def _derived(folder: Path) -> Callable[[bytes], object]:
    """Each line changes bytes, as ``place: bytes``; other input is the file itself."""
    read, whole = series_reader(folder), stored_run()["history.vtkhdf"]
    return lambda data: read(_patched(whole, data))


TARGETS = (Target("derived", "`history.vtkhdf`, by its digest", _derived, unopened),)
