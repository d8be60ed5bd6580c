"""``gyrify paper`` on a mesh far too coarse to fold as the paper's does."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from gyrify.cli import main

COARSE = [
    argument
    for setting in (
        "mesh.n_around=24",
        "mesh.n_layers=4",
        "mesh.n_cortex_layers=2",
        "solver.increments=4",
        "metrics.samples=200",
        "growth.rate=0.0005",
    )
    for argument in ("--set", setting)
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("paper")
    assert main(["paper", "--out", str(out), "--workers", "1", "--quiet", *COARSE]) == 0
    return out


def test_it_writes_scoreboard_cases_results_and_figures(folder: Path) -> None:
    names = {file.name for file in folder.iterdir()}
    assert names >= {"scoreboard.csv", "scoreboard.md", "scoreboard.html", "cases.csv", "results.parquet"}
    figures = sorted(file.name for file in (folder / "figures").iterdir())
    assert len(figures) == 18
    assert figures[0] == "figure-2.pdf"


def test_the_same_command_rebuilds_without_simulating(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    kept = {file: file.read_bytes() for file in folder.rglob("*") if file.suffix in (".csv", ".png", ".html")}
    timings = folder / "timings.csv"
    for file in kept:
        if file != timings:
            file.unlink()
    assert main(["paper", "--out", str(folder), "--workers", "1", "--json", "--quiet", *COARSE]) == 0
    out = capsys.readouterr()
    told = json.loads(out.out)
    assert told["total"] == len(told["rows"]) == 18
    assert told["passed"] == sum(row["passed"] is True for row in told["rows"]) >= 2
    assert [row["ours"] for row in told["rows"][:2]] == ["3.592", "2.78; 1.71"]
    assert {"reading", "rows", "passed", "first_passed", "total", "wall_s", "warnings"} == set(told)
    assert all(row["note"] for row in told["rows"] if row["passed"] is False)
    assert "generalised to the power 0.14, exponential, grown, no dissipation" in told["reading"]
    assert kept == {file: file.read_bytes() for file in kept}


def test_the_terminal_shows_every_row(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["paper", "--out", str(folder), "--workers", "1", "--quiet", *COARSE]) == 0
    out = capsys.readouterr().out
    assert all(f"P{number}" in out for number in range(1, 19))
    assert "of 18 observations hold" in out
    assert "0 of them now" in out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--gi", "convex"], "gi = 'convex'"),
        (["--set", "growth.stretch=cubic"], "growth.stretch"),
        (["--preset", "wang2020"], "wang2019"),
        (["--workers", "0"], "workers = 0"),
        (["--minutes", "-1"], "minutes = -1"),
    ],
)
def test_bad_arguments_are_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], words: str
) -> None:
    assert main(["paper", "--out", str(tmp_path), "--json", *arguments]) == 2
    out = capsys.readouterr()
    assert words in out.err
    assert words in json.loads(out.out)["message"] + json.loads(out.out)["advice"]
    assert not (tmp_path / "results.parquet").exists()


def test_a_search_without_time_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["paper", "--out", str(tmp_path), "--workers", "1", "--readings", "--minutes", "0", "--json"]
    assert main([*arguments, *COARSE]) == 3
    out = capsys.readouterr()
    told = json.loads(out.out)
    assert told["ranking"] == told["seeds"] == []
    assert "Time ran out" in (tmp_path / "readings.md").read_text(encoding="utf-8")
