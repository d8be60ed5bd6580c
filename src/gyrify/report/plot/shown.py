"""What is shown: one state of a run, with its name and what a reader must know about it."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from gyrify.errors import ConfigError
from gyrify.metrics import Measures
from gyrify.report.drawn_slice import DrawnSlice, FloatArray, closed_slice, periodic_slice
from gyrify.report.surface_drawing import DrawnBody
from gyrify.run.measuring import surface_depth
from gyrify.run.summary import measure_state
from gyrify.run.validity.converged import convergence, mark
from gyrify.store.history import History

Run = History | str | os.PathLike[str]
# More differing parameters than this make a longer name than the folder has.
_MOST_NAMED = 2


@dataclass(frozen=True, eq=False)
class Shown:
    """One state of a run.

    Attributes
    ----------
    history : History
        The run.
    index : int
        The state, from 0.
    name : str
        What tells it from the others shown.
    """

    history: History
    index: int
    name: str

    @property
    def growth_time(self) -> float:
        """Growth time of the state [model units]."""
        return float(self.history.growth_times[self.index])

    @cached_property
    def measures(self) -> Measures:
        """Metrics of the state."""
        return measure_state(self.history, self.index)

    @cached_property
    def drawing(self) -> DrawnSlice:
        """Triangles and lines of the state."""
        return state_sheet(self.history, self.index)

    @property
    def in_space(self) -> bool:
        """Whether the body lies in space."""
        return self.history.mesh.n_dim == 3

    @cached_property
    def body(self) -> DrawnBody:
        """Surface and cells of the state of a body in space."""
        return DrawnBody(
            self.history.mesh, self.history.points(self.index), surface_depth(self.history, self.index)
        )

    @property
    def note(self) -> str:
        """What became of a run that did not complete; empty for one that did."""
        status = self.history.status
        if status == "completed":
            return ""
        end = "under way" if status == "running" else status
        return f"run {end} at {self.history.fractions[-1]:.0%} of growth"

    @property
    def mark(self) -> str:
        """Whether the mesh is known to be converged for the numbers of the state."""
        is_end = self.history.status == "completed" and self.index == len(self.history) - 1
        return mark(convergence(self.history.config, self.measures.index, is_complete=is_end))

    @property
    def caption(self) -> str:
        """Growth time, index and number of gyri, and what is known of the mesh."""
        gyri = self.measures.n_gyri
        index = f"GI {'by area ' if self.in_space else ''}{self.measures.index:.2f}"
        return f"t = {self.growth_time:.4g}, {index}, {gyri} {'gyrus' if gyri == 1 else 'gyri'} ({self.mark})"


def show(runs: Sequence[Run], at: float | None = None) -> list[Shown]:
    """States to show, of one run or of several to compare.

    Parameters
    ----------
    runs : sequence of History or path
        Runs or their folders.
    at : float, optional
        Growth time [model units]; the stored state nearest to it is shown, the last one by default.

    Returns
    -------
    list of Shown

    Raises
    ------
    ConfigError
        If a run holds no such growth time.
    HistoryError
        If there is no run in a folder.
    """
    histories = [run if isinstance(run, History) else History.load(run) for run in runs]
    names = _names(histories) if len(histories) > 1 else [run_title(histories[0])]
    return [Shown(h, nearest_state(h, at), name) for h, name in zip(histories, names, strict=True)]


def nearest_state(history: History, at: float | None) -> int:
    """Stored state nearest to a growth time; the last one where there is none given."""
    times = history.growth_times
    if at is None:
        return len(history) - 1
    if not 0.0 <= at <= times[-1] * (1.0 + 1e-9):
        raise ConfigError(
            f"at = {at:g} is out of range: {_folder_name(history)} holds growth times 0 to {times[-1]:g}.",
            "Give a growth time in that range.",
        )
    return int(np.argmin(np.abs(times - at)))


def run_title(history: History) -> str:
    """What a run folds, in one line."""
    config = history.config
    return (
        f"E ratio {config.material.stiffness_ratio:.3g}, growth ratio {config.growth.ratio:.3g}, "
        f"T = {config.geometry.cortical_thickness:g} mm"
    )


def state_sheet(history: History, index: int) -> DrawnSlice:
    """Triangles and lines of a state of a slice, or of three periods of a strip."""
    mesh, radius = history.mesh, history.config.metrics.closing_radius
    x = history.points(index)
    region = mesh.triangle_region.astype(np.int64)
    arrays = (x, mesh.triangles, region, mesh.contour, mesh.interface, radius)
    return closed_slice(*arrays) if mesh.period is None else periodic_slice(*arrays, mesh.period)


def per_triangle(history: History, values: FloatArray, drawing: DrawnSlice) -> FloatArray:
    """Values of the cells for every triangle of a drawing: quadratic cells have four, strips three images."""
    n_triangles = len(history.mesh.triangles)
    of_mesh = np.repeat(values, n_triangles // history.mesh.n_cells)
    return np.tile(of_mesh, len(drawing.cells) // n_triangles)


def _names(histories: Sequence[History]) -> list[str]:
    """Names by the parameters in which runs differ, or by their folders where these are many or none."""
    tables = [_flat(history.config.model_dump()) for history in histories]
    keys = [key for key in tables[0] if len({repr(table.get(key)) for table in tables}) > 1]
    keys = [key for key in keys if key.split(".")[0] not in ("output", "limits", "preset")]
    folders = [_folder_name(history) for history in histories]
    if not 0 < len(keys) <= _MOST_NAMED:
        return folders
    return [", ".join(f"{words_of(key)} {short(table[key])}" for key in keys) for table in tables]


def _flat(table: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for key, value in table.items():
        flat |= _flat(value, f"{prefix}{key}.") if isinstance(value, dict) else {f"{prefix}{key}": value}
    return flat


def words_of(key: str) -> str:
    """``growth.ratio`` becomes growth ratio; a last word that says enough stands alone."""
    section, _, name = key.rpartition(".")
    return (
        f"{section} {name}"
        if name in ("ratio", "rate", "number", "kind", "enabled")
        else name.replace("_", " ")
    )


def short(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _folder_name(history: History) -> str:
    path = history.journal.path
    return "the run" if path is None else path.resolve().parent.name
