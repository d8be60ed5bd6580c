"""``gyrify study``: many runs from one file."""

from __future__ import annotations

from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from gyrify.cli.codes import COMPLETED, FAILED, INTERRUPTED, STOPPED
from gyrify.cli.options import cores
from gyrify.cli.overrides import STANDARD_INPUT
from gyrify.cli.streams import complain, print_json, say, warn
from gyrify.errors import ConfigError, GyrifyError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from gyrify.study import Study, StudyResult

_EXIT_CODES = {"completed": COMPLETED, "failed": FAILED, "stopped": STOPPED}
_SHOWN = 10


def study(
    file: Annotated[Path, Parameter(name="FILE", help="Study in TOML, - for standard input.")],
    /,
    *,
    out: Path | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    retry_failed: bool = False,
    json: bool = False,
    quiet: bool = False,
) -> int:
    """Run every point of a study, and gather the results in one table.

    Points that the folder holds are not run again: the same command continues after Ctrl-C, or a crash.

    Parameters
    ----------
    out : Path, optional
        Study folder; by default studies/ and the file's name.
    workers : int, optional
        Processes, of one thread each; by default the number of cores.
    scheduler : str, optional
        Address of a dask scheduler that computes instead, such as tcp://node1:8786.
    retry_failed : bool
        Run points again that failed or were stopped by a limit.
    json : bool
        Print what the study came to as one JSON document.
    quiet : bool
        Show no progress.
    """
    from gyrify.cli.study_progress import progress_of_points
    from gyrify.study.driver import run_study

    described = _described(file, out)
    folder = Path("studies") / file.stem if out is None else out
    processes = cores(workers)
    try:
        with progress_of_points(quiet) as observer:
            result = run_study(
                described,
                folder,
                workers=processes,
                scheduler=scheduler,
                retry_failed=retry_failed,
                observer=observer,
            )
        pictures = _draw(folder)
    except KeyboardInterrupt:
        said, advice = "Every finished run is stored.", "Run the same command again to continue."
        complain(f"Interrupted. {said} {advice}")
        if json:
            print_json({"error": "Interrupted", "message": said, "advice": advice})
        return INTERRUPTED
    warn(_warnings(result))
    if json:
        print_json({**result.as_dict(), "pictures": [str(path) for path in pictures or ()]})
    else:
        _report(result, folder, pictures or ())
    return FAILED if pictures is None else _EXIT_CODES[result.status]


def _described(file: Path, out: Path | None) -> Study:
    """The study of a file, or of standard input, which has no name that a folder could take."""
    from gyrify.config import toml_text
    from gyrify.study.definition import Study

    if file != STANDARD_INPUT:
        return Study.from_toml(file)
    if out is None:
        raise ConfigError("A study from standard input has no name for its folder.", "Add --out DIR.")
    return Study.from_mapping(toml_text.parse(toml_text.read_standard_input(), "Standard input"))


def _warnings(result: StudyResult) -> list[str]:
    """How many runs have warnings, and those that most of them have."""
    found = result.warnings
    keys = {key for keys in found.values() for key in keys}
    if not keys:
        return []
    often = sorted(found, key=lambda said: -len(found[said]))[:_SHOWN]
    total = len(result.points)
    told = f"{len(keys)} of {total} runs have warnings: the column warnings of the results has all."
    return [told, *(f"{len(found[said])} of {total} runs: {said}" for said in often)]


def _draw(folder: Path) -> Sequence[Path] | None:
    """Draw the pictures; None where that failed, which must not take the results with it."""
    from gyrify.report.study_pictures import write_study_pictures

    try:
        return write_study_pictures(folder)
    except GyrifyError as fault:
        complain(f"The results are stored, but not their pictures. {fault}")
        return None


def _report(result: StudyResult, folder: Path, pictures: Sequence[Path]) -> None:
    failures = result.failures
    for key, reason in list(failures.items())[:_SHOWN]:
        complain(f"{key} {result.records[key].status}: {reason}")
    if len(failures) > _SHOWN:
        complain(f"… and {len(failures) - _SHOWN} more.")
    known = len(result.points) - result.computed
    say(
        f"{len(result.points) - len(failures)} of {len(result.points)} runs completed in "
        f"{result.wall_s:.0f} s" + (f", {known} of them before." if known else ".")
    )
    names = ", ".join(["results.parquet", *(path.name for path in pictures)])
    say(f"Results in {folder}: {names}.")
    say(f"Look at them with: gyrify table {quote(str(folder))}")
    if failures:
        say("Run the same command with --retry-failed to run again what did not complete.")
