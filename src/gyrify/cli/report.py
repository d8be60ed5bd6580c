"""``gyrify report``: a run or a study as one HTML file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from gyrify.cli.streams import print_json, say
from gyrify.errors import ConfigError, HistoryError


def report(
    folder: Annotated[Path, Parameter(name="RUN_OR_STUDY", help="Run folder or study folder.")],
    /,
    *,
    out: Path | None = None,
    json: bool = False,
    quiet: bool = False,  # noqa: ARG001 - for uniformity
) -> None:
    """Write a run or a study as one HTML file, to look at in any browser, without a network.

    Parameters
    ----------
    out : Path, optional
        File to write; by default report.html in the folder.
    json : bool
        Print the name and the size of the file as one JSON document.
    quiet : bool
        Show no progress.
    """
    target = folder / "report.html" if out is None else out
    if target.is_dir():
        raise ConfigError(f"--out {target} is a folder.", "Give the name of a file, such as report.html.")
    from gyrify.report.html import write_page

    text = _page(folder)
    write_page(text, target)
    size = target.stat().st_size
    if json:
        print_json({"file": str(target), "bytes": size})
    else:
        say(f"{target} ({size / 1e6:.1f} MB): open it in a browser.")


def _page(folder: Path) -> str:
    """Page of whatever is in the folder."""
    if (folder / "journal.sqlite").is_file():
        from gyrify.report.html import run_page
        from gyrify.store import History

        return run_page(History.load(folder), _name(folder))
    if (folder / "results.parquet").is_file():
        from gyrify.report.html.page_of_study import study_page

        return study_page(folder, _name(folder))
    raise HistoryError(
        f"There is neither a run nor a study in {folder}.",
        "Name a folder that `gyrify run` or `gyrify study` has written.",
    )


def _name(folder: Path) -> str:
    return folder.name or folder.resolve().name
