"""The command line in this process: arguments one a line, in a folder with runs, studies and traps.

What computes or draws is left out (it has tests of its own): each command goes as far as the folder it
writes to, which is held, made and written as ever.
"""

from __future__ import annotations

import contextlib
import io
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest import mock

from guard import name_paths
from stored import journal_bytes, tiny_config
from target import Target

from gyrify.cli import main
from gyrify.errors import GyrifyError
from gyrify.solve.problem import State

_CODES = (0, 1, 2, 3)
# Names that commands write, as links to a file that is none of their business.
TRAPS = (
    "report.html.partial",
    "config.toml.partial",
    "config.toml",
    "summary.json.partial",
    "metrics.csv.partial",
    "run.owner.json",
    "run.lock",
    "export.csv",
    "plot-gi.png.partial",
    "study.toml.partial",
    "results.parquet.partial",
)
_LEFT_OUT = (
    "gyrify.model.meshing.build_mesh",
    "gyrify.threshold.critical_growth",
    "gyrify.convergence.converge",
    "gyrify.paper.simulations.Simulations",
    "gyrify.study.known_points.KnownPoints.complete",
    "gyrify.report.plot.plot",
    "gyrify.report.animate.animate",
    "gyrify.verify.verify",
    "gyrify.store.export._write_vtu",
    "gyrify.store.export.write_xdmf",
    "gyrify.run.running.Run.grow",
)


def _leave_out(*_: Any, **__: Any) -> Any:
    raise GyrifyError("It would be computed now.")


class _Slice:
    """What a run asks of its problem before it grows."""

    state_shape = (4, 2)
    mesh = SimpleNamespace(n_dim=2)

    def __init__(self, config: object) -> None:
        self.config = config

    def reference_state(self) -> State:
        return State.reference(*self.state_shape)


@contextlib.contextmanager
def without_computing() -> Iterator[None]:
    """Leave out what would take seconds, for as long as commands are tried."""
    with contextlib.ExitStack() as stack:
        for name in _LEFT_OUT:
            stack.enter_context(mock.patch(name, _leave_out))
        stack.enter_context(mock.patch("gyrify.run.simulation.Slice", _Slice))
        stack.enter_context(mock.patch("gyrify.report.html.run_page", return_value="page"))
        stack.enter_context(mock.patch("os.cpu_count", return_value=2))
        yield


def scene(folder: Path) -> tuple[Path, Path]:
    """A working folder with files, runs and links that lead out of it, and a folder nobody may write to."""
    inside, outside = folder / "inside", folder / "outside"
    for path in (inside / "run", inside / "study", outside):
        path.mkdir(parents=True, exist_ok=True)
    (outside / "precious.txt").write_text("precious")
    (inside / "config.toml").write_text(tiny_config().to_toml(), encoding="utf-8")
    (inside / "study.toml").write_text(
        '[design]\nkind = "grid"\n[[design.parameter]]\nkey = "growth.ratio"\nvalues = [1.0, 2.0]\n'
    )
    (inside / "run" / "journal.sqlite").write_bytes(journal_bytes())
    _results(inside / "study")
    for name in TRAPS:
        (inside / "run" / name).symlink_to(outside / "precious.txt")
        (inside / "study" / name).symlink_to(outside / "precious.txt")
    (inside / "link").symlink_to(outside)
    return inside, outside


def _results(folder: Path) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    columns = {name: ["a1b2c3d4e5f6"] for name in ("key", "status", "reason", "advice")}
    table = pa.table({**columns, "growth.ratio": [2.0], "gi_closing": [1.5], "n_gyri": [7], "seed": [0]})
    pq.write_table(table, folder / "results.parquet")


def _command(folder: Path) -> Callable[[bytes], object]:
    inside, outside = scene(folder / "scene")
    pristine = folder / "pristine"
    shutil.copytree(inside, pristine, symlinks=True)
    kept = {path.name for path in inside.iterdir()}
    count = 0

    def read(data: bytes) -> None:
        nonlocal count
        count += 1
        if count % 200 == 0 or not inside.is_dir() or {path.name for path in inside.iterdir()} != kept:
            shutil.rmtree(inside, ignore_errors=True)
            shutil.copytree(pristine, inside, symlinks=True)
        arguments = data.decode("utf-8", "replace").replace("\0", "").split("\n")
        heard = io.StringIO()
        here = os.getcwd()
        os.chdir(inside)
        name_paths(*(argument.rpartition("=")[2] for argument in arguments))
        try:
            with (
                contextlib.redirect_stdout(io.StringIO()) as printed,
                contextlib.redirect_stderr(heard),
            ):
                code = main(arguments)
        except SystemExit as end:
            raise AssertionError(f"SystemExit {end.code}") from end
        finally:
            os.chdir(here)
        _judge(code, heard.getvalue(), printed.getvalue(), arguments, outside)

    return read


def _judge(code: int, heard: str, printed: str, arguments: list[str], outside: Path) -> None:
    import json

    assert code in _CODES, code
    assert "Traceback" not in heard, heard
    assert heard.isascii() or all(c.isprintable() or c == "\n" for c in heard), repr(heard[:200])
    assert not any(ord(c) < 32 and c not in "\n\t\r" for c in heard), repr(heard[:200])
    if code == 2:
        assert heard.startswith("gyrify: "), heard[:200]
    if "--json" in arguments and printed:
        json.loads(printed)
    assert (outside / "precious.txt").read_text() == "precious", "written through a link"


TARGETS = (
    Target(
        "command",
        "command line, arguments",
        _command,
        without_computing,
        (
            b"run\n",
            b"resume\nrun\n",
            b"--out\n",
            b"../outside",
            b"link/x",
            b"run/link",
            b"--json\n",
            b"table\nstudy\n--where\n",
        ),
    ),
)
