"""Faults that fuzzing found, one a test; and what a folder from elsewhere may not do."""

from __future__ import annotations

import contextlib
import json
import shutil
import sqlite3
from pathlib import Path

import h5py
import pytest
from guard import is_clear
from stored import TINY, journal_bytes
from stored_targets import _archive, _seal

import gyrify
from gyrify.cli import main
from gyrify.config import Config
from gyrify.errors import ConfigError, HistoryError
from gyrify.store import History, Journal
from gyrify.store.derived import read_metrics, read_summary
from gyrify.store.lock import has_owner, run_lock
from gyrify.study import final_state, read_results
from gyrify.study.archive import FinalState, read_record
from gyrify.verify import verify


@pytest.fixture
def run(tmp_path: Path) -> Path:
    """A run folder, and a file outside of it that must stay as it is."""
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "journal.sqlite").write_bytes(journal_bytes())
    (tmp_path / "precious").write_text("precious")
    return tmp_path / "run"


def forge(run: Path, *statements: str) -> None:
    """Change a journal and seal it anew."""
    with contextlib.closing(sqlite3.connect(run / "journal.sqlite", isolation_level=None)) as connection:
        for statement in statements:
            connection.execute(statement)
        with contextlib.suppress(sqlite3.Error):
            _seal(connection)


def test_a_view_that_never_ends_is_not_read(run: Path) -> None:
    endless = "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c)"
    forge(run, "DROP TABLE stability", f"CREATE VIEW stability AS {endless} SELECT x AS number FROM c")
    with pytest.raises(HistoryError, match="tables are not those of a run"):
        History.load(run)


@pytest.mark.parametrize(
    ("statement", "told"),
    [
        ("CREATE TRIGGER t AFTER INSERT ON meta BEGIN DELETE FROM increments; END", "tables"),
        ("UPDATE increments SET position = 'x' WHERE number = 1", "Increment 1"),
        ("UPDATE increments SET residual = 9e999 WHERE number = 1", "Increment 1"),
        ("UPDATE increments SET next_span = 0 WHERE number = 2", "Increment 2"),
        ("UPDATE increments SET couplings = x'ffffffffffffff7f' WHERE number = 2", "Increment 2"),
        ("UPDATE increments SET displacement = zeroblob(24) WHERE number = 0", "Increment 0"),
        ("UPDATE increments SET position = position * 4 WHERE number = 2", "beyond the end of growth"),
        ("INSERT OR REPLACE INTO meta VALUES ('status', 'fine')", "status"),
        ("INSERT OR REPLACE INTO meta VALUES ('versions', '[1]')", "versions"),
        ("INSERT OR REPLACE INTO stability VALUES (1, 'many')", "stability"),
        ("INSERT INTO onset VALUES (0, 1, 1, 2, -1, 7, 9, zeroblob(8), zeroblob(8))", "stability"),
        ("DELETE FROM increments", "no state yet"),
    ],
)
def test_a_forged_row_is_refused(run: Path, statement: str, told: str) -> None:
    forge(run, statement)
    with pytest.raises(HistoryError, match=told):
        History.load(run)


def test_what_sqlite_says_of_a_damaged_schema_is_fit_for_a_terminal(run: Path) -> None:
    schema = "UPDATE sqlite_master SET sql = 'CREATE TABLE meta(' || char(1, 27) || ')' WHERE name = 'meta'"
    forge(run, "PRAGMA writable_schema = ON", schema)
    with pytest.raises(HistoryError, match="malformed") as raised:
        History.load(run)
    assert is_clear(str(raised.value))


def test_states_of_another_mesh_are_refused(run: Path) -> None:
    forge(run, "UPDATE increments SET displacement = zeroblob(1600)")
    with pytest.raises(HistoryError, match="does not fit the mesh"):
        History.load(run).points()


@pytest.mark.parametrize(
    "name", ["config.toml.partial", "summary.json.partial", "metrics.csv.partial", "report.html.partial"]
)
def test_links_in_a_run_folder_are_replaced_not_followed(run: Path, name: str) -> None:
    (run / name).symlink_to(run.parent / "precious")
    assert main(["resume", str(run), "--quiet"]) == 0
    assert main(["report", str(run)]) == 0
    assert (run.parent / "precious").read_text() == "precious"


@pytest.mark.parametrize("name", ["run.lock", "run.owner.json", "journal.sqlite", "journal.sqlite-wal"])
def test_links_that_would_be_written_through_are_refused(
    run: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    target = run.parent / "precious"
    if name == "journal.sqlite":
        target = Path(shutil.move(run / name, run.parent / "elsewhere.sqlite"))
    before = target.read_bytes()
    (run / name).symlink_to(target)
    assert main(["resume", str(run), "--quiet"]) == 2
    assert "is a symbolic link" in capsys.readouterr().err
    assert target.read_bytes() == before


def test_exports_replace_a_link(run: Path) -> None:
    (run / "export.csv").symlink_to(run.parent / "precious")
    assert main(["export", str(run), "--format", "csv"]) == 0
    assert (run.parent / "precious").read_text() == "precious"


def test_a_new_run_does_not_follow_a_dangling_link(tmp_path: Path) -> None:
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "journal.sqlite").symlink_to(tmp_path / "not-there")
    settings = [
        word for key, value in TINY.items() if "fields" not in key for word in ("--set", f"{key}={value}")
    ]
    main(["run", *settings, "--out", str(tmp_path / "run"), "--overwrite", "--quiet"])
    assert not (tmp_path / "not-there").exists()


@pytest.mark.parametrize(
    "text", ["[" * 100_000, '{"a":' * 100_000, '[["a", 1], [2, 3]]', "9" * 5000, "\udcff"]
)
def test_facts_that_are_none_are_refused(tmp_path: Path, text: str) -> None:
    for name in ("summary.json", "point.json", "run.owner.json"):
        (tmp_path / name).write_text(text, errors="surrogateescape")
    with pytest.raises(HistoryError, match="damaged"):
        read_summary(tmp_path)
    assert read_record(tmp_path) is None
    assert not has_owner(tmp_path)


def test_an_owner_of_infinite_number_is_nobody(tmp_path: Path) -> None:
    (tmp_path / "run.owner.json").write_text('{"pid": Infinity, "host": "\\u001b[31m"}')
    assert not has_owner(tmp_path)
    with run_lock(tmp_path) as note:
        assert note.isprintable()


def test_metrics_with_too_many_cells_or_nulls_are_told(tmp_path: Path) -> None:
    (tmp_path / "metrics.csv").write_text("a,b\n1,2,3,4\n")
    assert read_metrics(tmp_path / "metrics.csv") == {"0": {"a": "1", "b": "2", "None": "['3', '4']"}}
    (tmp_path / "metrics.csv").write_text("a\n" + "x" * 200_000)
    with pytest.raises(HistoryError, match="field larger"):
        read_metrics(tmp_path / "metrics.csv")


def test_a_huge_number_in_a_summary_is_a_difference(run: Path) -> None:
    (run / "summary.json").write_text(json.dumps({"n_gyri": 10**400, "gi": {"hull": [1]}}))
    found = {check.name: check for check in verify(run).checks}
    assert not found["result hash"].passed


def test_a_key_that_leads_out_of_a_study_is_refused(tmp_path: Path) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    names = ("key", "config_hash", "solver_version", "status", "reason", "advice")
    pq.write_table(pa.table({name: ["../../else"] for name in names}), tmp_path / "results.parquet")
    with pytest.raises(HistoryError, match="not the key of a run"):
        read_results(tmp_path)
    with pytest.raises(HistoryError, match="no complete run"):
        final_state(tmp_path, "../../else")


@pytest.mark.parametrize(
    ("descr", "shape"), [("'<f8'", "(3, False)"), ("()", "(3,)"), ("[1]", "(3,)"), ("'<f8'", "(-1,)")]
)
def test_arrays_described_wrongly_are_refused(tmp_path: Path, descr: str, shape: str) -> None:
    header = f"{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}"
    (tmp_path / "final.npz").write_bytes(_archive(f"displacement.npy|{header}|24".encode()))
    with pytest.raises(HistoryError, match="damaged"):
        FinalState.load(tmp_path / "final.npz")


def test_terminals_get_no_commands_from_a_file(run: Path, capsys: pytest.CaptureFixture[str]) -> None:
    forge(run, "INSERT OR REPLACE INTO meta VALUES ('linear_solver', char(27) || '[2J')")
    main(["resume", str(run), "--quiet"])
    main(["report", str(run.parent / "x\x1b[2J")])
    heard = capsys.readouterr()
    assert "\x1b" not in heard.err + heard.out
    assert "\\x1b" in heard.err


def test_a_time_series_is_known_by_its_digest(run: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert main(["resume", str(run), "--quiet"]) == 0
    assert {c.name: c.passed for c in verify(run).checks}["time series"]
    file = run / "history.vtkhdf"
    file.write_bytes(file.read_bytes()[:-1] + b"x")
    monkeypatch.setattr(h5py, "File", lambda *_: pytest.fail("HDF5 opened a file that is not as written"))
    assert not {c.name: c.passed for c in verify(run).checks}["time series"]


def test_nothing_in_gyrify_opens_hdf5_to_read() -> None:
    sources = [file.read_text("utf-8") for file in Path(gyrify.__file__).parent.rglob("*.py")]
    opened = [line for text in sources for line in text.splitlines() if "h5py.File(" in line]
    assert len(opened) == 2
    assert all('"w", locking=False)' in line for line in opened)


def test_journals_that_a_run_makes_pass(run: Path) -> None:
    with contextlib.closing(Journal.open(run / "journal.sqlite")) as journal:
        journal.check()
        assert len(journal) == 3


def test_a_suggestion_repeats_no_long_key() -> None:
    with pytest.raises(ConfigError) as raised:
        Config().with_overrides({f"growth.{'a.' * 3000}\x1b.ratio": 1.0})
    assert is_clear(str(raised.value))
    assert len(str(raised.value)) < 500
