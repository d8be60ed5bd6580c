"""``gyrify converge``: what a result owes to mesh, increments and contact distance."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from gyrify.cli.codes import COMPLETED, FAILED, INTERRUPTED, STOPPED
from gyrify.cli.options import cores, number
from gyrify.cli.overrides import ConfigPath, Overrides, Text
from gyrify.cli.streams import complain, print_json, warn
from gyrify.errors import ConfigError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from gyrify.convergence import Convergence, Family, Level, Subject

DEFAULT = Overrides()
_EXIT_CODES = {"completed": COMPLETED, "failed": FAILED, "stopped": STOPPED, "interrupted": INTERRUPTED}
_PLAIN_WIDTH = 120


def converge(
    config: ConfigPath = None,
    /,
    *,
    overrides: Overrides = DEFAULT,
    levels: int = 3,
    of: str | None = None,
    tolerance: Text = None,
    workers: int | None = None,
    out: Path | None = None,
    json: bool = False,
    quiet: bool = False,
) -> int:
    """Refine mesh, increments and contact distance in turn, and judge what the metrics converge to.

    Every level is a run of its own; run the same command again to take up where it ended.

    Parameters
    ----------
    levels : int
        Runs per family, each twice as fine as the one before, from the given configuration on.
    of : str, optional
        What is refined, separated by commas: mesh, increments, contact; all by default.
    tolerance : str, optional
        Largest relative error that counts as converged; 0.02 by default.
    workers : int, optional
        Processes, of one thread each; by default the number of cores.
    out : Path, optional
        Folder for runs and results; by default convergence/ and the first 12 digits of the hash.
    json : bool
        Print the result as one JSON document.
    quiet : bool
        Show no progress.
    """
    resolved = overrides.resolve(config)
    subjects = None if of is None else _subjects(of)
    largest = 0.02 if tolerance is None else number("--tolerance", tolerance, "0.02")
    from gyrify.convergence import converge as study
    from gyrify.convergence.converge import default_folder

    folder = default_folder(resolved) if out is None else out
    processes = cores(workers)

    def tell(level: Level, done: int, total: int) -> None:
        if not quiet:
            complain(f"{done} of {total}: {_described(level)}")

    try:
        found = study(
            resolved, folder, levels=levels, of=subjects, workers=processes, tolerance=largest, tell=tell
        )
    except KeyboardInterrupt:
        return _tell_interrupted(json)
    from gyrify.report.convergence_figures import write_pictures

    write_pictures(found, folder)
    warn(found.warnings)
    print_json(found.as_dict()) if json else _report(found, folder)
    return _EXIT_CODES[found.status]


def _tell_interrupted(json: bool) -> int:
    said, advice = "Every accepted increment is stored.", "Run the same command again to continue."
    complain(f"Interrupted. {said} {advice}")
    if json:
        print_json({"error": "Interrupted", "message": said, "advice": advice})
    return INTERRUPTED


def _subjects(text: str) -> Sequence[Subject]:
    from gyrify.convergence import SUBJECTS

    known = {str(subject): subject for subject in SUBJECTS}
    words = [word.strip() for word in text.split(",") if word.strip()]
    for word in words:
        if word not in known:
            raise ConfigError(
                f"--of {word[:60]} cannot be refined.",
                f"Choose among {', '.join(SUBJECTS)}.",
            )
    return [known[word] for word in words]


def _described(level: Level) -> str:
    config = level.config
    factor = 2**config.mesh.refine
    n_dim = config.geometry.n_dim
    mesh = f"{config.mesh.n_around * factor} × {config.mesh.n_layers * factor}"
    what = (
        f"{mesh if n_dim == 2 else level.name('mesh')} {config.mesh.element}, "
        f"{config.solver.increments} increments, contact at {config.contact.activation_fraction:.4g} T"
    )
    if not level.is_complete:
        return f"{what}: {level.status}. {level.reason}"
    gi, gyri = level.metrics["gi_closing" if n_dim == 2 else "gi_area_closing"], level.metrics["n_gyri"]
    index = "GI" if n_dim == 2 else "GI by area"
    return f"{what}: {index} {gi:.3f}, {gyri:.0f} gyri, {level.wall_s:.1f} s"


def _report(found: Convergence, folder: Path) -> None:
    import sys

    from rich.console import Console

    console = Console(width=None if sys.stdout.isatty() else _PLAIN_WIDTH, highlight=False)
    for family in found.families:
        _print_family(console, family)
    console.print(f"Results in {folder}: convergence.json, convergence.csv, pictures, runs.", soft_wrap=True)


def _print_family(console: object, family: Family) -> None:
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    from gyrify.config.words import decimals

    assert isinstance(console, Console)
    table = Table(title=f"Refined: {family.subject}", title_justify="left")
    table.add_column("metric")
    for level in family.levels:
        name = level.name(family.subject)
        table.add_column(name if level.is_complete else f"{name} ({level.status})", justify="right")
    table.add_column("order", justify="right")
    table.add_column("limit", justify="right")
    table.add_column("verdict")
    styles = {True: "green", False: "yellow", None: "dim"}
    for metric in family.metrics:
        verdict = family.verdicts[metric.key]
        digits = metric.digits if metric.is_count else decimals(verdict.values, metric.digits)
        values = ["-" if value is None else f"{value:.{digits}f}" for value in verdict.values]
        order = "-" if verdict.order is None else f"{verdict.order:.1f}"
        limit = "-" if verdict.limit is None else f"{verdict.limit:.{digits}f}"
        name = f"{metric.name} [{metric.unit}]" if metric.unit else metric.name
        table.add_row(
            escape(name), *values, order, limit, f"[{styles[verdict.converged]}]{verdict.sentence}[/]"
        )
    console.print(table)
    for note in family.notes:
        console.print(f"Note: {escape(note)}", soft_wrap=True)
