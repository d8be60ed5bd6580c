"""``gyrify export --format metrics`` measures a stored run again; runs measured by earlier rules verify."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

from gyrify.cli import main
from gyrify.config import Config
from gyrify.report.outputs import write_outputs
from gyrify.run.measuring import earlier_rows
from gyrify.run.simulation import simulate
from gyrify.run.summary import earlier_summary
from gyrify.store import History
from gyrify.verify import verify

Capture = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def run(folding: Config, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("run")
    write_outputs(simulate(folding.replace(**{"stability.detect": False}), folder), folder)
    return folder


def read(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_the_last_state_with_another_radius(run: Path, capsys: Capture) -> None:
    before = {
        file.name: file.read_bytes() for file in run.iterdir() if file.suffix in (".json", ".toml", ".csv")
    }
    assert main(["export", str(run), "--format", "metrics", "--closing-radius", "5", "--json"]) == 0
    (name,) = json.loads(capsys.readouterr().out)["files"]
    assert Path(name) == run / "export-metrics.csv"
    (row,), own = read(Path(name)), read(run / "metrics.csv")
    assert list(row) == list(own[-1])
    changed = {key for key in row if row[key] != own[-1][key]}
    assert {"gi_closing", "gi_closing_radius_mm", "gi_exposed", "sulcal_depth_mm_max"} <= changed
    assert "gi_hull" not in changed
    assert row["gi_closing_radius_mm"] == "5.0"
    assert float(row["gi_closing"]) < float(own[-1]["gi_closing"])
    assert all((run / file).read_bytes() == data for file, data in before.items())
    assert verify(run).passed


def test_every_state_by_its_own_lengths_is_the_stored_table(run: Path, tmp_path: Path) -> None:
    out = tmp_path / "new" / "table.csv"
    assert main(["export", str(run), "--format", "metrics", "--every", "--out", str(out)]) == 0
    assert out.read_bytes() == (run / "metrics.csv").read_bytes()
    assert (
        main(
            [
                "export",
                str(run),
                "--format",
                "metrics",
                "--every",
                "--gyrus-prominence",
                "9/2",
                "--out",
                str(out),
            ]
        )
        == 0
    )
    few, own = read(out), read(run / "metrics.csv")
    assert len(few) == len(own)
    assert all(int(row["n_gyri"]) <= int(before["n_gyri"]) for row, before in zip(few, own, strict=True))
    assert few != own


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--closing-radius", "5"], "--closing-radius goes with --format metrics alone"),
        (
            ["--format", "csv", "--gyrus-prominence", "1"],
            "--gyrus-prominence goes with --format metrics alone",
        ),
        (["--format", "metrics", "--closing-radius", "wide"], "is not a number"),
        (["--format", "metrics", "--closing-radius=-3"], "metrics.closing_radius = -3.0 is not allowed"),
        (["--format", "metrics", "--gyrus-prominence", "1e9"], "at most 100000"),
    ],
)
def test_bad_lengths_are_refused(run: Path, capsys: Capture, arguments: list[str], says: str) -> None:
    assert main(["export", str(run), *arguments]) == 2
    assert says in capsys.readouterr().err


def test_a_radius_that_does_not_fit_is_told(run: Path, capsys: Capture) -> None:
    assert main(["export", str(run), "--format", "metrics", "--closing-radius", "100"]) == 0
    assert (
        "Warning: metrics.closing_radius = 100 mm is larger than the mean radius" in capsys.readouterr().err
    )


def test_a_run_measured_by_earlier_rules_still_verifies_and_a_changed_one_does_not(
    run: Path, tmp_path: Path
) -> None:
    history = History.load(run)
    rows, summary = earlier_rows(history), earlier_summary(history)
    assert any(row["gi_closing"] > row["gi_hull"] for row in rows)
    folder = tmp_path / "earlier"
    folder.mkdir()
    for file in ("journal.sqlite", "config.toml"):
        (folder / file).write_bytes((run / file).read_bytes())

    def write(rows: list[dict[str, object]]) -> None:
        with (folder / "metrics.csv").open("w", newline="") as file:
            writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)

    write(rows)
    (folder / "summary.json").write_text(json.dumps(summary))
    checks = {check.name: check for check in verify(folder).checks}
    assert checks["metrics.csv"].passed
    assert "earlier rules of measuring" in checks["metrics.csv"].sentence
    write([*rows[:-1], rows[-1] | {"gi_closing": 1.01 * rows[-1]["gi_closing"]}])
    assert not {check.name: check for check in verify(folder).checks}["metrics.csv"].passed
