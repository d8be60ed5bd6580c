"""A run that was killed while its journal was being made is told from a file of another program."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import pytest

from gyrify.cli import main
from gyrify.config import Config
from gyrify.errors import HistoryError
from gyrify.store import History, Journal


class Killed(BaseException):
    """Ends a process here."""


def test_half_a_journal_says_that_nothing_was_stored(
    tiny: Config, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def die(_: sqlite3.Connection) -> None:
        raise Killed

    file, folder = tmp_path / "config.toml", tmp_path / "run"
    file.write_text(tiny.to_toml())
    with monkeypatch.context() as patch:
        patch.setattr("gyrify.store.journal.transaction", die)
        folder.mkdir()
        with pytest.raises(Killed):
            Journal.create(folder / "journal.sqlite", {"config": tiny.to_toml()})
    assert (folder / "journal.sqlite").stat().st_size > 0
    with pytest.raises(HistoryError, match="ended before its first state was stored"):
        History.load(folder)
    assert main(["resume", str(folder)]) == 2
    assert "--overwrite" in capsys.readouterr().err
    assert main(["run", str(file), "--out", str(folder), "--overwrite", "--quiet"]) == 0


def test_an_empty_database_of_another_program_stays_one(tmp_path: Path) -> None:
    with sqlite3.connect(tmp_path / "journal.sqlite") as database:
        database.execute("CREATE TABLE birds (name TEXT)")
    database.close()
    with pytest.raises(HistoryError, match="not a gyrify journal"):
        History.load(tmp_path)
