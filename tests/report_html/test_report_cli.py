"""``gyrify report``: one file, one line, clear refusals."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from gyrify.cli.app import main
from gyrify.config import Config
from gyrify.run.simulation import simulate


@pytest.fixture(scope="module")
def run_folder(tmp_path_factory: pytest.TempPathFactory, tiny: Config) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "a run"
    simulate(tiny, folder)
    return folder


def test_a_run_becomes_one_file(run_folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "out.html"
    assert main(["report", str(run_folder), "--out", str(target), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told == {"file": str(target), "bytes": target.stat().st_size}
    assert target.read_text(encoding="utf-8").startswith("<!doctype html>")
    assert main(["report", str(run_folder)]) == 0
    assert str(run_folder / "report.html") in capsys.readouterr().out
    assert (run_folder / "report.html").read_bytes() == target.read_bytes()
    assert str(run_folder.parent) not in target.read_text(encoding="utf-8")


def test_refusals_are_clear(run_folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["report", str(tmp_path)]) == 2
    assert "neither a run nor a study" in capsys.readouterr().err
    assert main(["report", str(tmp_path / "missing"), "--json"]) == 2
    assert json.loads(capsys.readouterr().out)["error"] == "HistoryError"
    assert main(["report", str(run_folder), "--out", str(tmp_path)]) == 2
    assert "is a folder" in capsys.readouterr().err
