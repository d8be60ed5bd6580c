"""``gyrify table``: SQL on dotted columns without quotes, and no way out of the table."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from small_study import FAILING, GROWTH, STIFFNESS, study

from gyrify.cli import main
from gyrify.study import Point, run_points
from gyrify.study.query import query_results, quoted

Capture = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("table")
    small = study(GROWTH, STIFFNESS)
    run_points([*small.points(), Point(FAILING, small.base.with_overrides(FAILING))], out)
    return out


def table(folder: Path, capsys: Capture, *options: str) -> tuple[int, str, str]:
    code = main(["table", str(folder), *options])
    return (code, *capsys.readouterr())


def test_csv_has_chosen_rows_and_columns_in_order(folder: Path, capsys: Capture) -> None:
    options = [
        "--where",
        "growth.ratio > 2 and status = 'completed'",
        "--sort",
        "material.stiffness_ratio desc",
    ]
    code, printed, _ = table(
        folder, capsys, *options, "--columns", "growth.ratio, 2*gi_hull as twice", "--csv"
    )
    found = list(csv.DictReader(io.StringIO(printed)))
    assert code == 0
    assert [list(row) for row in found] == [["growth.ratio", "twice"]] * 2
    assert [row["growth.ratio"] for row in found] == ["3.6", "3.6"]
    whole = query_results(folder, "growth.ratio > 2 and status = 'completed'").to_pylist()
    assert [float(row["twice"]) for row in found] == [2 * row["gi_hull"] for row in whole[::-1]]


def test_csv_of_everything_is_the_results(folder: Path, capsys: Capture) -> None:
    _, printed, _ = table(folder, capsys, "--csv")
    found = list(csv.DictReader(io.StringIO(printed)))
    stored = query_results(folder)
    assert list(found[0]) == stored.column_names
    assert len(found) == 5
    assert [row["gi_closing"] == "" for row in found] == [False] * 4 + [True]
    assert float(found[3]["min_gap_mm"]) == stored["min_gap_mm"][3].as_py()


def test_json_is_one_document_with_the_numbers(folder: Path, capsys: Capture) -> None:
    code, printed, said = table(folder, capsys, "--json", "--where", "key is not null", "--limit", "4")
    found = json.loads(printed)
    assert (code, said) == (0, "")
    assert len(found["rows"]) == 4
    assert found["rows"][0]["growth.ratio"] == 1.0
    assert found["columns"][:2] == ["key", "config_hash"]


def test_for_reading_it_shows_what_matters(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("COLUMNS", raising=False)
    code, printed, _ = table(folder, capsys)
    assert code == 0
    for word in ("growth.ratio", "material.stiffness_ratio", "phenotype", "gi_closing", "failed", "5 runs"):
        assert word in printed
    assert "config_hash" not in printed


@pytest.mark.parametrize(
    ("where", "said"),
    [
        ("growh.ratio > 2", "Did you mean growth.ratio?"),
        ("gi_closng > 1", "Did you mean gi_closing?"),
        ("growth.ratio >", "it cannot be read at"),
        ("key::int = 1", "is not a number"),
        ("true; drop table x", "is not understood"),
        ("true) union select 1 --", "is not understood"),
    ],
)
def test_a_wrong_expression_is_a_clear_error(folder: Path, capsys: Capture, where: str, said: str) -> None:
    code, printed, errors = table(folder, capsys, "--where", where)
    assert (code, printed) == (2, "")
    assert said in errors
    assert "Traceback" not in errors
    assert "arrow_object" not in errors


def test_no_expression_reaches_a_file(folder: Path, tmp_path: Path, capsys: Capture) -> None:
    secret = tmp_path / "secret.csv"
    secret.write_text("secret\n1\n")
    for option, text in (
        ("--where", f"key in (select content from read_text('{secret}'))"),
        ("--where", f"exists (from '{secret}')"),
        ("--where", "exists (from read_parquet('results.parquet'))"),
        ("--columns", f"(select count(*) from read_csv('{secret}'))"),
        ("--sort", f"key; copy (select 1) to '{tmp_path / 'out.csv'}'"),
        ("--columns", "(select count(*) from rows)"),
    ):
        code, printed, _ = table(folder, capsys, option, text, "--csv")
        assert (code, printed) == (2, ""), text
    assert [path.name for path in tmp_path.iterdir()] == ["secret.csv"]


def test_wrong_folders_and_options_are_named(folder: Path, tmp_path: Path, capsys: Capture) -> None:
    assert table(tmp_path, capsys)[0] == 2
    assert table(folder, capsys, "--csv", "--json")[0] == 2
    assert table(folder, capsys, "--limit", "-1")[0] == 2


@given(
    st.lists(st.sampled_from(["growth.ratio", "'growth.ratio'", '"growth.ratio"', ">", "2", "a", "'it''s'"]))
)
def test_dotted_names_are_quoted_once_and_text_is_left_alone(words: list[str]) -> None:
    found = quoted(" ".join(words), ["growth.ratio", "gi"])
    assert found == " ".join('"growth.ratio"' if word == "growth.ratio" else word for word in words)


def test_names_inside_longer_ones_are_left_alone() -> None:
    names = ["growth.ratio", "growth.ratio_2"]
    assert quoted("growth.ratio_2 + x.growth.ratio + growth.ratio", names) == (
        '"growth.ratio_2" + x.growth.ratio + "growth.ratio"'
    )
