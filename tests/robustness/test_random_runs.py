"""Thirty random valid configurations: each completes, or stops for a named reason with its evidence."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path

import pytest
import random_runs
from random_configurations import RANGES, SPACES, configuration, draw
from random_runs import Record, campaign, lost, name_of, outcome, read

from gyrify import Config
from gyrify.config.cross_checks import faults
from gyrify.solve.result import Result

# Chunks of the campaign of the reliability page, so that two processes share the work. Numbers 10 to 14 are
# left out for their time: number 12 of the box takes minutes.
CHUNKS = [(space, first) for space in SPACES for first in (0, 5, 15)]


@pytest.mark.parametrize(("space", "first"), CHUNKS)
def test_nothing_is_wrong_and_nearly_all_complete(space: str, first: int, tmp_path: Path) -> None:
    jobs = [(space, 0, number) for number in range(first, first + 5)]
    records = list(campaign(tmp_path / "runs.jsonl", jobs, workers=1))
    counts = Counter(record["outcome"] for record in records)
    assert counts["wrong"] == 0, [record for record in records if record["outcome"] == "wrong"]
    assert counts["completed"] + counts["stopped"] >= 5 - (space == "wide"), counts
    assert read(tmp_path / "runs.jsonl") == records


def test_there_are_thirty_and_every_kind_is_among_them() -> None:
    configs = [configuration(space, 0, first + n) for space, first in CHUNKS for n in range(5)]
    assert len({config.config_hash for config in configs}) == 30
    kinds = {
        "out_of_plane": {config.growth.out_of_plane for config in configs},
        "stretch": {config.growth.stretch for config in configs},
        "energy_per": {config.growth.energy_per for config in configs},
        "law": {config.growth.law for config in configs},
        "shape": {config.geometry.shape for config in configs},
        "element": {config.mesh.element for config in configs},
        "dissipation": {config.dissipation.kind for config in configs if config.dissipation.number > 0.0},
        "dissipates": {config.dissipation.number > 0.0 for config in configs},
        "contact": {config.contact.enabled for config in configs},
    }
    assert {name: len(found) for name, found in kinds.items()} == {
        **dict.fromkeys(kinds, 2),
        **dict.fromkeys(("out_of_plane", "shape", "element"), 3),
    }
    assert len({config.mesh.n_around for config in configs}) == 5
    assert len({config.seed for config in configs}) == 30


def test_a_campaign_goes_on_where_it_was_cut_off(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file, done = tmp_path / "runs.jsonl", []
    file.write_text(json.dumps({"space": "box", "seed": 0, "number": 0}) + "\n" + '{"space": "box", "nu')

    def run_one(job: tuple[str, int, int], _: object = None) -> Record:
        done.append(job[2])
        return {"space": job[0], "seed": job[1], "number": job[2]}

    monkeypatch.setattr(random_runs, "run_one", run_one)
    list(campaign(file, [("box", 0, number) for number in range(3)], workers=1))
    assert done == [1, 2]
    assert [record["number"] for record in read(file)] == [0, 1, 2]


@pytest.mark.parametrize("space", SPACES)
def test_configurations_are_valid_different_and_the_same_every_time(space: str) -> None:
    found = [configuration(space, 0, number) for number in range(40)]
    assert [configuration(space, 0, number) for number in range(3)] == found[:3]
    assert len({config.config_hash for config in found}) == 40
    assert not any(fault for config in found for fault in faults(config))
    for key, (low, high) in RANGES[space].items():
        section, name = key.split(".")
        values = [getattr(getattr(config, section), name) for config in found]
        assert low <= min(values) < max(values) <= high
        assert max(values) / min(values) > 0.3 * high / low


def test_every_choice_is_made() -> None:
    import numpy as np

    rng = np.random.default_rng(0)
    drawn = [draw("wide", rng) for _ in range(300)]
    for key, kinds in {
        "growth.out_of_plane": 3,
        "growth.stretch": 2,
        "growth.energy_per": 2,
        "growth.law": 2,
        "geometry.shape": 3,
        "mesh.element": 3,
        "mesh.split": 3,
        "dissipation.kind": 3,
        "contact.enabled": 2,
    }.items():
        assert len({values[key] for values in drawn}) == kinds, key
    assert any(values.get("stability.follow_branch") for values in drawn)


def record(**changed: object) -> Record:
    """A run that stopped as it should, changed."""
    fine = {"status": "failed", "exit_code": 1, "reason": "unstable", "failed_checks": []}
    return {**fine, "evidence": {"lowest_eigenvalue": 0.1}, **changed}


@pytest.mark.parametrize(
    ("found", "expected"),
    [
        (record(), "stopped"),
        (record(evidence={"lowest_eigenvalue": None}), "wrong"),
        (record(exit_code=0), "wrong"),
        (record(failed_checks=["gap: 0"]), "wrong"),
        (record(reason=""), "wrong"),
        (record(reason="max_newton"), "exhausted"),
        (record(status="stopped", exit_code=3, reason="wall_time"), "exhausted"),
        (record(status="completed", exit_code=0, reason=""), "completed"),
        (record(status="completed", exit_code=1, reason=""), "wrong"),
    ],
)
def test_classes(found: Record, expected: str) -> None:
    assert outcome(found) == expected


def test_every_way_in_which_a_solve_fails_is_on_the_closed_list() -> None:
    for result in Result:
        if result is not Result.CONVERGED:
            assert name_of(f"Growth stopped at 3% of the duration: {result.message} (residual 1).")
    assert name_of("The moon was full.") == ""


def test_a_process_that_died_is_wrong() -> None:
    assert lost(("box", 0, 0))["outcome"] == "wrong"


def test_a_run_that_contradicts_itself_is_found(tmp_path: Path) -> None:
    config = Config()
    summary = {
        "config_hash": config.config_hash,
        "min_J": 0.0,
        "min_J_elastic": 0.1,
        "self_intersecting": True,
        "gi": {"closing": float("nan")},
        "status": "completed",
        "reason": "It stopped.",
    }
    found = random_runs.contradictions(summary, config, tmp_path)
    assert [text.split(":")[0] for text in found] == ["volume", "contour", "index", "reason", "files"]
    other = random_runs.contradictions({**summary, "config_hash": "0"}, config, tmp_path)
    assert other[0].startswith("hash")
