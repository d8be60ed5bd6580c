"""The journal: whole transactions whatever strikes, checksums, archives."""

from __future__ import annotations

import contextlib
import sqlite3
from pathlib import Path

import numpy as np
import pytest

from gyrify.errors import HistoryError
from gyrify.solve.problem import State
from gyrify.store import History, Journal
from gyrify.store.database import transaction

META = {"config": "seed = 3\n", "versions": "{}"}


def state(index: int) -> State:
    reference = State.reference(4, 2)
    return State(**{**vars(reference), "index": index, "position": index, "u": np.full((4, 2), float(index))})


@pytest.fixture
def journal(tmp_path: Path) -> Journal:
    made = Journal.create(tmp_path / "journal.sqlite", META)
    for index in range(3):
        made.append(state(index), 0.1)
    return made


def test_a_state_comes_back_bit_for_bit(journal: Journal, rng: np.random.Generator) -> None:
    couplings = np.array([[0, 3], [1, 2]])
    stored = State(
        **{**vars(state(3)), "u": rng.normal(size=(4, 2)), "couplings": couplings, "residual": 0.1}
    )
    journal.append(stored, 0.0)
    read = journal.state(3)
    assert read.u.tobytes() == stored.u.tobytes()
    assert read.u_before.tobytes() == journal.displacement(2).tobytes()
    np.testing.assert_array_equal(read.couplings, couplings)
    assert (read.position, read.span, read.next_span) == (stored.position, stored.span, stored.next_span)
    assert read.residual == 0.1


@pytest.mark.parametrize("where", ["before", "within"])
def test_an_interrupted_transaction_leaves_nothing(journal: Journal, where: str) -> None:
    connection = journal._connection
    if where == "before":  # the interrupt fell between BEGIN and the block
        connection.execute("BEGIN IMMEDIATE")
        connection.execute("DELETE FROM increments")
    else:
        with pytest.raises(KeyboardInterrupt), transaction(connection):  # noqa: PT012
            connection.execute("DELETE FROM increments")
            raise KeyboardInterrupt
    journal.set_meta(status="interrupted")
    assert len(journal) == 3
    assert journal.meta("status") == "interrupted"


def test_an_interrupt_in_the_commit_leaves_all_or_nothing(journal: Journal) -> None:
    def strike(statement: str) -> None:
        if statement == "COMMIT":
            connection.set_trace_callback(None)
            connection.interrupt()

    connection = journal._connection
    connection.set_trace_callback(strike)
    with contextlib.suppress(HistoryError):
        journal.append(state(3), 0.0)
    assert not connection.in_transaction
    assert len(journal) in (3, 4)
    journal.check()
    journal.append(state(len(journal)), 0.0)


def test_a_full_database_keeps_what_was_accepted(journal: Journal) -> None:
    (pages,) = journal._connection.execute("PRAGMA page_count").fetchone()
    journal._connection.execute(f"PRAGMA max_page_count = {pages}")
    with pytest.raises(HistoryError, match="Free space"):  # noqa: PT012
        for index in range(3, 2000):
            journal.append(state(index), 0.0)
    reached = len(journal)
    assert reached < 2000
    journal._connection.execute(f"PRAGMA max_page_count = {10 * pages}")
    journal.append(state(reached), 0.0)
    journal.check()


def test_no_half_journal_is_left_behind(tmp_path: Path) -> None:
    path = tmp_path / "journal.sqlite"
    with pytest.raises(HistoryError):
        Journal.create(path, {"versions": object()})  # type: ignore[dict-item]
    assert not list(tmp_path.iterdir())


def test_settle_leaves_one_file(journal: Journal, tmp_path: Path) -> None:
    assert (tmp_path / "journal.sqlite-wal").stat().st_size > 0
    journal.settle()
    assert (tmp_path / "journal.sqlite-wal").stat().st_size == 0
    journal.close()
    assert [file.name for file in tmp_path.iterdir()] == ["journal.sqlite"]


def test_any_flipped_byte_of_a_state_is_found(journal: Journal, tmp_path: Path) -> None:
    journal.close()
    path = tmp_path / "journal.sqlite"
    whole = path.read_bytes()
    start = whole.index(np.full((4, 2), 2.0).tobytes())
    for offset in range(start, start + 64, 7):
        path.write_bytes(whole[:offset] + bytes([whole[offset] ^ 0x10]) + whole[offset + 1 :])
        with pytest.raises(HistoryError, match=r"Increment 2 .* checksum"):
            Journal.open(path)


def test_a_missing_increment_is_found(journal: Journal, tmp_path: Path) -> None:
    journal._connection.execute("DELETE FROM increments WHERE number = 1")
    journal.close()
    with pytest.raises(HistoryError, match="no increment 1"):
        Journal.open(tmp_path / "journal.sqlite")


def test_random_damage_never_gets_past_with_another_error(
    journal: Journal, tmp_path: Path, rng: np.random.Generator
) -> None:
    journal.close()
    path = tmp_path / "journal.sqlite"
    whole = path.read_bytes()
    for _ in range(400):
        damaged = bytearray(whole)
        for offset in rng.integers(0, len(whole), rng.integers(1, 9)):
            damaged[offset] = int(rng.integers(256))
        path.write_bytes(damaged)
        with contextlib.suppress(HistoryError):
            read = Journal.open(path, read_only=True)
            for number in range(len(read)):
                assert read.displacement(number).tobytes() == np.full((4, 2), float(number)).tobytes()


def test_a_reader_changes_nothing(journal: Journal, tmp_path: Path) -> None:
    journal.close()
    reader = Journal.open(tmp_path / "journal.sqlite", read_only=True)
    with pytest.raises(HistoryError):
        reader.set_meta(status="completed")


def test_a_reader_sees_a_run_that_goes_on(journal: Journal, tmp_path: Path) -> None:
    reader = Journal.open(tmp_path / "journal.sqlite", read_only=True)
    journal.append(state(3), 0.0)
    assert len(reader) == 4
    assert reader.result_hash == journal.result_hash


def test_a_killed_run_reads_as_interrupted(tmp_path: Path) -> None:
    from gyrify.config import Config

    journal = Journal.create(tmp_path / "journal.sqlite", {**META, "config": Config().to_toml()})
    journal.set_meta(status="running")
    history = History(journal)
    assert history.status == "interrupted"
    assert "ended unexpectedly" in history.reason
    assert "gyrify resume" in history.advice


def test_meta_is_text(journal: Journal) -> None:
    assert journal.meta("nothing") == ""
    assert journal.meta("nothing", "default") == "default"
    with contextlib.closing(sqlite3.connect(":memory:")) as empty, pytest.raises(HistoryError):
        Journal(empty, None).meta("config")
