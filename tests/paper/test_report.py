"""Tables and pages of the reproduction and of the screen: complete, escaped, and the same every time."""

from __future__ import annotations

import csv
import io
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from fake_simulations import FakeSimulations
from made_up import perfect, spoilt

from gyrify.config import Config
from gyrify.paper import Case, Row
from gyrify.paper.cases import EQUAL, STIFFNESS, all_cases
from gyrify.paper.ensemble import repeat
from gyrify.paper.exclusion import exclusions
from gyrify.paper.index import INDICES
from gyrify.paper.scoreboard import score
from gyrify.paper.search import search
from gyrify.report.paper_figures import Outlines, paper_figure
from gyrify.report.paper_layout import LAYOUTS
from gyrify.report.paper_page import scoreboard_page
from gyrify.report.paper_readings import readings_csv, readings_markdown, readings_page, write_readings
from gyrify.report.paper_tables import cases_csv, scoreboard_csv, scoreboard_markdown

BOARD = score(spoilt(Case(STIFFNESS[0]), label="normal", because="a < b & c"), "made up", {"P12": "Remark"})


class Cells(HTMLParser):
    """Text of all table cells of a page."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.cells: list[str] = []
        self._inside = False
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: object) -> None:
        del attrs
        if tag == "td":
            self._inside = True
            self.cells.append("")

    def handle_endtag(self, tag: str) -> None:
        self._inside = self._inside and tag != "td"

    def handle_data(self, data: str) -> None:
        if self._inside:
            self.cells[-1] += data


def test_the_scoreboard_counts_and_says_why() -> None:
    assert (BOARD.passed, BOARD.open, BOARD.marks[5]) == (17, 0, "-")
    told = BOARD.as_dict(1.5)
    assert (told["passed"], told["total"], told["wall_s"], told["reading"]) == (17, 18, 1.5, "made up")
    assert list(told["rows"][5]) == ["id", "paper", "ours", "rule", "passed", "first_passed", "note"]
    assert told["rows"][5]["note"] == "Normal (a < b & c) at E = 1/3"
    assert told["rows"][11]["note"] == "Remark"


def test_csv_has_a_line_per_observation_and_per_case() -> None:
    rows = list(csv.DictReader(io.StringIO(scoreboard_csv(BOARD))))
    assert [row["id"] for row in rows] == [f"P{i}" for i in range(1, 19)]
    assert rows[5]["result"] == "fail"
    cases = list(csv.DictReader(io.StringIO(cases_csv(perfect()))))
    assert len(cases) == len(perfect())
    assert {float(row["stiffness_ratio"]) for row in cases} == set(STIFFNESS)


def test_markdown_and_html_hold_the_same() -> None:
    text, page = scoreboard_markdown(BOARD), scoreboard_page(BOARD)
    assert "**17 of 18** observations hold; by the rules as they were first frozen, 17." in text
    assert "- **P6** (fail): Normal (a < b & c) at E = 1/3." in text
    cells = Cells(page).cells
    assert "Normal (a < b & c) at E = 1/3" in cells
    assert cells.count("✓ pass") == 17 + 5
    assert all(f"figures/{layout.name}.png" in page for layout in LAYOUTS)


def test_figures_show_the_cases_of_the_paper() -> None:
    panels = {layout.name: layout.panels for layout in LAYOUTS}
    assert [layout.name for layout in LAYOUTS] == [f"figure-{n}" for n in (*range(2, 9), "S1", "S2")]
    assert [[len(row) for row in panels[name]] for name in ("figure-2", "figure-5", "figure-6")] == [
        [4, 4],
        [4, 4],
        [3, 3],
    ]
    assert {case for rows in panels.values() for row in rows for case in row} <= set(all_cases())


@pytest.mark.parametrize("layout", LAYOUTS, ids=lambda layout: layout.name)
def test_a_figure_has_a_panel_per_case_and_says_what_is_missing(layout: object) -> None:
    assert layout in LAYOUTS
    chosen = LAYOUTS[LAYOUTS.index(layout)]  # type: ignore[arg-type]
    angle = np.arange(60) * (2 * np.pi / 60)
    circle = np.column_stack([1.2 * np.cos(angle), np.sin(angle)])
    outline = Outlines(60 * circle, 57 * circle, 20 * circle)
    cases = [case for row in chosen.panels for case in row]
    drawn = dict.fromkeys(cases[1:], outline)
    rows = {case: Row(gi=1.25) for case in cases[1:]} | {cases[0]: Row("failed", "Stalled.")}
    figure = paper_figure(chosen, rows, drawn)
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    titles = [axes.get_title() for axes in figure.axes]
    assert len(figure.axes) == len(cases)
    assert texts.count("run failed") == 1
    assert texts.count("20 mm") == len(cases) - 1
    assert sum("GI = 1.25" in title for title in titles) == len(cases) - 1


def test_ranking(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gyrify.paper.contender.INDICES", INDICES[::3])
    simulations = FakeSimulations(workers=2)
    found = search(simulations, Config(), rounds=2)
    ensembles = [repeat(simulations, Config(), found.fitted.ranked[0].reading, (0, 3), stability=False)]
    files = write_readings(found, ensembles, tmp_path)
    assert {file.name for file in files} == {"readings.csv", "readings.md", "readings.html", "seeds.csv"}
    rows = list(csv.DictReader(io.StringIO(readings_csv(found))))
    everyone = [*found.fitted.ranked, *found.free.ranked]
    assert len(rows) == len(everyone)
    assert {row[f"P{i}"] for row in rows for i in range(1, 19)} <= {"0", "1", "2", "3", "·"}
    assert [int(row["constants"]) for row in rows] == [len(c.reading.constants) for c in everyone]
    text, page = readings_markdown(found, ensembles), readings_page(found, ensembles)
    assert str(found.fitted.ranked[0].reading) in text
    assert f"{len(everyone)} readings in 2 rounds" in text
    for heading in (
        "With fitted",
        "Without fitted",
        "What guidance",
        "What constants",
        "never seen together",
    ):
        assert heading in text
        assert heading in page
    members = ensembles[0].members
    assert f"With seeds 0, 3 {', '.join(str(m.scoreboard.passed) for m in members)} obs" in text
    before = {file: file.read_bytes() for file in files}
    write_readings(found, ensembles, tmp_path)
    assert before == {file: file.read_bytes() for file in files}
    assert '"GI, E = 1"' in (tmp_path / "seeds.csv").read_text()
    assert "observations that hold with fresh seeds" in (tmp_path / "seeds.csv").read_text()


def test_a_search_that_ran_out_of_time_says_so() -> None:
    found = search(FakeSimulations(), Config(), until=0.0)
    assert "Time ran out: run the same command again to go on." in readings_markdown(found, ())


def test_pairs_are_exclusive_where_each_holds_and_never_both() -> None:
    one = score(spoilt(Case(STIFFNESS[0]), label="normal"), "one")
    other = score(spoilt(Case(EQUAL), gi=1.5), "other")
    pairs = {(pair.one, pair.other): pair for pair in exclusions([one, other, other])}
    assert len(pairs) == 18 * 17 // 2
    told = pairs["P4", "P6"]
    assert (told.decided, told.together, told.only_one, told.only_other) == (3, 0, 1, 2)
    assert told.is_exclusive
    assert not pairs["P1", "P4"].is_exclusive
    assert (pairs["P1", "P4"].together, pairs["P1", "P2"].together) == (1, 3)


def test_a_corrected_rule_stands_beside_the_first() -> None:
    rows = spoilt(Case(EQUAL, thickness=8.0), label="smooth")
    board = score(rows, "made up")
    assert (board.passed, board.first_passed) == (18, 17)
    text = scoreboard_markdown(board)
    assert "**18 of 18** observations hold; by the rules as they were first frozen, 17." in text
    assert "The first rule: Phenotype lissencephaly at both" in text
    (line,) = [line for line in text.splitlines() if line.startswith("| P18 ")]
    assert line.endswith("| pass | fail |")
    (line,) = [line for line in text.splitlines() if line.startswith("| P3 ")]
    assert line.endswith("| pass |  |")
    cells = Cells(scoreboard_page(board)).cells
    assert cells.count("✗ fail") == 1
