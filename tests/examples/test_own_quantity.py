"""A quantity that is registered once is found in every place, with its unit and label."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pyarrow.parquet as pq
import pytest

import gyrify
from gyrify.config import Config
from gyrify.convergence.measured import measured, metrics
from gyrify.metrics.quantities import MEASURED
from gyrify.report.html.describe import numbers
from gyrify.report.html.page_of_study import study_page
from gyrify.report.outputs import write_outputs
from gyrify.run.summary import summarise
from gyrify.study import Point, run_points
from gyrify.study.results import write_results

KEY = "buried_fraction"


@pytest.fixture(scope="module")
def registered(example):
    module = example("own_quantity")
    MEASURED.append(module.BURIED)
    yield module.BURIED
    MEASURED.remove(module.BURIED)


@pytest.fixture(scope="module")
def folder(registered, tiny: Config, tmp_path_factory: pytest.TempPathFactory) -> Path:  # noqa: ARG001
    folder = tmp_path_factory.mktemp("quantity")
    history = gyrify.simulate(tiny, folder / "run")
    write_outputs(history, folder / "run")
    history.journal.close()
    points = [
        Point({"growth.ratio": ratio}, tiny.with_overrides({"growth.ratio": ratio})) for ratio in (2, 3)
    ]
    result = run_points(points, folder / "study")
    write_results(folder / "study", points, result.records)
    return folder


def test_it_is_measured_of_every_state(folder: Path) -> None:
    history = gyrify.History.load(folder / "run")
    for index in (0, len(history) - 1):
        measures = gyrify.measure_state(history, index)
        expected = max(1.0 - 1.0 / measures.gi_exposed, 0.0)
        assert measures.buried_fraction == pytest.approx(expected, abs=1e-12)
        assert measures.flat()[KEY] == measures.buried_fraction


def test_files_have_it_with_its_unit(folder: Path) -> None:
    summary = json.loads((folder / "run" / "summary.json").read_text())
    assert 0.0 <= summary[KEY] <= 1.0
    assert summary["units"][KEY] == "1"
    with (folder / "run" / "metrics.csv").open(newline="") as file:
        assert [row[KEY] for row in csv.DictReader(file)][-1] == str(summary[KEY])
    table = pq.read_table(folder / "study" / "results.parquet")
    assert table.schema.field(KEY).metadata == {b"unit": b"1"}
    assert len(table[KEY].to_pylist()) == 2


def test_report_notebook_table_and_study_show_it(
    registered, folder: Path, capsys, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "240")
    history = gyrify.History.load(folder / "run")
    summary = summarise(history)
    (line,) = [line for line in numbers(summary) if line[0] == registered.label]
    assert line[1] == summary[KEY]
    assert registered.about in line[4]
    assert registered.label in history._repr_html_()
    assert KEY in {metric.key for metric in metrics()}
    assert measured(history)[KEY] == summary[KEY]
    assert f'"label":"{registered.label}"' in study_page(folder / "study", "s").replace('": "', '":"')
    from gyrify.cli import main

    assert main(["table", str(folder / "study")]) == 0
    assert KEY in capsys.readouterr().out
