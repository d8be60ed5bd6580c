"""Accepted increments as rows of the journal, by the names of their columns; and their internal variables."""

from __future__ import annotations

import hashlib
import sqlite3
from collections.abc import Iterator, Mapping
from dataclasses import astuple
from typing import Any, Final, NamedTuple

import numpy as np

from gyrify.solve.problem import State
from gyrify.solve.result import Stats
from gyrify.solve.types import FloatArray
from gyrify.store.integrity import digest, is_sound
from gyrify.store.tables import INTERNAL

QUERY: Final = (
    "SELECT number, position, span, next_span, residual, newton_iterations, factorizations, analyses, "
    "rejected, wall_s, displacement, couplings, digest FROM increments WHERE number = ?"
)


class IncrementRow(NamedTuple):
    """A row of the table ``increments``."""

    number: int
    position: int
    span: int
    next_span: int
    residual: float
    newton_iterations: int
    factorizations: int
    analyses: int
    rejected: int
    wall_s: float
    displacement: Any
    couplings: Any
    digest: bytes

    @staticmethod
    def of(state: State, wall_s: float) -> IncrementRow:
        """Row of a state that took so long [s]."""
        u = np.ascontiguousarray(state.u, dtype="<f8").tobytes()
        couplings = np.ascontiguousarray(state.couplings, dtype="<i4").tobytes()
        facts = (state.index, state.position, state.span, state.next_span, state.residual)
        numbers = (*facts, *astuple(state.stats))
        return IncrementRow._make((*numbers, wall_s, u, couplings, digest(numbers, u, couplings)))

    @property
    def is_undamaged(self) -> bool:
        """Whether its checksum is right."""
        if not (isinstance(self.displacement, bytes) and isinstance(self.couplings, bytes)):
            return False
        numbers = tuple(self)[: self._fields.index("wall_s")]
        return digest(numbers, self.displacement, self.couplings) == self.digest

    def is_possible(self, position_before: int, n_dim: int) -> bool:
        """Whether it holds what a run in so many dimensions could have written after another position."""
        whole = (*self[:4], *self[5:9])
        return is_sound(
            whole, (self.residual, self.wall_s), (self.displacement, self.couplings), position_before, n_dim
        )

    def u(self, n_dim: int) -> FloatArray:
        """(n_rows, n_dim) displacement [mm]."""
        return np.frombuffer(self.displacement, dtype="<f8").astype(np.float64).reshape(-1, n_dim)

    def state(self, n_dim: int, u_before: FloatArray | None, internal: Mapping[str, FloatArray]) -> State:
        """Everything that the next increment depends on."""
        u = self.u(n_dim)
        return State(
            index=self.number,
            position=self.position,
            u=u,
            span=self.span,
            u_before=np.zeros_like(u) if u_before is None else u_before,
            next_span=self.next_span,
            couplings=np.frombuffer(self.couplings, dtype="<i4").astype(np.int64).reshape(-1, 2),
            residual=self.residual,
            stats=Stats(self.newton_iterations, self.factorizations, self.analyses, self.rejected),
            internal=internal,
        )


def has_internal(connection: sqlite3.Connection) -> bool:
    """Whether a journal has internal variables."""
    query = "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = 'internal'"
    return bool(connection.execute(query).fetchone()[0])


def add_internal(connection: sqlite3.Connection, number: int, internal: Mapping[str, FloatArray]) -> None:
    """Insert the internal variables of an increment; call it inside a transaction."""
    if internal and not has_internal(connection):
        connection.execute(INTERNAL.strip().rstrip(";"))
    for name, values in sorted(internal.items()):
        data = np.ascontiguousarray(values, dtype="<f8").tobytes()
        shape = ",".join(map(str, values.shape))
        row = (number, name, shape, data, _digest(number, name, shape, data))
        connection.execute("INSERT INTO internal VALUES (?, ?, ?, ?, ?)", row)


def read_internal(connection: sqlite3.Connection, number: int) -> dict[str, FloatArray]:
    """Internal variables of an increment, by name.

    Raises
    ------
    ValueError
        If one is damaged.
    """
    if not has_internal(connection):
        return {}
    query = "SELECT name, shape, data, digest FROM internal WHERE number = ? ORDER BY name"
    found = {}
    for name, shape, data, checksum in connection.execute(query, (number,)):
        if not isinstance(data, bytes) or _digest(number, name, shape, data) != checksum:
            raise ValueError(f"its internal variable {name} is damaged")
        sizes = [int(size) for size in shape.split(",") if size]
        found[name] = np.frombuffer(data, dtype="<f8").astype(np.float64).reshape(sizes)
    return found


def internal_bytes(connection: sqlite3.Connection) -> Iterator[bytes]:
    """All internal variables in order, for the hash of the result; nothing where there are none."""
    if has_internal(connection):
        query = "SELECT number, name, data FROM internal ORDER BY number, name"
        for number, name, data in connection.execute(query):
            yield int(number).to_bytes(8, "little") + str(name).encode()
            yield data


def _digest(*parts: Any) -> bytes:
    text = repr(parts[:-1]).encode()
    return hashlib.blake2b(text + parts[-1], digest_size=16).digest()
