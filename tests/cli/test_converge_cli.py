"""``gyrify converge``: table, JSON, files, exit codes, Ctrl-C."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from gyrify.cli import main
from gyrify.config import Config

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def toml(tiny: Config, tmp_path: Path) -> str:
    path = tmp_path / "tiny.toml"
    path.write_text(tiny.to_toml())
    return str(path)


def test_it_prints_a_table_and_writes_its_folder(toml: str, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / "study"
    command = ["converge", toml, "--levels", "2", "--of", "increments,contact", "--workers", "1"]
    assert main([*command, "--out", str(out)]) == 0
    printed, said = capsys.readouterr()
    assert "Refined: increments" in printed
    assert "Refined: contact" in printed
    assert "GI, hull" in printed
    assert "converged to" in printed
    assert str(out) in printed
    told = [line for line in said.splitlines() if not line.startswith("gyrify: Warning: ")]
    assert [line.split(":")[1].strip() for line in told] == ["1 of 3", "2 of 3", "3 of 3"]
    assert {file.name for file in out.iterdir()} >= {
        "convergence.csv",
        "convergence.json",
        "increments-metrics.png",
        "contact-shapes.png",
    }


def test_json_is_the_file_and_overrides_are_those_of_run(toml: str, tmp_path: Path, capsys: Capture) -> None:
    command = ["converge", toml, "--levels", "2", "--of", "increments", "--workers", "1", "--json", "--quiet"]
    overrides = ["--stiffness-ratio", "1/1.36", "--set", "mesh.n_around=60", "--tolerance", "1/4"]
    assert main([*command, *overrides, "--out", str(tmp_path / "study")]) == 0
    printed, said = capsys.readouterr()
    found = json.loads(printed)
    # The mesh of 60 points is late, which --quiet and --json do not hide.
    assert any("points of the contour on a wave" in warning for warning in found["warnings"])
    assert said == "".join(f"gyrify: Warning: {warning}\n" for warning in found["warnings"])
    assert found == json.loads((tmp_path / "study" / "convergence.json").read_text())
    assert found["tolerance"] == 0.25
    levels = found["families"][0]["levels"]
    assert [level["level"] for level in levels] == ["8 increments", "16 increments"]
    assert levels[0]["contour_nodes"] == 60
    assert levels[0]["run"] == found["config_hash"][:12]


def test_a_failed_run_is_named_and_gives_exit_code_1(toml: str, tmp_path: Path, capsys: Capture) -> None:
    perfect = ["--set", "dissipation.kind=none", "--set", "mesh.node_jitter=0.0", "--stiffness-ratio", "3"]
    command = ["converge", toml, "--levels", "2", "--of", "increments", "--workers", "1"]
    assert main([*command, *perfect, "--out", str(tmp_path / "study")]) == 1
    printed, said = capsys.readouterr()
    assert "8 increments (failed)" in " ".join(printed.split())
    assert "Buckling instability" in printed
    assert "failed" in said


@pytest.mark.parametrize(
    "wrong",
    [
        ["--of", "mesh,time"],
        ["--of", ","],
        ["--levels", "1"],
        ["--levels", "6"],
        ["--tolerance", "half"],
        ["--workers", "0"],
        ["--set", "mesh.n_around=3"],
    ],
)
def test_bad_arguments_give_exit_code_2(toml: str, tmp_path: Path, capsys: Capture, wrong: list[str]) -> None:
    assert main(["converge", toml, *wrong, "--out", str(tmp_path / "study")]) == 2
    printed, said = capsys.readouterr()
    assert printed == ""
    assert said.startswith("gyrify: ")
    assert "Traceback" not in said


@pytest.mark.skipif(sys.platform == "win32", reason="signals are those of POSIX")
def test_ctrl_c_ends_every_process_and_the_same_command_continues(toml: str, tmp_path: Path) -> None:
    out = tmp_path / "study"
    arguments = ["converge", toml, "--levels", "2", "--of", "increments", "--workers", "2", "--out", str(out)]
    arguments += ["--set", "solver.increments=600"]
    command = [sys.executable, "-m", "gyrify.cli", *arguments]
    # A job in the background of a shell begins with Ctrl-C ignored; this one must listen.
    listens = {"preexec_fn": lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)}
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True, **listens)
    deadline = time.monotonic() + 60.0
    while not list(out.glob("runs/*/journal.sqlite")) and time.monotonic() < deadline:
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "same command" in said
    assert "Traceback" not in said
    assert not list(out.glob("runs/*/run.owner.json"))  # every run was let go of in an orderly way
    arguments[arguments.index("2", arguments.index("--workers"))] = "1"
    assert main(arguments) == 0
