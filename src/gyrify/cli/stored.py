"""``gyrify verify`` and ``gyrify export``: what can be done with a stored run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from gyrify.cli.codes import COMPLETED, FAILED
from gyrify.cli.streams import print_json, say

RunFolder = Annotated[Path, Parameter(name="RUN", help="Run folder.")]


def verify(
    run_folder: RunFolder,
    /,
    *,
    json: bool = False,
    quiet: bool = False,  # noqa: ARG001 - for uniformity
) -> int:
    """Recheck a stored run from its files alone; exit code 1 if a check fails.

    Parameters
    ----------
    json : bool
        Print one JSON document.
    quiet : bool
        Show no progress.
    """
    from gyrify.verify import verify as recheck

    verification = recheck(run_folder)
    if json:
        print_json(verification.as_dict())
    else:
        say(str(verification))
    return COMPLETED if verification.passed else FAILED


def export(
    run_folder: RunFolder,
    /,
    *,
    format: Literal["vtu", "xdmf", "csv", "stl"] = "vtu",
    out: Path | None = None,
    state: int = -1,
    every: bool = False,
    json: bool = False,
    quiet: bool = False,  # noqa: ARG001 - for uniformity
) -> None:
    """Write states of a run for another program.

    Parameters
    ----------
    format : {"vtu", "xdmf", "csv", "stl"}
        Format of the files.
    out : Path, optional
        File to write; by default ``export`` and the format's suffix, in the run folder.
    state : int
        State to write; negative numbers count from the end.
    every : bool
        Write every state that ``output.every`` asks for, as a time series.
    json : bool
        Print the names of the files as one JSON document.
    quiet : bool
        Show no progress.
    """
    from gyrify.store import History
    from gyrify.store.export import export as write

    history = History.load(run_folder)
    target = out if out is not None else run_folder / f"export.{format}"
    files = [str(path) for path in write(history, format, target, None if every else state)]
    if json:
        print_json({"files": files})
    else:
        say("\n".join(files))
