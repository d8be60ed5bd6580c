"""Chunks of 32-bit floats for HDF5, compressed where it pays.

HDF5 shuffles a chunk (all lowest bytes first, then the next ones) and deflates it. Of a value's four bytes
only the sign and exponent byte is worth compressing: the mantissa is passed through in stored (uncompressed)
blocks of the same deflate stream. Where values are rounded to 16 significant bits, the lowest byte vanishes.
Any HDF5 with zlib reads the result.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gyrify.solve.types import FloatArray

# A small raw deflate state: quicker to set up, and the bytes of one plane repeat close by.
_WINDOW_BITS: Final = -12
_MEMORY_LEVEL: Final = 5
# Longest stored block of a deflate stream.
_LONGEST_BLOCK: Final = 65535


@dataclass(frozen=True)
class Layout:
    """How the values of a field lie in the file.

    Attributes
    ----------
    n_components : int
        Components in the file; those not in ``written`` are zero.
    written : tuple of int
        Components that are written.
    stored : tuple of int
        Bytes of a value, from the lowest, that are passed through uncompressed.
    rounded : bool
        Whether values are rounded to 16 significant bits.
    elsewhere : float
        Value of what is not written.
    """

    n_components: int = 1
    written: tuple[int, ...] = (0,)
    stored: tuple[int, ...] = (1, 2)
    rounded: bool = True
    elsewhere: float = 0.0


def encoded(values: FloatArray, layout: Layout) -> bytes:
    """One chunk as HDF5's shuffle and deflate filters store it: shuffled 32-bit floats in a zlib stream.

    Parameters
    ----------
    values : (n,) float array
        One component at one step.
    layout : Layout
        How to store it.

    Returns
    -------
    bytes
    """
    single = values.astype("<f4")
    if layout.rounded:
        bits = single.view("<u4")
        bits += 0x80
        bits &= 0xFFFFFF00
    planes = np.ascontiguousarray(single.view(np.uint8).reshape(-1, 4).T)
    checksum = zlib.adler32(planes.data)
    if not layout.stored:
        return zlib.compress(planes.data, 1)
    blocks = [b"\x78\x01"]
    for byte, plane in enumerate(planes):
        if layout.rounded and byte == 0:
            blocks.append(_deflated_zeros(plane.size))
        elif byte in layout.stored:
            blocks += _stored(plane)
        else:
            blocks.append(_deflated(plane))
    return b"".join([*blocks, b"\x03\x00", checksum.to_bytes(4, "big")])


def _stored(plane: NDArray[np.uint8]) -> Iterator[bytes]:
    """Uncompressed blocks of a deflate stream (RFC 1951, 3.2.4), none of them the last."""
    for start in range(0, plane.size, _LONGEST_BLOCK):
        block = plane[start : start + _LONGEST_BLOCK].tobytes()
        yield b"\x00" + len(block).to_bytes(2, "little") + (len(block) ^ 0xFFFF).to_bytes(2, "little")
        yield block


def _deflated(plane: NDArray[np.uint8]) -> bytes:
    """Compressed blocks of a deflate stream, none of them the last, padded to whole bytes."""
    stream = zlib.compressobj(1, zlib.DEFLATED, _WINDOW_BITS, _MEMORY_LEVEL)
    return stream.compress(plane.data) + stream.flush(zlib.Z_FULL_FLUSH)


@lru_cache(maxsize=8)
def _deflated_zeros(size: int) -> bytes:
    return _deflated(np.zeros(size, dtype=np.uint8))
