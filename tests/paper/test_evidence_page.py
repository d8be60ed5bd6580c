"""The results of a search find their places on the evidence page."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest
from fake_simulations import FakeSimulations

from gyrify.config import Config
from gyrify.paper.ensemble import repeat
from gyrify.paper.search import search
from gyrify.report.paper_readings import write_readings
from gyrify.report.paper_tables import scoreboard_markdown, write_text

SCRIPT = Path(__file__).parents[2] / "docs" / "figures" / "paper_evidence.py"


@pytest.fixture(scope="module")
def script() -> ModuleType:
    spec = importlib.util.spec_from_file_location("paper_evidence", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("paper")
    simulations = FakeSimulations(workers=2)
    found = search(simulations, Config(), rounds=1)
    ensembles = [repeat(simulations, Config(), c.reading, stability=False) for c in found.fitted.ranked[:2]]
    write_readings(found, ensembles, out)
    write_text(out / "best-1" / "scoreboard.md", scoreboard_markdown(ensembles[0].members[0].scoreboard))
    return out


def test_the_page_has_both_places(script: ModuleType) -> None:
    page = script.PAGE.read_text(encoding="utf-8")
    filled = script.replaced(script.replaced(page, "ranking", "R\\1"), "best", "B")
    assert "<!-- scan: begin ranking -->\nR\\1\n<!-- scan: end ranking -->" in filled
    assert "<!-- scan: begin best -->\nB\n<!-- scan: end best -->" in filled
    with pytest.raises(SystemExit, match="no place for worst"):
        script.replaced(page, "worst", "")


def test_the_ranking_is_all_but_the_seeds(script: ModuleType, folder: Path) -> None:
    text = script.ranking(folder)
    assert text.startswith("12 readings in 1 rounds")
    for heading in ("With fitted constants", "What guidance brings", "What constants bring"):
        assert f"\n### {heading}\n" in text
    assert "± " not in text
    assert "| P18 |" in text


def test_the_best_comes_with_its_spread(script: ModuleType, folder: Path) -> None:
    text = script.best(folder)
    assert text.startswith("Reading: ")
    assert "| P18 |" in text
    assert "- **P" in text
    (line,) = [line for line in text.splitlines() if line.startswith("| reading |")]
    after = text.splitlines()[text.splitlines().index(line) + 2 :]
    assert after[0].count("±") == after[1].count("±") >= 6
    assert "fresh seeds" in line
    shares = [line for line in text.splitlines() if line.count("/5 |") == 18]
    assert len(shares) == 2
