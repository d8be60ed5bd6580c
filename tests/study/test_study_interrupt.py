"""``gyrify study`` under Ctrl-C, SIGTERM and kill -9: nothing that was done is lost, and it continues."""

from __future__ import annotations

import json
import signal
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from small_study import TEXT, end_when, rows, start

from gyrify import Study, read_results, run_study
from gyrify.study.archive import write_record

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")


INCREMENTS = 80


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("study") / "ratios.toml"
    path.write_text(TEXT.format(increments=INCREMENTS))
    return path


@pytest.fixture(scope="module")
def whole(file: Path) -> list[dict[str, Any]]:
    """Rows of the study when nothing interrupts it."""
    return rows(run_study(Study.from_toml(file), file.parent / "whole").table)


def finished(out: Path) -> list[Path]:
    return [path for path in out.glob("runs/*/point.json") if '"summary"' in path.read_text()]


def test_a_point_that_was_stored_when_the_signal_came_is_in_the_results(
    file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stored_and_cut_off(*arguments: Any) -> None:
        write_record(*arguments)
        raise KeyboardInterrupt

    monkeypatch.setattr("gyrify.study.known_points.write_record", stored_and_cut_off)
    with pytest.raises(KeyboardInterrupt):
        run_study(Study.from_toml(file), tmp_path, workers=1)
    assert read_results(tmp_path).num_rows == len(finished(tmp_path)) == 1


@pytest.mark.parametrize(
    "number",
    [signal.SIGINT, signal.SIGKILL, signal.SIGUSR1]
    + [pytest.param(number, marks=pytest.mark.slow) for number in (signal.SIGTERM, signal.SIGUSR2)],
    ids=lambda number: number.name,
)
def test_a_signal_ends_it_and_the_same_call_continues(
    file: Path, whole: list[dict[str, Any]], tmp_path: Path, number: int
) -> None:
    out = tmp_path / "out"
    process = start(file, out, "--workers", "2", "--json")
    code, printed, said = end_when(process, lambda: len(finished(out)) > 0, number)
    before = {path: path.stat().st_mtime_ns for path in finished(out)}
    assert 0 < len(before) < 4
    if number == signal.SIGKILL:
        assert code == -signal.SIGKILL
    else:
        assert code == 130, said
        assert json.loads(printed)["error"] == "Interrupted"
        assert "Traceback" not in said
        assert not (out / "run.owner.json").exists()
        assert read_results(out).num_rows == len(before)
    time.sleep(0.5)  # orphans notice that their parent is gone
    study = Study.from_toml(file)
    assert run_study(study, out).computed == 4 - len(before)
    assert all(path.stat().st_mtime_ns == at for path, at in before.items())
    assert rows(read_results(out)) == whole


@pytest.mark.slow
def test_whole_run_folders_are_taken_up_where_they_were_killed(tmp_path: Path) -> None:
    file, out = tmp_path / "ratios.toml", tmp_path / "out"
    file.write_text('keep = "all"\n' + TEXT.format(increments=INCREMENTS).replace("[1.0, 3.6]", "[3.6]"))
    process = start(file, out, "--workers", "1")
    journals = "runs/*/journal.sqlite-wal"
    end_when(process, lambda: any(p.stat().st_size > 100_000 for p in out.glob(journals)), signal.SIGKILL)
    study = Study.from_toml(file)
    found = run_study(study, out)
    expected = run_study(study, tmp_path / "whole", keep="final")
    assert found.computed == 2
    assert rows(found.table) == rows(expected.table)
