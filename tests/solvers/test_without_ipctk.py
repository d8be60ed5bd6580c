"""Platforms that ipctk has no package for: contact by gyrify's own kernels, recorded and kept."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from packaging.requirements import Requirement

from gyrify import Config, History, HistoryError, SolveError, resume, simulate
from gyrify.energy.contact_libraries import contact_library
from gyrify.run import running as runs

HAS_IPCTK = contact_library() == "ipctk"
SMALL = {"mesh.n_around": 96, "mesh.n_layers": 10, "mesh.n_cortex_layers": 4, "solver.increments": 40}
WITHOUT = "import sys; sys.modules['ipctk'] = None; from gyrify.cli import main; sys.exit(main())"


@pytest.fixture
def config() -> Config:
    return Config().with_overrides(SMALL)


def command(code: str, *arguments: str) -> tuple[int, str, str]:
    done = subprocess.run(
        [sys.executable, "-c", code, *arguments], capture_output=True, text=True, env=os.environ
    )
    return done.returncode, done.stdout, done.stderr


def test_a_slice_folds_and_is_verified_without_ipctk(config: Config, tmp_path: Path) -> None:
    toml, folder = tmp_path / "slice.toml", tmp_path / "run"
    toml.write_text(config.to_toml(), encoding="utf-8")
    code, printed, said = command(WITHOUT, "run", str(toml), "--out", str(folder), "--json")
    assert code == 0, said
    summary = json.loads(printed)
    assert summary["solver"]["contact_library"] == "gyrify"
    assert summary["gi"]["closing"] > 1.1
    assert not summary["self_intersecting"]
    for with_or_without in (WITHOUT, "import sys; from gyrify.cli import main; sys.exit(main())"):
        code, _, said = command(with_or_without, "verify", str(folder))
        assert code == 0, said


@pytest.mark.skipif(not HAS_IPCTK, reason="needs ipctk to compare with")
def test_both_libraries_find_the_same_folds(config: Config, monkeypatch: pytest.MonkeyPatch) -> None:
    with_ipctk = simulate(config)
    assert with_ipctk.contact_library == "ipctk"
    monkeypatch.setitem(sys.modules, "ipctk", None)
    monkeypatch.delitem(sys.modules, "gyrify.energy.toolkit")
    without = simulate(config)
    assert without.contact_library == "gyrify"
    assert abs(with_ipctk.points() - without.points()).max() < 1e-3


def begun(config: Config, folder: Path, increments: int = 20) -> None:
    """A run that an observer ended after some increments."""

    def stop(progress: object) -> None:
        if progress.state.index >= increments:  # type: ignore[attr-defined]
            raise SolveError("That is enough.")

    with pytest.raises(SolveError):
        simulate(config, folder, observers=[stop])


@pytest.fixture
def installed(monkeypatch: pytest.MonkeyPatch) -> Callable[[str], None]:
    """Have a library be the one that is installed."""

    def choose(name: str) -> None:
        monkeypatch.setattr(runs, "contact_library", lambda: name)
        monkeypatch.setattr("gyrify.model.slice.Slice.contact_library", name)

    return choose


def test_a_run_goes_on_with_the_kernels_that_it_began_with(
    config: Config, tmp_path: Path, installed: Callable[[str], None]
) -> None:
    installed("gyrify")
    begun(config, tmp_path / "run")
    whole = simulate(config).result_hash
    installed(contact_library())
    history = resume(tmp_path / "run")
    assert history.contact_library == "gyrify"
    assert history.result_hash == whole


@pytest.mark.skipif(not HAS_IPCTK, reason="needs ipctk to begin with")
def test_a_run_that_began_with_ipctk_is_not_continued_without(
    config: Config, tmp_path: Path, installed: Callable[[str], None]
) -> None:
    begun(config, tmp_path / "run")
    stored = len(History.load(tmp_path / "run"))
    installed("gyrify")
    with pytest.raises(HistoryError, match="begun with contact by ipctk, which is not installed here"):
        resume(tmp_path / "run")
    assert len(History.load(tmp_path / "run")) == stored


def test_without_contact_it_does_not_matter(
    config: Config, tmp_path: Path, installed: Callable[[str], None]
) -> None:
    free = config.replace(**{"contact.enabled": False})
    begun(free, tmp_path / "run", 3)
    installed("gyrify")
    assert resume(tmp_path / "run").contact_library == "none"


@pytest.mark.parametrize(
    ("system", "processor", "is_wanted"),
    [
        ("linux", "x86_64", True),
        ("linux", "aarch64", False),
        ("darwin", "arm64", True),
        ("darwin", "x86_64", False),
        ("win32", "AMD64", True),
        ("win32", "ARM64", False),
    ],
)
def test_ipctk_is_asked_for_where_it_has_packages(system: str, processor: str, is_wanted: bool) -> None:
    text = (Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8")
    found = [Requirement(line) for line in tomllib.loads(text)["project"]["dependencies"]]
    (ipctk,) = [requirement for requirement in found if requirement.name == "ipctk"]
    assert ipctk.marker is not None
    assert ipctk.marker.evaluate({"sys_platform": system, "platform_machine": processor}) == is_wanted
