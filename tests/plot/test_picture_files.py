"""``gyrify plot`` and ``gyrify animate``: files, formats, fonts, messages, exit codes."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from PIL import Image

from gyrify.cli import main
from gyrify.report.plot import KINDS

Capture = pytest.CaptureFixture[str]
MM_PER_INCH = 25.4


@pytest.mark.parametrize("what", KINDS)
def test_every_picture_is_written_at_its_width(runs, tmp_path, what, capsys: Capture) -> None:
    path = tmp_path / "a.png"
    assert main(["plot", str(runs["linear"]), "--what", what, "--out", str(path), "--dpi", "100"]) == 0
    assert capsys.readouterr().out == f"{path}\n"
    width = Image.open(path).width / 100 * MM_PER_INCH
    assert width == pytest.approx(180.0 if what in ("stress", "thickness") else 90.0, abs=0.3)
    assert [file.name for file in tmp_path.iterdir()] == ["a.png"]


@pytest.mark.parametrize("suffix", ["svg", "pdf"])
@pytest.mark.parametrize("what", ["stress", "gi"])
def test_files_of_lines_have_the_same_bytes_and_embedded_fonts(runs, tmp_path, suffix, what) -> None:
    paths = [tmp_path / f"{name}.{suffix}" for name in "ab"]
    for path in paths:
        assert main(["plot", str(runs["linear"]), "--what", what, "--out", str(path)]) == 0
    first, second = (path.read_bytes() for path in paths)
    assert first == second
    if suffix == "pdf":
        assert b"/FontFile2" in first  # TrueType, in the file
        assert b"/Type3" not in first
        assert b"CreationDate" not in first
    else:
        assert b"<dc:date>" not in first


def test_by_default_the_picture_lies_in_the_run_folder(runs, capsys: Capture) -> None:
    assert (
        main(["plot", str(runs["strip"]), "--json", "--width", "120", "--dpi", "60", "--at", "1000/4"]) == 0
    )
    written = json.loads(capsys.readouterr().out)
    assert written == {"what": "folded", "files": [str(runs["strip"] / "plot-folded-at-1000-4.png")]}
    assert Image.open(written["files"][0]).width == pytest.approx(120 / MM_PER_INCH * 60, abs=1)


def test_runs_are_compared(runs, tmp_path) -> None:
    others = [str(runs["softer"]), str(runs["interrupted"])]
    path = tmp_path / "a.svg"
    assert main(["plot", str(runs["linear"]), "--compare", *others, "--out", str(path)]) == 0
    assert path.stat().st_size > 10_000


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--what", "heat"], '"folded", "gi", "stress", "thickness", "energy", "mode", "dispersion"'),
        (["--out", "a.bmp"], ".png, .svg, .pdf"),
        (["--dpi", "9"], "50 to 1200"),
        (["--at", "soon"], "--at 'soon' is not a number"),
        (["--at", "1e4"], "holds growth times 0 to 500"),
        (["--what", "stress", "--stress", "shear"], '"von_mises", "mean", "circumferential"'),
        (["--out", "nowhere/a.png"], "cannot be written"),
    ],
)
def test_mistakes_are_explained(runs, options, message, capsys: Capture) -> None:
    assert main(["plot", str(runs["linear"]), *options]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert message in err


def test_a_mistake_is_one_json_document(runs, capsys: Capture) -> None:
    assert main(["plot", str(runs["smooth"]), "--what", "mode", "--json"]) == 2
    assert json.loads(capsys.readouterr().out)["error"] == "ConfigError"


def test_an_animation_is_written_and_told(runs, tmp_path, capsys: Capture) -> None:
    path = tmp_path / "a.gif"
    options = ["--fps", "10", "--seconds", "1", "--width", "240", "--field", "J"]
    assert main(["animate", str(runs["linear"]), "--out", str(path), *options, "--json"]) == 0
    out, err = capsys.readouterr()
    assert json.loads(out) == {"files": [str(path)], "bytes": path.stat().st_size}
    assert err == ""


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_leaves_no_half_of_a_file(runs, tmp_path: Path, number: int) -> None:
    target = tmp_path / "a.gif"
    # a program that is started in the background of a script ignores SIGINT unless told otherwise
    heed = (
        "import os, signal, sys; signal.signal(signal.SIGINT, signal.SIG_DFL); "
        "os.execv(sys.argv[1], sys.argv[1:])"
    )
    command = [sys.executable, "-m", "gyrify.cli", "animate", str(runs["linear"]), "--out", str(target)]
    command = [sys.executable, "-S", "-c", heed, *command, "--width", "2000"]
    for _ in range(6):  # it may be done before the signal comes
        target.unlink(missing_ok=True)
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
            end = time.monotonic() + 60.0
            while not list(tmp_path.iterdir()) and process.poll() is None and time.monotonic() < end:
                time.sleep(0.005)
            process.send_signal(number)
            _, err = process.communicate(timeout=60)
        if process.returncode != 0:
            break
    assert process.returncode == 130, err
    assert "Interrupted" in err
    assert not list(tmp_path.iterdir())
