"""Runs that gyrify 0.1.0 stored verify, and go on to the same end, or it is said why they cannot."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

import gyrify
from gyrify.config import Config
from gyrify.energy.contact_libraries import contact_library
from gyrify.errors import HistoryError
from gyrify.solve.linear import linear_solver
from gyrify.verify import verify

STORED = Path(__file__).parents[1] / "data" / "run-0.1.0"


@pytest.fixture
def copied(tmp_path: Path):
    """A copy of a stored run."""

    def copy(name: str) -> Path:
        return Path(shutil.copytree(STORED / name, tmp_path / name))

    return copy


@pytest.mark.parametrize("name", ["complete", "interrupted", "sawtooth"])
def test_it_verifies(copied, name: str) -> None:
    found = verify(copied(name))
    assert found.passed, str(found)


@pytest.mark.parametrize("name", ["complete", "interrupted", "sawtooth"])
def test_its_configuration_has_the_hash_that_it_had(name: str) -> None:
    config = Config.load(STORED / name / "config.toml")
    told = STORED / name.replace("interrupted", "complete") / "summary.json"
    expected = json.loads(told.read_text())
    assert config.config_hash == expected["config_hash"]
    # written again, with the keys that came later, it is the same configuration
    assert Config.from_toml(config.to_toml()).config_hash == expected["config_hash"]


def test_all_that_is_read_of_a_run_is_read_of_it(copied) -> None:
    history = gyrify.History.load(copied("complete"))
    summary = gyrify.summarise(history)
    stored = json.loads((STORED / "complete" / "summary.json").read_text())
    assert summary["result_hash"] == stored["result_hash"]
    assert summary["gi"]["hull"] == pytest.approx(stored["gi"]["hull"], rel=1e-9)
    assert gyrify.plot(history, "energy").axes


@pytest.mark.skipif(
    (linear_solver("auto").name, contact_library()) != ("pardiso", "ipctk"), reason="it was begun with both"
)
def test_it_is_continued_to_the_end_that_the_old_version_came_to(copied) -> None:
    history = gyrify.resume(copied("interrupted"))
    assert history.status == "completed"
    last = gyrify.History.load(copied("complete")).displacement()
    # to the last bit on the machine that made them
    assert history.displacement() == pytest.approx(last, abs=1e-6)


def test_without_the_library_that_it_began_with_it_says_why_it_cannot_go_on(
    copied, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("gyrify.run.running.contact_library", lambda *_: "gyrify")
    with pytest.raises(HistoryError, match="begun with contact by ipctk, which is not installed here"):
        gyrify.resume(copied("interrupted"))
