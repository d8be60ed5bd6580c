"""``gyrify verify`` and ``gyrify export``: what can be done with a stored run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from gyrify.cli.codes import COMPLETED, FAILED
from gyrify.cli.overrides import Text
from gyrify.cli.streams import print_json, say, warn
from gyrify.errors import ConfigError

if TYPE_CHECKING:
    from gyrify.store import History

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
    format: Literal["vtu", "xdmf", "csv", "stl", "ply", "contour", "metrics"] = "vtu",
    out: Path | None = None,
    state: int = -1,
    every: bool = False,
    thickness: float = 2.0,
    closing_radius: Text = None,
    gyrus_prominence: Text = None,
    json: bool = False,
    quiet: bool = False,  # noqa: ARG001 - for uniformity
) -> None:
    """Write states of a run for another program, or measure them again.

    Parameters
    ----------
    format : {"vtu", "xdmf", "csv", "stl", "ply", "contour", "metrics"}
        Format of the files; ply is the surface with the fields of its points, contour a CSV table of the
        outer contour of a slice, metrics one of the metrics, a row per state.
    out : Path, optional
        File to write; by default export and the format's suffix (contour.csv, export-metrics.csv), in the
        run folder.
    state : int
        State to write; negative numbers count from the end.
    every : bool
        Write every state that ``output.every`` asks for, as a time series.
    thickness : float
        Thickness of the solid that STL and PLY make of a slice [mm].
    closing_radius : str, optional
        Radius of the closing to measure with [mm], with --format metrics; by default that of the run.
    gyrus_prominence : str, optional
        Smallest prominence of a gyrus [mm], with --format metrics; by default that of the run.
    json : bool
        Print the names of the files as one JSON document.
    quiet : bool
        Show no progress.
    """
    from gyrify.store import History
    from gyrify.store.export import NAMES
    from gyrify.store.export import export as write

    lengths = _lengths(format, closing_radius=closing_radius, gyrus_prominence=gyrus_prominence)
    history, index = History.load(run_folder), None if every else state
    if format == "metrics":
        target = out if out is not None else run_folder / "export-metrics.csv"
        files = [str(_measured_again(history, target, index, lengths))]
    else:
        target = out if out is not None else run_folder / NAMES[format]
        files = [str(path) for path in write(history, format, target, index, thickness=thickness)]
    if json:
        print_json({"files": files})
    else:
        say("\n".join(files))


def _lengths(format: str, **texts: str | None) -> dict[str, float]:
    """Lengths to measure with [mm], where they are given."""
    from gyrify.config.numbers import parse_number

    lengths = {}
    for name, text in texts.items():
        if text is None:
            continue
        option = f"--{name.replace('_', '-')}"
        if format != "metrics":
            raise ConfigError(f"{option} goes with --format metrics alone.", f"Leave out {option}.")
        try:
            lengths[name] = parse_number(text)
        except ValueError as fault:
            raise ConfigError(f"{option} {text[:60]!r} is not a number: {fault}.", "Try 10.") from fault
    return lengths


def _measured_again(history: History, path: Path, index: int | None, lengths: dict[str, float]) -> Path:
    """Write the table of metrics of one state, or of every one; the folder keeps its own numbers."""
    from gyrify.run.measuring import measured_with, write_metrics
    from gyrify.run.validity.lengths import check_lengths
    from gyrify.store.disk_faults import storage_faults
    from gyrify.store.export import stored_states

    if lengths:
        radius, prominence = lengths.get("closing_radius"), lengths.get("gyrus_prominence")
        warn(check_lengths(measured_with(history.config, radius, prominence)))
    states = stored_states(history, index)
    with storage_faults(path.parent, str(path)):
        path.parent.mkdir(parents=True, exist_ok=True)
        write_metrics(history, path, states, **lengths)
    return path
