"""``gyrify study``: what it prints, writes and returns."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from small_study import FAILING, TEXT

from gyrify import read_results
from gyrify.cli import main
from gyrify.cli.study_progress import duration

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "ratios.toml"
    path.write_text(TEXT.format(increments=8))
    return path


WARNING = "gyrify: Warning: "


def test_it_tells_every_run_and_where_the_results_are(file: Path, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / "out"
    assert main(["study", str(file), "--out", str(out), "--workers", "1"]) == 0
    printed, said = capsys.readouterr()
    lines = [line for line in said.splitlines() if not line.startswith(WARNING)]
    assert lines[0] == "gyrify: 4 runs, none known yet"
    assert [line.split(": ")[1] for line in lines[1:]] == ["1 of 4", "2 of 4", "3 of 4", "4 of 4"]
    assert "growth.ratio = 3.6, dissipation.number = 0.5: GI 1." in lines[3]
    assert all("left" in line for line in lines[1:4])
    assert "4 of 4 runs completed" in printed
    assert f"gyrify table {out}" in printed
    assert {path.name for path in out.iterdir()} == {
        "study.toml",
        "results.parquet",
        "timings.csv",
        "phase-diagram.png",
        "dissipation.png",
        "runs",
        "run.lock",
    }
    assert main(["study", str(file), "--out", str(out), "--quiet"]) == 0
    printed, said = capsys.readouterr()
    assert "4 of them before" in printed
    # Warnings survive --quiet, those of runs that were known too.
    assert said.startswith(f"{WARNING}4 of 4 runs have warnings")
    assert all(line.startswith(WARNING) for line in said.splitlines())


def test_json_names_failures_and_the_exit_code_tells_them(
    file: Path, tmp_path: Path, capsys: Capture
) -> None:
    base = file.read_text().split("[design]")[0]
    failing = "".join(f"{key} = {json.dumps(value)}\n" for key, value in FAILING.items())
    file.write_text(f'{base}[design]\nkind = "list"\n[[design.point]]\nseed = 1\n[[design.point]]\n{failing}')
    out = tmp_path / "out"
    assert main(["study", str(file), "--out", str(out), "--workers", "1", "--json", "--quiet"]) == 1
    printed, said = capsys.readouterr()
    found = json.loads(printed)
    assert all(line.startswith(WARNING) for line in said.splitlines())
    keys = {key for told in found["warnings"] for key in told["keys"]}
    rows = {row["key"]: row["warnings"] for row in read_results(out).to_pylist()}
    assert keys
    assert all(told["warning"] in rows[key].split("\n") for told in found["warnings"] for key in told["keys"])
    assert (found["status"], found["total"], found["completed"]) == ("failed", 2, 1)
    assert len(found["failures"]) == 1
    assert all("Buckling" in failure["reason"] for failure in found["failures"])
    assert [row["status"] for row in read_results(out).to_pylist()].count("failed") == len(found["failures"])
    assert main(["study", str(file), "--out", str(out), "--workers", "1", "--retry-failed"]) == 1
    printed, said = capsys.readouterr()
    assert "failed: Buckling" in said
    assert "--retry-failed" in printed


@pytest.mark.parametrize(
    "wrong", [["--workers", "0"], ["--scheduler", "tcp://127.0.0.1:1"], ["--retry"], ["--workers", "two"]]
)
def test_bad_options_give_exit_code_2(
    file: Path, tmp_path: Path, capsys: Capture, wrong: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("gyrify.study.executors._PATIENCE", "1s")
    assert main(["study", str(file), "--out", str(tmp_path / "out"), *wrong]) == 2
    printed, said = capsys.readouterr()
    assert printed == ""
    assert "Traceback" not in said


def test_a_wrong_file_writes_nothing(tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "wrong.toml"
    file.write_text(TEXT.format(increments=0))
    assert main(["study", str(file), "--out", str(tmp_path / "out"), "--json"]) == 2
    printed, said = capsys.readouterr()
    assert json.loads(printed)["error"] == "ConfigError"
    assert "solver.increments = 0" in said
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("seconds", "words"), [(3.4, "3 s"), (300, "5 min"), (7300, "2 h 2 min"), (5390, "1 h 30 min")]
)
def test_remaining_time_in_words(seconds: float, words: str) -> None:
    assert duration(seconds) == words
