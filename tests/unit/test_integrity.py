"""What a journal's rows may hold, each bound from both sides, and what its hash tells apart."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from gyrify.errors import HistoryError
from gyrify.solve.problem import State
from gyrify.store import Journal
from gyrify.store.increment_rows import IncrementRow

# number, position, span, next_span, residual, four counts, wall_s, displacement, couplings, digest
ROW = (1, 8, 4, 4, 0.1, 3, 2, 1, 0, 0.5, bytes(64), np.array([0, 3], dtype="<i4").tobytes(), b"")


def sound(number: int, value: object, before: int = 7) -> bool:
    """Whether the row is sound with one entry changed, after an increment at a position."""
    row = IncrementRow(*ROW[:number], value, *ROW[number + 1 :])  # type: ignore[arg-type]
    return row.is_possible(before, n_dim=2)


@pytest.mark.parametrize(
    ("number", "good", "bad"),
    [
        (1, 8, 7),
        (1, 2**63 - 1, 2**63),
        (2, 1, 0),
        (3, 1, 0),
        (0, 0, -1),
        (5, 0, -1),
        (8, 0, 0.0),
        (4, 0.0, math.inf),
        (4, 1, math.nan),
        (9, 0.0, math.inf),
        (10, bytes(64), bytes(56)),
        (10, bytes(80), b""),
        (11, b"", bytes(4)),
        (11, np.array([0, 3], dtype="<i4").tobytes(), np.array([0, 4], dtype="<i4").tobytes()),
        (11, np.array([0, 3], dtype="<i4").tobytes(), np.array([-1, 3], dtype="<i4").tobytes()),
    ],
)
def test_each_bound_of_a_row_holds_from_both_sides(number: int, good: object, bad: object) -> None:
    assert sound(number, good)
    assert not sound(number, bad)


def result_hash(*states: State) -> str:
    journal = Journal.create(None, {"config": "", "versions": "{}"})
    for number, state in enumerate(states):
        journal.append(replace(state, index=number), 0.0)
    return journal.result_hash


def test_the_hash_tells_places_times_and_their_order_apart() -> None:
    one = replace(State.reference(2, 2), position=4, u=np.full((2, 2), 0.25))
    two = replace(one, position=8, u=np.full((2, 2), 0.5))
    hashes = [
        result_hash(one, two),
        result_hash(two, one),
        result_hash(one),
        result_hash(one, replace(two, position=9)),
        result_hash(one, replace(two, u=np.nextafter(two.u, 1.0))),
    ]
    assert len(set(hashes)) == len(hashes)
    assert result_hash(one, replace(two, residual=7.0)) == hashes[0]


def test_numbers_come_in_the_order_of_the_increments() -> None:
    journal = Journal.create(None, {"config": "", "versions": "{}"})
    for number in (0, 1, 2):
        journal.append(replace(State.reference(2, 2), index=number, position=10 - number), 0.0)
    assert journal.column("position") == [10, 9, 8]


@pytest.mark.parametrize("column", ["position", "residual", "rejected", "displacement", "couplings"])
def test_a_changed_entry_of_any_kind_is_found(column: str) -> None:
    journal = Journal.create(None, {"config": "", "versions": "{}"})
    journal.append(replace(State.reference(2, 2), couplings=np.array([[0, 1]])), 0.0)
    journal.check()
    value = "x'" + "01" * 32 + "'" if column in ("displacement", "couplings") else "7"
    journal._connection.execute(f"UPDATE increments SET {column} = {value}")
    with pytest.raises(HistoryError, match="checksum"):
        journal.check()
