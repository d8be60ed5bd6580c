"""Every command takes the same options, and a missing extra is told in the same way everywhere."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from cyclopts import App

import gyrify
from gyrify.cli import main
from gyrify.cli.app import app
from gyrify.config import Config
from gyrify.errors import ConfigError
from gyrify.run.simulation import simulate
from gyrify.store import History
from gyrify.threshold import critical_growth

Capture = pytest.CaptureFixture[str]
# What has work for several processes, and what writes files of its own.
WORKS = {"threshold", "converge", "study", "paper"}
WRITES = {"run", "converge", "study", "paper", "export", "report", "plot", "animate"}
CHOOSES = {"run", "threshold", "converge", "config show", "config check"}
COMMANDS = {
    "run",
    "resume",
    "verify",
    "threshold",
    "converge",
    "study",
    "table",
    "paper",
    "export",
    "report",
    "plot",
    "animate",
    "presets",
    "config show",
    "config check",
    "config schema",
}


def commands(parent: App, prefix: str = "") -> Iterator[tuple[str, App]]:
    """Every command with its whole name."""
    for name in parent:
        if name.startswith("-"):
            continue
        command = parent[name]
        if command.default_command is None:
            yield from commands(command, f"{prefix}{name} ")
        else:
            yield f"{prefix}{name}", command


OPTIONS = {
    name: {option for argument in command.assemble_argument_collection() for option in argument.names}
    for name, command in commands(app)
}


def test_the_table_has_every_command() -> None:
    assert set(OPTIONS) >= COMMANDS


@pytest.mark.parametrize("name", sorted(OPTIONS))
def test_a_command_has_the_options_of_all(name: str) -> None:
    wanted = {"--json", "--quiet"}
    wanted |= {"--workers"} if name in WORKS else set()
    wanted |= {"--out"} if name in WRITES else set()
    wanted |= {"--set", "--preset", "--growth-ratio", "--seed"} if name in CHOOSES else set()
    assert wanted - OPTIONS[name] == set()


@pytest.mark.parametrize("name", sorted(OPTIONS))
def test_help_says_the_same_of_the_same_option(name: str) -> None:
    command = app
    for word in name.split():
        command = command[word]
    text = " ".join(command.generate_docs(output_format="markdown").split())
    assert "Show no progress." in text
    assert ("by default the number of cores" in text) == (name in WORKS)


@pytest.fixture
def run(tiny: Config, tmp_path: Path) -> str:
    """Folder of a run."""
    simulate(tiny, tmp_path / "run")
    return str(tmp_path / "run")


@pytest.mark.parametrize(
    "command", [["verify"], ["plot", "--dpi", "50"], ["report"], ["export", "--format", "csv"]]
)
def test_quiet_leaves_the_result(run: str, command: list[str], capsys: Capture) -> None:
    name, *options = command
    assert main([name, run, *options]) == 0
    loud = capsys.readouterr()
    assert main([name, run, *options, "--quiet"]) == 0
    quiet = capsys.readouterr()
    assert quiet.out == loud.out != ""
    assert main([name, run, *options, "--quiet", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)


def hide(monkeypatch: pytest.MonkeyPatch, module: str) -> None:
    """Let a package be missing."""
    monkeypatch.setitem(sys.modules, module, None)


@pytest.mark.parametrize(
    ("module", "package", "extra", "command"),
    [
        ("meshio", "meshio", "export", ["export", "RUN", "--format", "vtu"]),
        ("imageio_ffmpeg", "imageio-ffmpeg", "video", ["animate", "RUN", "--out", "growth.mp4"]),
        ("distributed", "distributed", "cluster", ["study", "STUDY", "--scheduler", "tcp://localhost:1"]),
        ("optuna", "optuna", "search", ["paper", "--readings", "--workers", "1", "--quiet"]),
    ],
)
def test_a_missing_extra_is_a_usage_error_that_names_it(
    run: str,
    tmp_path: Path,
    module: str,
    package: str,
    extra: str,
    command: list[str],
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capture,
) -> None:
    study = tmp_path / "ratios.toml"
    study.write_text('[design]\nkind = "grid"\n[[design.parameter]]\nkey = "growth.ratio"\nvalues = [1, 2]\n')
    monkeypatch.chdir(tmp_path)
    hide(monkeypatch, module)
    words = {"RUN": run, "STUDY": str(study)}
    assert main([words.get(word, word) for word in command]) == 2
    err = capsys.readouterr().err
    assert f"needs the package {package}, which is not installed" in err
    assert f"pip install {package} " in err
    assert f"'.[{extra}]'" in err


@pytest.mark.parametrize(("module", "method"), [("pandas", "to_dataframe"), ("pyvista", "to_pyvista")])
def test_a_missing_extra_in_a_notebook(
    run: str, module: str, method: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    hide(monkeypatch, module)
    with pytest.raises(ConfigError, match=rf"pip install {module} .*'\.\[notebook\]'"):
        getattr(History.load(run), method)()


def test_thresholds_are_the_same_with_more_workers(tiny: Config) -> None:
    options = {"definition": "visible", "range": (1.0, 8.0), "points": 3, "level": 1.001, "tolerance": 0.3}
    one, two = (critical_growth(tiny, "growth.ratio", workers=n, **options) for n in (1, 2))  # type: ignore[arg-type]
    assert one.scan == two.scan
    assert (one.critical_value, one.evaluations) == (two.critical_value, two.evaluations)
    with pytest.raises(ConfigError, match="workers = 0 is out of range"):
        critical_growth(tiny, workers=0)


def test_a_run_that_a_limit_stops_gives_no_index(tiny: Config) -> None:
    config = tiny.replace(**{"limits.wall_time": 0.15, "solver.increments": 400})
    with pytest.raises(gyrify.LimitReachedError):
        critical_growth(config, "growth.time", "visible", range=(0.5 * 500, 500.0))
