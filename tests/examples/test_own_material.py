"""A material that an example adds: a run with it folds, verifies, and tells that theory does not cover it."""

from __future__ import annotations

from pathlib import Path

import pytest

import gyrify
from gyrify.config import Config
from gyrify.physics.materials import MATERIALS
from gyrify.report.outputs import write_outputs
from gyrify.verify import verify


@pytest.fixture
def ogden(example):
    material = example("own_material").OGDEN
    MATERIALS.append(material)
    yield material
    MATERIALS.remove(material)


def test_a_run_with_it_folds_and_verifies(ogden, folding: Config, tmp_path: Path) -> None:
    config = folding.with_overrides({"material.law": ogden.name, "growth.duration": 500.0})
    history = gyrify.simulate(config, tmp_path / "run")
    write_outputs(history, tmp_path / "run")
    assert history.status == "completed"
    summary = gyrify.summarise(history)
    assert summary["gi"]["closing"] > 1.03
    assert ogden.name in summary["expected"]["not_covered"]
    assert verify(tmp_path / "run").passed
    assert (
        history.result_hash != gyrify.simulate(folding.with_overrides({"growth.duration": 500.0})).result_hash
    )
