r"""Arrays as a page carries them: whole numbers of 16 or 32 bits, differenced, deflated, in base 64.

States follow each other smoothly, so that second differences along the states are small. They are folded to
the unsigned numbers 0, -1, 1, -2, 2 ... = 0, 1, 2, 3, 4 ... and split into planes of bytes, of which the
upper ones are then nearly empty; that is what makes them deflate well. Differences are taken modulo
:math:`2^{16}` or :math:`2^{32}`, so that summing them up again is exact.
"""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from gyrify.solve.types import FloatArray

Codes = NDArray[np.unsignedinteger[Any]]

# Number that stands for "undefined"; values are coded from 1 on.
UNDEFINED: Final = 0


@dataclass(frozen=True, eq=False)
class Coded:
    """Values as whole numbers: value = low + (code - 1) * step, row by row.

    Attributes
    ----------
    codes : (n_rows, n) uint16 array
        0 where the value is not a finite number.
    low, step : (n_rows,) float arrays
        Smallest value of each row, and the distance of two neighbouring codes.
    """

    codes: NDArray[np.uint16]
    low: FloatArray
    step: FloatArray


def coded(values: FloatArray, n_codes: int) -> Coded:
    """Code each row of values over its own range.

    Parameters
    ----------
    values : (n_rows, n) float array
        What to code; what is not finite is undefined.
    n_codes : int
        Distinct values of a row, 2 to 65535.

    Returns
    -------
    Coded
    """
    finite = np.isfinite(values)
    low = np.where(finite, values, np.inf).min(axis=1, initial=np.inf)
    high = np.where(finite, values, -np.inf).max(axis=1, initial=-np.inf)
    empty = ~np.isfinite(low)
    low[empty] = high[empty] = 0.0
    step = (high - low) / (n_codes - 1)
    scaled = (np.where(finite, values, 0.0) - low[:, None]) / np.where(step > 0.0, step, 1.0)[:, None]
    codes = np.where(finite, 1 + np.rint(scaled), UNDEFINED).astype(np.uint16)
    return Coded(codes, low, step)


@dataclass
class Payload:
    """Arrays of one run on their way into a page.

    Attributes
    ----------
    entries : list of dict
        Name, shape, bytes per number and order of differences of each array, in order.
    planes : list of bytes
        Their bytes.
    """

    entries: list[dict[str, Any]] = field(default_factory=list)
    planes: list[bytes] = field(default_factory=list)

    def add(self, name: str, codes: Codes, order: int) -> None:
        """Append an array.

        Parameters
        ----------
        name : str
            Under which the page finds it.
        codes : (n_rows, n) uint16 or uint32 array
            Whole numbers.
        order : int
            How many times to take differences of rows: 0, 1 or 2.
        """
        rows, columns = codes.shape
        entry = {"name": name, "rows": rows, "columns": columns, "bytes": codes.itemsize, "order": order}
        self.entries.append(entry)
        self.planes.append(_planes(codes, order))

    def deflated(self) -> bytes:
        """All arrays in one deflated stream (zlib's format)."""
        return zlib.compress(b"".join(self.planes), 9)

    def text(self) -> str:
        """The deflated stream in base 64."""
        return base64.b64encode(self.deflated()).decode("ascii")


def _planes(codes: Codes, order: int) -> bytes:
    """Bytes of an array: all lowest bytes first, then all next ones."""
    kind = np.dtype(f"<u{codes.itemsize}")
    differences = codes.astype(kind)
    for _ in range(order):
        differences = np.diff(differences, axis=0, prepend=np.zeros_like(differences[:1]))
    signed = differences.view(f"<i{kind.itemsize}")
    folded = ((signed << 1) ^ (signed >> (8 * kind.itemsize - 1))).astype(kind)
    return np.ascontiguousarray(folded).view(np.uint8).reshape(-1, kind.itemsize).T.tobytes()
