"""Runs the blocks of a page in order, in one folder: commands, Python in one namespace, files, samples."""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import install_lines
from blocks import DIRECTIVES, ROOT, Block
from options import unknown_options
from printed import missing_lines, unknown_columns, unknown_keys

from gyrify import Config, Study, __version__

_TIME_LIMIT = 1800.0
_NAME = re.compile(r"# (\S+\.toml)$", re.MULTILINE)


class Runner:
    """One page at work.

    Parameters
    ----------
    folder : Path
        Empty folder; the commands run in it.

    Attributes
    ----------
    n_checked : int
        Blocks that were run or compared.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.n_checked = 0
        self._names: dict[str, Any] = {"__name__": "page"}
        self._printed, self._stdout = "", ""

    def run(self, block: Block) -> None:
        """Run or compare a block; an assertion says what is wrong with it."""
        if block.is_as_shown:
            assert block.language != "sh" or not unknown_options(block.text), unknown_options(block.text)
        elif block.language not in DIRECTIVES:
            getattr(self, f"_{block.language}")(block)
        self.n_checked += 1

    def _sh(self, block: Block) -> None:
        faults, script = install_lines.split(block.text)
        assert not faults, f"{block.place}: {faults}"
        done = subprocess.run(
            ["bash", "-euo", "pipefail", "-c", script],
            cwd=self.folder,
            env=_environment(),
            capture_output=True,
            text=True,
            timeout=_TIME_LIMIT,
        )
        self._printed, self._stdout = done.stderr + done.stdout, done.stdout  # progress comes first
        expected = int(block.value("exits") or 0)
        assert done.returncode == expected, f"{block.place} exits {done.returncode}: {done.stderr[-2000:]}"

    def _python(self, block: Block) -> None:
        stdout = io.StringIO()
        code = compile("\n" * block.line + block.text, str(block.page), "exec")
        with contextlib.chdir(self.folder), contextlib.redirect_stdout(stdout):
            exec(code, self._names)
        self._printed = self._stdout = stdout.getvalue()

    def _toml(self, block: Block) -> None:
        """Load as a configuration or a study; a name in the first comment makes it a file."""
        named = _NAME.match(block.text)
        file = self.folder / (named[1] if named else "unnamed.toml")
        file.write_text(block.text, encoding="utf-8")
        if "design" in tomllib.loads(block.text):
            Study.from_toml(file)
        else:
            Config.load(file)

    def _text(self, block: Block) -> None:
        missing = missing_lines(block.text, self._printed)
        assert not missing, f"{block.place}: not printed: {missing}; printed was:\n{self._printed[-3000:]}"

    def _sampled(self, block: Block) -> str:
        name = block.value("file")
        return (self.folder / name).read_text(encoding="utf-8") if name else self._stdout

    def _json(self, block: Block) -> None:
        faults = unknown_keys(json.loads(block.text), json.loads(self._sampled(block)))
        assert not faults, f"{block.place}: {faults}"

    def _csv(self, block: Block) -> None:
        faults = unknown_columns(block.text, self._sampled(block))
        assert not faults, f"{block.place}: {faults}"

    def _bibtex(self, block: Block) -> None:
        """The citation names the version and the title that CITATION.cff has."""
        citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
        title = re.search(r'^title: "(.*)"$', citation, re.MULTILINE)
        assert title is not None
        assert title[1] in block.text
        assert f"{{{__version__}}}" in block.text


def _environment() -> dict[str, str]:
    """The environment of the tests, with its programs first and nothing that looks at a screen."""
    programs = str(Path(sys.executable).parent)
    quiet = {"OMP_NUM_THREADS": "1", "MPLBACKEND": "agg", "PYVISTA_OFF_SCREEN": "true", "COLUMNS": "120"}
    return {**os.environ, **quiet, "PATH": os.pathsep.join([programs, os.environ["PATH"]])}
