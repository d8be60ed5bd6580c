"""``gyrify run`` and ``gyrify resume``: fold a slice, and write what came of it."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from gyrify.cli.codes import COMPLETED, FAILED, INTERRUPTED, STOPPED
from gyrify.cli.overrides import ConfigPath, Overrides
from gyrify.cli.streams import complain, print_json, say
from gyrify.errors import SolveError

if TYPE_CHECKING:
    from gyrify.simulation import Observer
    from gyrify.store import History

DEFAULT = Overrides()
_EXIT_CODES = {"completed": COMPLETED, "failed": FAILED, "stopped": STOPPED, "interrupted": INTERRUPTED}


def run(
    config: ConfigPath = None,
    /,
    *,
    overrides: Overrides = DEFAULT,
    out: Path | None = None,
    overwrite: bool = False,
    json: bool = False,
    quiet: bool = False,
) -> int:
    """Fold a slice, from configuration to metrics and a picture.

    Parameters
    ----------
    out : Path, optional
        Run folder; by default runs/ and the first 12 digits of the configuration's hash.
    overwrite : bool
        Replace a run in that folder.
    json : bool
        Print the summary as one JSON document.
    quiet : bool
        Show no progress.
    """
    resolved = overrides.resolve(config)
    folder = out if out is not None else Path("runs") / resolved.config_hash[:12]
    from gyrify.simulation import simulate

    return _carry_out(
        lambda observers: simulate(resolved, folder, observers=observers, overwrite=overwrite),
        folder,
        json,
        quiet,
    )


def resume(
    run_folder: Annotated[Path, Parameter(name="RUN")], /, *, json: bool = False, quiet: bool = False
) -> int:
    """Continue a run that ended early, to the same result as if it had not.

    Parameters
    ----------
    run_folder : Path
        Run folder.
    json : bool
        Print the summary as one JSON document.
    quiet : bool
        Show no progress.
    """
    from gyrify.simulation import resume as continue_run

    return _carry_out(
        lambda observers: continue_run(run_folder, observers=observers), run_folder, json, quiet
    )


def _carry_out(solve: Callable[[list[Observer]], History], folder: Path, json: bool, quiet: bool) -> int:
    """Solve, write all derived files whatever the end was, and say what it came to."""
    from gyrify.cli.progress import progress_observer
    from gyrify.outputs import write_outputs
    from gyrify.store import History

    signal.signal(signal.SIGTERM, signal.default_int_handler)
    note = _compilation_note(quiet)
    try:
        with progress_observer(quiet) as observers:
            solve([_silencer(note), *observers])
    except (SolveError, KeyboardInterrupt) as end:
        if isinstance(end, KeyboardInterrupt) and not (folder / "journal.sqlite").is_file():
            raise
    finally:
        note.cancel()
    history = History.load(folder)
    if history.status == "interrupted":
        complain(f"Interrupted at {history.fractions[-1]:.1%} of growth; every accepted increment is stored.")
        complain(f"Continue with: gyrify resume {folder}")
        return INTERRUPTED
    summary = write_outputs(history, folder)
    if json:
        print_json(summary)
    else:
        _report(summary, folder)
    return _EXIT_CODES[history.status]


def _compilation_note(quiet: bool) -> threading.Timer:
    """Says, if the first increment is slow to come, that kernels are being compiled."""
    text = "Compiling the element kernels for this machine (first run only, up to a minute) ..."
    timer = threading.Timer(2.5, lambda: None if quiet else complain(text))
    timer.daemon = True
    timer.start()
    return timer


def _silencer(note: threading.Timer) -> Observer:
    return lambda _: note.cancel()


def _report(summary: dict[str, Any], folder: Path) -> None:
    from gyrify.summary import warnings

    gi = summary["gi"]
    if summary["status"] != "completed":
        complain(f"The run {summary['status']}: {summary['reason']} {summary['advice']}")
    for warning in warnings(summary):
        complain(f"Warning: {warning}")
    say(
        f"GI {gi['closing']:.3f} (closing of {gi['closing_radius_mm']:g} mm), {gi['hull']:.3f} (hull); "
        f"{summary['n_gyri']} gyri; sulci up to {summary['sulcal_depth_mm']['max']:.2f} mm deep."
    )
    solver = summary["solver"]
    say(
        f"{solver['increments']} increments, {solver['newton_iterations']} iterations, "
        f"{solver['wall_s']:.1f} s with {solver['linear_solver']}."
    )
    say(f"Results in {folder}: folded.png, summary.json, metrics.csv, history.vtkhdf.")
