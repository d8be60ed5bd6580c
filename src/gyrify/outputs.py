"""The derived files of a run folder, rebuilt from its journal at any time."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

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


def folded_picture(history: History, summary: dict[str, Any]) -> Figure:
    """Picture of the last state, titled with what it shows and, if it ended early, where and how."""
    mesh, config = history.mesh, history.config
    title = (
        f"E ratio {config.material.stiffness_ratio:.3g}, growth ratio {config.growth.ratio:.3g}, "
        f"T = {config.geometry.cortical_thickness:g} mm"
    )
    if history.status != "completed":
        title += f" ({history.status} at {history.fractions[-1]:.0%} of growth)"
    return folded_figure(
        history.points(),
        mesh.cells,
        mesh.region,
        mesh.contour,
        mesh.interface,
        closing_radius=config.metrics.closing_radius,
        gi=summary["gi"]["closing"],
        n_gyri=summary["n_gyri"],
        title=title,
    )
