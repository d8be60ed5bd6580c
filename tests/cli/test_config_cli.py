"""``gyrify presets`` and ``gyrify config``: output, exit codes, and what is not imported."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from gyrify import __version__
from gyrify.cli import main
from gyrify.cli.overrides import read_value, resolve_config
from gyrify.config import Config, preset_names
from gyrify.errors import ConfigError, GyrifyError, HistoryError, SolveError

Capture = pytest.CaptureFixture[str]


def run_json(capsys: Capture, *arguments: str) -> tuple[int, object, str]:
    code = main([*arguments, "--json"])
    captured = capsys.readouterr()
    return code, json.loads(captured.out), captured.err


@pytest.mark.parametrize(
    "arguments", [["--help"], ["config", "--help"], ["config", "show", "--help"], ["presets", "-h"]]
)
def test_help(arguments: list[str], capsys: Capture) -> None:
    assert main(arguments) == 0
    captured = capsys.readouterr()
    assert "Usage: gyrify" in captured.out
    assert captured.err == ""


def test_version(capsys: Capture) -> None:
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.strip() == __version__


def test_presets(capsys: Capture) -> None:
    assert main(["presets"]) == 0
    shown = capsys.readouterr().out
    assert all(name in shown for name in preset_names())
    code, listed, stderr = run_json(capsys, "presets")
    assert (code, stderr) == (0, "")
    assert isinstance(listed, list)
    assert [about["name"] for about in listed] == list(preset_names())


def test_show_plain(capsys: Capture) -> None:
    assert main(["config", "show", "--stiffness-ratio", "1/1.36", "--set", "mesh.n_around=400"]) == 0
    shown = capsys.readouterr().out
    lines = {line.split()[0]: line for line in shown.splitlines()}
    assert str(1 / 1.36) in lines["material.stiffness_ratio"]
    assert "Wang" not in lines["material.stiffness_ratio"]
    assert "mm²" in lines["geometry.area"]
    assert "Fig. 1" in lines["geometry.area"]
    assert lines["mesh.n_around"].split()[1] == "400"


def test_show_on_a_terminal(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    monkeypatch.setenv("COLUMNS", "160")
    assert main(["config", "show"]) == 0
    shown = capsys.readouterr().out
    assert "│" in shown
    assert "poisson_ratio_white" in shown


def test_show_json_and_toml_agree(capsys: Capture) -> None:
    code, document, stderr = run_json(capsys, "config", "show", "--seed", "7")
    assert (code, stderr) == (0, "")
    assert isinstance(document, dict)
    assert main(["config", "show", "--seed", "7", "--toml"]) == 0
    assert tomllib.loads(capsys.readouterr().out) == document["config"]
    assert document["config_hash"] == Config(seed=7).config_hash


def test_check(tmp_path: Path, capsys: Capture) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(Config().to_toml())
    assert main(["config", "check", str(path)]) == 0
    assert "valid" in capsys.readouterr().out
    code, document, _ = run_json(capsys, "config", "check", str(path))
    assert (code, document) == (0, {"valid": True, "config_hash": Config().config_hash, "warnings": []})


def test_schema(capsys: Capture) -> None:
    assert main(["config", "schema"]) == 0
    assert "growth" in json.loads(capsys.readouterr().out)["properties"]


def test_errors_are_json_too(capsys: Capture) -> None:
    code, document, stderr = run_json(capsys, "config", "check", "--growth-ratio", "0")
    assert code == 2
    assert isinstance(document, dict)
    assert document["error"] == "ConfigError"
    assert document["message"] in stderr


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (ConfigError("wrong"), 2),
        (HistoryError("wrong"), 2),
        (SolveError("wrong", "Try."), 1),
        (GyrifyError("wrong"), 1),
        (KeyboardInterrupt(), 130),
    ],
)
def test_exit_codes(
    error: BaseException, code: int, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    def fail(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr("gyrify.cli.app.app", fail)
    assert main([]) == code
    captured = capsys.readouterr()
    assert captured.out == ""
    assert ("wrong" in captured.err) == isinstance(error, GyrifyError)


def test_resolution_order(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text('preset = "no-such-preset"\nseed = 5\n[growth]\nratio = 2.0\nrate = 0.001\n')
    config = resolve_config(
        path, "wang2019", growth_ratio="1/0.5", thickness="3", set_=["growth.rate = 3e-3"]
    )
    assert (config.seed, config.growth.ratio, config.growth.rate) == (5, 2.0, 0.003)
    assert config.geometry.cortical_thickness == 3.0
    assert resolve_config() == Config()


def test_override_mends_a_file_but_hides_no_fault(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text("[growth]\nratio = -1\n")
    assert resolve_config(path, growth_ratio="2").growth.ratio == 2.0
    path.write_text("growth = 3\n")
    with pytest.raises(ConfigError, match="must be a table"):
        resolve_config(path, growth_ratio="2")


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("3", 3),
        ("-3", -3),
        ("3.", 3.0),
        (".5", 0.5),
        ("1e3", 1000.0),
        ("1/1.36", "1/1.36"),
        ("true", True),
        ("circle", "circle"),
        ('"circle"', "circle"),
        ('["J"]', ["J"]),
        ("1\nother = 2", "1\nother = 2"),
        ("", ""),
        ("[" * 9999, "[" * 9999),
        ("9" * 5000, "9" * 5000),
    ],
)
def test_values_on_the_command_line(text: str, value: object) -> None:
    read = read_value(text)
    assert (read, type(read)) == (value, type(value))


@pytest.mark.parametrize(
    "arguments",
    [["--help"], ["--version"], ["presets"], ["config", "show"], ["config", "schema"]],
)
def test_nothing_heavy_is_imported(arguments: list[str]) -> None:
    command = [sys.executable, "-X", "importtime", "-m", "gyrify.cli", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=True)
    imported = {line.rpartition("|")[2].strip().partition(".")[0] for line in done.stderr.splitlines()}
    assert not imported & {"numpy", "numba", "scipy", "matplotlib", "h5py", "shapely", "ipctk"}
    assert "cyclopts" in imported
    if arguments[0].startswith("--"):
        assert "pydantic" not in imported


def test_ascii_terminal() -> None:
    command = [sys.executable, "-m", "gyrify.cli", "config", "check", "--set", "geometry.area=0"]
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    assert done.returncode == 2
    assert "mm\\xb2" in done.stderr
    assert done.stdout == ""


def test_reader_that_leaves_a_pipe() -> None:
    command = [sys.executable, "-m", "gyrify.cli", "config", "schema"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        assert process.stderr.read() == b""
    assert process.returncode == 0
