"""Damaged HDF5 files: most changes go to what describes the arrays, not to the numbers in them."""

from __future__ import annotations

import contextlib
import functools
import random
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Final

from stored import tiny_config

AWKWARD: Final = (0, 1, 2, 7, 8, 0x7F, 0x80, 0xFF, 0xFFFF, 0x7FFFFFFF, 0xFFFFFFFF, 2**63 - 1, 2**64 - 1)
_IN_METADATA: Final = 0.8


@functools.cache
def stored_run() -> dict[str, bytes]:
    """Journal and time series of a tiny run, as `gyrify run` leaves them."""
    from gyrify.run.simulation import simulate
    from gyrify.store.vtkhdf import write_vtkhdf

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        history = simulate(tiny_config(), folder)
        with contextlib.closing(history.journal):
            write_vtkhdf(history, folder / "history.vtkhdf")
        return {file: (folder / file).read_bytes() for file in ("journal.sqlite", "history.vtkhdf")}


def metadata_places(whole: bytes) -> list[int]:
    """Places of a file that hold no array: superblock, headers, trees, heaps, names."""
    import io

    import h5py

    raw = bytearray(len(whole))

    def mark(_: str, node: object) -> None:
        if isinstance(node, h5py.Dataset):
            for start, size in _extents(node):
                raw[start : start + size] = b"\1" * size

    with h5py.File(io.BytesIO(whole), "r") as file:
        file.visititems(mark)
    return [place for place, is_raw in enumerate(raw) if not is_raw]


def _extents(dataset: object) -> Iterator[tuple[int, int]]:
    """Start and length of every stored piece of an array."""
    store = dataset.id  # type: ignore[attr-defined]
    if (start := store.get_offset()) is not None:
        yield start, store.get_storage_size()
    elif dataset.chunks is not None:  # type: ignore[attr-defined]
        for number in range(store.get_num_chunks()):
            info = store.get_chunk_info(number)
            yield info.byte_offset, info.size


class Damage:
    """A source of damaged copies of one file, each of them different from it.

    Parameters
    ----------
    whole : bytes
        The file.
    seed : int
        Seed of every choice.
    """

    def __init__(self, whole: bytes, seed: int) -> None:
        self.whole, self.random = whole, random.Random(seed)
        self.metadata = metadata_places(whole)
        self._ways: tuple[Callable[[bytearray], None], ...] = (
            self._flip,
            self._byte,
            self._integer,
            self._integer,
            self._copy,
            self._erase,
            self._truncate,
            self._shift,
        )

    def next(self) -> bytes:
        """The next damaged file."""
        data = bytearray(self.whole)
        while data == self.whole:
            for _ in range(self.random.choice((1, 1, 1, 2, 3, 6))):
                self.random.choice(self._ways)(data)
        return bytes(data)

    def _place(self, data: bytearray) -> int:
        in_metadata = self.random.random() < _IN_METADATA
        place = self.random.choice(self.metadata) if in_metadata else self.random.randrange(len(self.whole))
        return min(place, max(len(data) - 1, 0))

    def _flip(self, data: bytearray) -> None:
        if data:
            data[self._place(data)] ^= 1 << self.random.randrange(8)

    def _byte(self, data: bytearray) -> None:
        place = self._place(data)
        data[place : place + 1] = bytes(
            [self.random.choice((0, 1, 127, 128, 255, self.random.randrange(256)))]
        )

    def _integer(self, data: bytearray) -> None:
        """Put a size, a count or an address that is awkward, or one of another place."""
        size, place = self.random.choice((2, 4, 8)), self._place(data)
        number = self.random.choice((*AWKWARD, self.random.choice(self.metadata), len(data)))
        data[place : place + size] = (number % 256**size).to_bytes(size, "little")

    def _copy(self, data: bytearray) -> None:
        size, start, end = self.random.randrange(1, 96), self._place(data), self._place(data)
        data[end : end + size] = data[start : start + size]

    def _erase(self, data: bytearray) -> None:
        size, place = self.random.randrange(1, 64), self._place(data)
        data[place : place + size] = bytes(len(data[place : place + size]))

    def _truncate(self, data: bytearray) -> None:
        if self.random.random() < 0.3:
            del data[self.random.randrange(len(data) + 1) :]

    def _shift(self, data: bytearray) -> None:
        """Take bytes out, or put some in."""
        place, size = self._place(data), self.random.randrange(1, 16)
        if self.random.random() < 0.5:
            del data[place : place + size]
        else:
            data[place:place] = self.random.randbytes(size)
