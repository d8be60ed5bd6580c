"""The same run again: done already or continued; configurations from elsewhere than a file."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

import gyrify
from gyrify.cli import main
from gyrify.config import Config
from gyrify.errors import ConfigError, HistoryError
from gyrify.report import outputs
from gyrify.run.running import Progress
from gyrify.run.simulation import new_run, simulate
from gyrify.store import History

Capture = pytest.CaptureFixture[str]
GYRIFY = (sys.executable, "-m", "gyrify.cli")


@pytest.fixture
def toml(tiny: Config, tmp_path: Path) -> Path:
    path = tmp_path / "tiny.toml"
    path.write_text(tiny.to_toml())
    return path


def half_run(config: Config, folder: Path) -> None:
    """A run that was interrupted after its fourth increment."""

    def interrupt(progress: Progress) -> None:
        if progress.state.index == 4:
            raise KeyboardInterrupt

    with suppress(KeyboardInterrupt), new_run(config, folder) as run:
        run.grow([interrupt])


def test_a_command_closes_the_run_though_somebody_holds_it(
    toml: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else files of a database in use stay in the folder until Python collects its garbage."""
    held, write = [], outputs.write_outputs

    def hold(history: History, folder: Path) -> dict[str, object]:
        held.append(history)
        return write(history, folder)

    monkeypatch.setattr(outputs, "write_outputs", hold)
    assert main(["run", str(toml), "--out", str(tmp_path / "run"), "--quiet"]) == 0
    assert len(held) == 1
    assert sorted(file.name for file in (tmp_path / "run").glob("journal*")) == ["journal.sqlite"]


def test_the_same_run_again_is_done_already(toml: Path, tmp_path: Path, capsys: Capture) -> None:
    folder = tmp_path / "run"
    command = ["run", str(toml), "--out", str(folder)]
    assert main([*command, "--json", "--quiet"]) == 0
    summary = json.loads(capsys.readouterr().out)
    before = {file.name: (file.read_bytes(), file.stat().st_mtime_ns) for file in folder.iterdir()}
    assert main([*command, "--json"]) == 0
    out, err = capsys.readouterr()
    assert json.loads(out) == summary
    assert "already holds this run, and it is complete: nothing is computed" in err
    assert "Warning: " in err
    assert main(command) == 0
    assert capsys.readouterr().out.startswith("GI ")
    assert {f.name: (f.read_bytes(), f.stat().st_mtime_ns) for f in folder.iterdir()} == before


def test_a_run_that_ended_early_is_continued(
    toml: Path, tiny: Config, tmp_path: Path, capsys: Capture
) -> None:
    folder = tmp_path / "run"
    half_run(tiny, folder)
    assert main(["run", str(toml), "--out", str(folder)]) == 0
    err = capsys.readouterr().err
    assert "it is not complete: it is continued" in err
    assert "growth time 250 of 500" not in err  # that was known
    history = History.load(folder)
    assert (history.status, history.result_hash) == ("completed", simulate(tiny).result_hash)


def test_limits_of_the_second_call_hold(toml: Path, tiny: Config, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    command = ["run", str(toml), "--out", str(folder), "--quiet"]
    assert main([*command, "--set", "limits.wall_time=1e-6"]) == 3
    assert main(command) == 0  # the limit is lifted
    assert History.load(folder).result_hash == simulate(tiny).result_hash
    assert main([*command, "--set", "output.every=4"]) == 0
    assert History.load(folder).config.output.every == 4


def test_files_that_are_missing_are_written_again(toml: Path, tmp_path: Path, capsys: Capture) -> None:
    folder = tmp_path / "run"
    command = ["run", str(toml), "--out", str(folder)]
    assert main([*command, "--quiet"]) == 0
    for name in ("folded.png", "summary.json"):
        (folder / name).unlink()
        capsys.readouterr()
        assert main(command) == 0
        assert "its files are written again" in capsys.readouterr().err
        assert (folder / name).is_file()


def test_another_configuration_is_refused_with_what_differs(
    toml: Path, tmp_path: Path, capsys: Capture
) -> None:
    folder = tmp_path / "run"
    command = ["run", str(toml), "--out", str(folder), "--quiet"]
    assert main(command) == 0
    before = (folder / "journal.sqlite").read_bytes()
    capsys.readouterr()
    assert main([*command, "--growth-ratio", "2", "--seed", "7"]) == 2
    err = capsys.readouterr().err
    assert "growth.ratio is 3.6 there and 2.0 here" in err
    assert "seed is 0 there and 7 here" in err
    assert "--overwrite" in err
    assert (folder / "journal.sqlite").read_bytes() == before


def test_another_version_is_told(toml: Path, tmp_path: Path, capsys: Capture) -> None:
    folder = tmp_path / "run"
    command = ["run", str(toml), "--out", str(folder)]
    assert main([*command, "--quiet"]) == 0
    summary = json.loads((folder / "summary.json").read_text())
    summary["versions"]["gyrify"] = "0.0.1"
    (folder / "summary.json").write_text(json.dumps(summary))
    capsys.readouterr()
    assert main(command) == 0
    assert "computed with other versions (gyrify 0.0.1); --overwrite computes it again" in (
        capsys.readouterr().err
    )


def test_from_python_too(tiny: Config, tmp_path: Path) -> None:
    seen: list[Progress] = []
    half_run(tiny, tmp_path / "run")
    whole = simulate(tiny, tmp_path / "run", observers=[seen.append])
    assert [progress.state.index for progress in seen] == [5, 6, 7, 8]
    seen.clear()
    again = simulate(tiny, tmp_path / "run", observers=[seen.append])
    assert not seen
    assert again.result_hash == whole.result_hash == simulate(tiny).result_hash
    with pytest.raises(HistoryError, match="seed is 0 there and 1 here"):
        simulate(tiny.replace(seed=1), tmp_path / "run")
    assert simulate(tiny.replace(seed=1), tmp_path / "run", overwrite=True).config.seed == 1


def test_a_configuration_from_standard_input(toml: Path, tmp_path: Path) -> None:
    def piped(*arguments: str, text: str) -> subprocess.CompletedProcess[str]:
        command = [*GYRIFY, *arguments]
        return subprocess.run(command, cwd=tmp_path, input=text, capture_output=True, text=True)

    text = toml.read_text()
    done = piped("config", "check", "-", text=text)
    assert (done.returncode, done.stdout[:26]) == (0, "The configuration is valid")
    done = piped("run", "-", "--out", "run", "--quiet", "--growth-ratio", "3", text=text)
    assert done.returncode == 0, done.stderr
    assert History.load(tmp_path / "run").config == Config.load(toml).replace(**{"growth.ratio": 3.0})
    done = piped("run", "-", text="")
    assert (done.returncode, "Standard input is empty" in done.stderr) == (2, True)
    done = piped("config", "check", "-", text="growth = ")
    assert (done.returncode, "Standard input is not valid TOML" in done.stderr) == (2, True)
    study = '[[design.parameter]]\nkey = "growth.ratio"\nvalues = [1, 2]\n'
    assert "Add --out DIR" in piped("study", "-", text=study).stderr
    assert "describes a study" in piped("run", "-", text=study).stderr


def test_a_study_given_to_run_and_the_reverse(toml: Path, tmp_path: Path, capsys: Capture) -> None:
    study = tmp_path / "ratios.toml"
    study.write_text('[[design.parameter]]\nkey = "growth.ratio"\nvalues = [1, 2]\n')
    assert main(["run", str(study)]) == 2
    assert f"Run it with: gyrify study {study}" in capsys.readouterr().err
    assert main(["study", str(toml)]) == 2
    assert f"Run it with: gyrify run {toml}" in capsys.readouterr().err
    assert main(["table", str(toml)]) == 2
    with pytest.raises(ConfigError, match="run_study"):
        Config.from_dict({"design": {}})
    with pytest.raises(ConfigError, match="gyrify run"):
        gyrify.Study.from_mapping({"growth": {"ratio": 2}})


def test_python_takes_paths_and_tables(tiny: Config, toml: Path, tmp_path: Path) -> None:
    hashes = {
        simulate(given).config.config_hash  # type: ignore[arg-type]
        for given in (tiny, toml, str(toml), tiny.to_dict(), {**tiny.to_dict(), "seed": 0})
    }
    assert hashes == {tiny.config_hash}
    found = gyrify.critical_growth(str(toml), "growth.time", range=(0.5, 1.0), points=2)
    assert found.parameter == "growth.time"
    result = gyrify.converge(toml, tmp_path / "convergence", levels=2, of=["increments"])
    assert result.config == tiny
    with pytest.raises(ConfigError, match="is a preset, not a file"):
        simulate("wang2019")
    with pytest.raises(ConfigError, match=r"Config\.from_toml"):
        simulate("seed = 1")
    with pytest.raises(ConfigError, match="object of type int"):
        simulate(3)  # type: ignore[arg-type]


@pytest.mark.parametrize("is_terminal", [False, True])
def test_progress_from_python(tiny: Config, monkeypatch: pytest.MonkeyPatch, is_terminal: bool) -> None:
    stream = io.StringIO()
    monkeypatch.setattr(stream, "isatty", lambda: is_terminal, raising=False)
    monkeypatch.setitem(os.environ, "TERM", "xterm")
    monkeypatch.setattr(sys, "stderr", stream)
    simulate(tiny)
    assert stream.getvalue() == ""
    simulate(tiny, progress=True)
    assert ("growth time 500 of 500" in stream.getvalue()) != is_terminal
    assert ("time 500/500" in stream.getvalue()) == is_terminal
