"""The derived files of a run folder, rebuilt from its journal at any time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gyrify.base.arguments import Pathlike, as_path
from gyrify.errors import HistoryError
from gyrify.report.figures import folded_figure, save_figure
from gyrify.report.mode_figure import mode_figure, wave_words
from gyrify.run.body_measures import surface_of
from gyrify.run.summary import summarise, write_metrics, write_summary
from gyrify.run.validity.converged import mark
from gyrify.solve.stability import Onset
from gyrify.store.disk_faults import storage_faults
from gyrify.store.history import History
from gyrify.store.vtkhdf import write_vtkhdf

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def write_outputs(history: History, folder: Pathlike) -> dict[str, Any]:
    """Write every derived file, each by atomic rename: summary, metrics, pictures, time series.

    Parameters
    ----------
    history : History
        The run, complete or not.
    folder : path
        Run folder.

    Returns
    -------
    dict
        The summary.

    Raises
    ------
    HistoryError
        If the folder cannot be written; nothing is left half written.
    """
    folder = as_path("folder", folder)
    summary = write_state(history, folder)
    with _whole_files(folder):
        write_metrics(history, folder / "metrics.csv")
        save_figure(folded_picture(history, summary), folder / "folded.png")
        if history.onset is not None:
            save_figure(onset_picture(history, history.onset), folder / "onset.png")
        write_vtkhdf(history, folder / "history.vtkhdf")
    return summary


def write_state(history: History, folder: Pathlike) -> dict[str, Any]:
    """Write ``summary.json`` alone, in a moment: what a folder should tell when there is no time for more.

    Parameters
    ----------
    history : History
        The run, complete or not.
    folder : path
        Run folder.

    Returns
    -------
    dict
        The summary.

    Raises
    ------
    HistoryError
        If the folder cannot be written.
    """
    folder = as_path("folder", folder)
    summary = summarise(history)
    with _whole_files(folder):
        write_summary(summary, folder / "summary.json")
    return summary


@contextmanager
def _whole_files(folder: Path) -> Iterator[None]:
    """Say in plain words that a disk is full, and leave no half of a file behind."""
    try:
        with storage_faults(folder, f"The outputs in {folder}"):
            yield
    except HistoryError:
        for partial in folder.glob("*.partial"):
            partial.unlink(missing_ok=True)
        raise


def folded_picture(history: History, summary: dict[str, Any]) -> Figure:
    """Picture of the last state, titled with what it shows and, if it ended early, where and how."""
    mesh, config = history.mesh, history.config
    title = (
        f"E ratio {config.material.stiffness_ratio:.3g}, growth ratio {config.growth.ratio:.3g}, "
        f"T = {config.geometry.cortical_thickness:g} mm"
    )
    if history.status != "completed":
        title += f" ({history.status} at {history.fractions[-1]:.0%} of growth)"
    told = mark(summary["converged"], len(summary["warnings"]))
    if mesh.n_dim == 3:
        return _folded_body(history, summary, title, told)
    return folded_figure(
        history.points(),
        mesh.triangles,
        mesh.triangle_region,
        mesh.contour,
        mesh.interface,
        closing_radius=config.metrics.closing_radius,
        gi=summary["gi"]["closing"],
        n_gyri=summary["n_gyri"],
        title=title,
        mark=told,
        period=mesh.period,
    )


def _folded_body(history: History, summary: dict[str, Any], title: str, told: str) -> Figure:
    """Picture of a body in space: three views and a section."""
    from gyrify.report.plot.space_figure import space_figure

    surface = surface_of(history.mesh, history.points(), history.config.metrics)
    gi, n_gyri = summary["gi"], summary["n_gyri"]
    index = (
        f"GI by area {gi['area']['closing']:.3f} (closing, {gi['closing_radius_mm']:.3g} mm), "
        f"{gi['area']['hull']:.3f} (hull); {n_gyri} {'gyrus' if n_gyri == 1 else 'gyri'}"
    )
    text = [(title, 9, "bold"), (index, 8, "normal"), (told, 7, "normal")]
    return space_figure(
        history.mesh, history.points(), depth=surface.depth[: history.mesh.contour.size], text=text
    )


def onset_picture(history: History, onset: Onset) -> Figure:
    """Picture of the mode along which the run first lost stability."""
    mesh, n = history.mesh, history.mesh.n_points
    if mesh.n_dim == 3:
        from gyrify.report.plot.mode import mode_plot
        from gyrify.report.plot.shown import show

        return mode_plot(show([history]), None)
    return mode_figure(
        mesh.points + onset.displacement[:n],
        onset.vector[:n],
        mesh.contour,
        mesh.interface,
        mesh.clamped,
        title=f"Loss of stability at growth time {onset.growth_time:.5g}",
        subtitle=wave_words(onset),
        period=mesh.period,
    )
