"""``gyrify run`` and ``gyrify resume``: fold a slice, and write what came of it."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager, suppress
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from gyrify.cli.codes import COMPLETED, FAILED, INTERRUPTED, STOPPED
from gyrify.cli.interrupts import Interrupts
from gyrify.cli.overrides import ConfigPath, Overrides, once, read_value, split_assignment
from gyrify.cli.streams import complain, print_json, say, warn
from gyrify.errors import HistoryError, SolveError

if TYPE_CHECKING:
    from gyrify.config import Config
    from gyrify.run.repeat import KnownRun
    from gyrify.run.running import Observer, Run

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

    A folder that holds this very run is used again: nothing is computed if it completed, and it is continued
    if it did not.

    Parameters
    ----------
    out : Path, optional
        Run folder; by default runs/ and the first 12 digits of the configuration's hash.
    overwrite : bool
        Replace a run in that folder, whatever it is.
    json : bool
        Print the summary as one JSON document.
    quiet : bool
        Show no progress.
    """
    with Interrupts(json) as interrupts:
        resolved = overrides.resolve(config)
        folder = out if out is not None else Path("runs") / resolved.config_hash[:12]
        from gyrify.run.repeat import known_run
        from gyrify.run.simulation import new_run, stored_run

        known = None if overwrite else known_run(resolved, folder)
        if known is None:
            return _carry_out(new_run(resolved, folder, overwrite=overwrite), folder, interrupts, json, quiet)
        if known.is_done:
            return _tell_done(known, resolved, json, quiet)
        again = stored_run(folder, known.changes)
        return _carry_out(again, folder, interrupts, json, quiet, known.note)


def resume(
    run_folder: Annotated[Path, Parameter(name="RUN")],
    /,
    *,
    set_: Annotated[tuple[str, ...], Parameter(name="--set", negative="", allow_leading_hyphen=True)] = (),
    json: bool = False,
    quiet: bool = False,
) -> int:
    """Continue a run that ended early, to the same result as if it had not.

    Parameters
    ----------
    run_folder : Path
        Run folder.
    set_ : sequence of str, optional
        New value in limits or output, as section.field=value; may be repeated.
    json : bool
        Print the summary as one JSON document.
    quiet : bool
        Show no progress.
    """
    with Interrupts(json) as interrupts:
        overrides = {key: read_value(text) for key, text in once(map(split_assignment, set_)).items()}
        from gyrify.run.simulation import stored_run

        return _carry_out(stored_run(run_folder, overrides), run_folder, interrupts, json, quiet)


def _carry_out(
    begin: AbstractContextManager[Run],
    folder: Path,
    interrupts: Interrupts,
    json: bool,
    quiet: bool,
    note: str = "",
) -> int:
    """Grow, write all derived files whatever the end was, and say what it came to."""
    from gyrify.report.outputs import write_outputs, write_state
    from gyrify.run.validity import config_warnings

    with _closed(begin) as run:
        interrupts.guard(folder)
        for sentence in filter(None, (note, run.note)):
            if not quiet:
                complain(sentence)
        told = config_warnings(run.problem.config)
        warn(told)
        try:
            _grow(run, interrupts, quiet)
            history = run.history
            is_brief = history.status == "interrupted"
            summary = write_state(history, folder) if is_brief else write_outputs(history, folder)
        except HistoryError as fault:
            complain(str(fault))
            if json:
                print_json({"error": "HistoryError", "message": fault.message, "advice": fault.advice})
            return FAILED
    _tell_end(summary, history.fractions[-1], folder, told)
    if interrupts.requested and summary["status"] != "interrupted":
        complain("Interrupted, but growth had ended: everything is written.")
    if json:
        print_json(summary)
    elif summary["status"] != "interrupted":
        _report(summary, folder)
    return INTERRUPTED if interrupts.requested else _EXIT_CODES[summary["status"]]


@contextmanager
def _closed(begin: AbstractContextManager[Run]) -> Iterator[Run]:
    """The run; its journal is closed at the end, so that the folder has no files of a database in use."""
    with ExitStack() as last, begin as run:
        last.callback(run.history.journal.close)
        yield run


def _tell_done(known: KnownRun, config: Config, json: bool, quiet: bool) -> int:
    """Say what a run that completed before came to; its warnings are told again."""
    from gyrify.run.validity import config_warnings

    if not quiet:
        complain(known.note)
    summary = known.summary or {}
    warn(dict.fromkeys([*config_warnings(config), *summary.get("warnings", [])]))
    print_json(summary) if json else _report(summary, known.folder)
    return COMPLETED


def _grow(run: Run, interrupts: Interrupts, quiet: bool) -> None:
    """Grow to whatever end; the run keeps a record of it."""
    from gyrify.run.progress import progress_observer

    note, shown = _compilation_note(quiet), progress_observer(not quiet, complain)
    with suppress(SolveError, MemoryError, KeyboardInterrupt), shown as observers:
        try:
            run.grow([_silencer(note), *observers], interrupts.watch)
        finally:
            note.cancel()


def _compilation_note(quiet: bool) -> threading.Timer:
    """Says, if the first increment is slow to come, what it is waiting for."""
    text = "Preparing the element kernels; the first run on a machine compiles them (up to a minute) ..."
    timer = threading.Timer(2.5, lambda: None if quiet else complain(text))
    timer.daemon = True
    timer.start()
    return timer


def _silencer(note: threading.Timer) -> Observer:
    return lambda _: note.cancel()


def _tell_end(summary: dict[str, Any], fraction: float, folder: Path, told: Sequence[str]) -> None:
    """Say on stderr how it ended, and what a reader of the result must not overlook and was not told yet."""
    if summary["status"] == "interrupted":
        complain(f"Interrupted at {fraction:.1%} of growth; every accepted increment is stored.")
        complain(f"Continue with: gyrify resume {quote(str(folder))}")
    elif summary["status"] != "completed":
        complain(f"The run {summary['status']}: {summary['reason']} {summary['advice']}")
    warn(warning for warning in summary["warnings"] if warning not in told)


def _check_command(summary: dict[str, Any], folder: Path) -> str:
    """How to check the mesh, from where the user is."""
    command: str = summary["converged"]["command"]
    return command.replace("config.toml", quote(str(folder / "config.toml")), 1)


def _solved_with(summary: dict[str, Any]) -> str:
    """What solved the linear systems, and why where that is not the usual."""
    name: str = summary["solver"]["linear_solver"]
    if name != "cg":
        return name
    is_asked_for = "solver.linear_solver" in summary["parameters"]
    return "conjugate gradients" + ("" if is_asked_for else ", since a factor would take longer or not fit")


def _report(summary: dict[str, Any], folder: Path) -> None:
    from gyrify.config.words import decimals

    gi, deepest = summary["gi"], summary["sulcal_depth_mm"]["max"]
    n_gyri = summary["n_gyri"]
    sulci = f"sulci up to {deepest:.{decimals([deepest], 2)}f} mm deep" if n_gyri else "no sulci"
    kind, indices = ("GI by area", gi["area"]) if "area" in gi else ("GI", gi)
    say(
        f"{kind} {indices['closing']:.3f} (closing of {gi['closing_radius_mm']:.4g} mm), "
        f"{indices['hull']:.3f} (hull); {n_gyri} {'gyrus' if n_gyri == 1 else 'gyri'}; {sulci}."
    )
    say(f"{summary['converged']['sentence']} Check: {_check_command(summary, folder)}")
    solver = summary["solver"]
    say(
        f"{solver['increments']} increments, {solver['newton_iterations']} iterations, "
        f"{solver['wall_s']:.1f} s with {_solved_with(summary)}."
    )
    say(f"Results in {folder}: folded.png, summary.json, metrics.csv, history.vtkhdf.")
