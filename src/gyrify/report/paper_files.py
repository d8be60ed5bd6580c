"""Files of one reproduction of the paper: scoreboard, cases and figures."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from gyrify.paper.reproduce import Reproduction
from gyrify.report.paper_figures import write_figures
from gyrify.report.paper_page import scoreboard_page
from gyrify.report.paper_tables import cases_csv, scoreboard_csv, scoreboard_markdown, write_text
from gyrify.study import StoredPoint


def write_report(
    reproduction: Reproduction, stored: Callable[[str], StoredPoint], folder: Path, *, figures: bool = True
) -> list[Path]:
    """Write ``scoreboard.csv``, ``.md`` and ``.html``, ``cases.csv``, and ``figures/``.

    Parameters
    ----------
    reproduction : Reproduction
        What to report.
    stored : callable
        Gives the stored run of a key.
    folder : Path
        Where to.
    figures : bool
        Whether to draw the figures too.

    Returns
    -------
    list of Path
        The files.
    """
    board = reproduction.scoreboard
    texts = {
        "scoreboard.csv": scoreboard_csv(board),
        "scoreboard.md": scoreboard_markdown(board),
        "scoreboard.html": scoreboard_page(board),
        "cases.csv": cases_csv(reproduction.rows),
    }
    for name, text in texts.items():
        write_text(folder / name, text)
    files = [folder / name for name in texts]
    if figures:
        files += write_figures(reproduction.rows, stored, folder / "figures")
    return files
