"""Configuration, mesh and tissue are built once for a run, and its last state is measured once."""

from __future__ import annotations

from pathlib import Path

import pytest

import gyrify
from gyrify.config import Config
from gyrify.model import meshing
from gyrify.model.tissue import Tissue
from gyrify.report.outputs import write_outputs
from gyrify.run import body_measures


class Counter:
    """Counts the calls of a function."""

    def __init__(self, function) -> None:
        self._function, self.calls = function, []

    def __call__(self, *arguments, **options):
        self.calls.append(arguments)
        return self._function(*arguments, **options)


def test_a_run_and_its_files_build_one_mesh_and_measure_each_state_once(
    tiny: Config, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # with node jitter the search for the onset has a perfect slice of its own
    config = tiny.with_overrides({"stability.detect": False})
    meshes, measured = Counter(meshing._built), Counter(body_measures.measure_valid)
    parsed = Counter(Config.from_toml)
    tissues = []
    initialise = Tissue.__init__

    def count(self, *arguments) -> None:
        tissues.append(self)
        initialise(self, *arguments)

    monkeypatch.setattr(meshing, "_built", meshes)
    monkeypatch.setattr(body_measures, "measure_valid", measured)
    monkeypatch.setattr(Config, "from_toml", parsed)
    monkeypatch.setattr(Tissue, "__init__", count)
    history = gyrify.simulate(config, tmp_path / "run")
    write_outputs(history, tmp_path / "run")
    # advice on a finer mesh may build that one
    assert [given for given, *_ in meshes.calls if given == config] == [config]
    assert len(tissues) == 1
    assert parsed.calls == []
    assert len(measured.calls) == len(history)
