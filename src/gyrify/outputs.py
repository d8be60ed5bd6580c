"""The derived files of a run folder, rebuilt from its journal at any time."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from gyrify.report.figures import folded_figure, save_figure
from gyrify.store.history import History
from gyrify.summary import summarise, write_metrics, write_summary


def write_outputs(history: History, folder: Path) -> dict[str, Any]:
    """Write ``metrics.csv``, ``folded.png`` and ``summary.json``.

    Parameters
    ----------
    history : History
        The run, complete or not.
    folder : Path
        Run folder.

    Returns
    -------
    dict
        The summary.
    """
    summary = summarise(history)
    write_metrics(history, folder / "metrics.csv")
    save_figure(folded_picture(history, summary), folder / "folded.png")
    write_summary(summary, folder / "summary.json")
    return summary
