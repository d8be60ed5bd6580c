"""The folded slices of a study in a grid, one scale for all."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from gyrify.errors import ConfigError, HistoryError
from gyrify.report.drawn_slice import DrawnSlice, FloatArray, closed_slice, periodic_slice
from gyrify.report.figures import draw_tissues
from gyrify.report.layout import OUTLINE, legend, line
from gyrify.report.plot.bodies import Row, body_rows
from gyrify.report.plot.folded import tissue_handles
from gyrify.report.plot.shown import short, words_of
from gyrify.report.plot.slices import BAR_MM, Label, board, draw_lines, grid_columns
from gyrify.report.plot.style import DOUBLE
from gyrify.report.study_data import numeric, varied
from gyrify.report.surface_drawing import DrawnBody
from gyrify.store.folder import JOURNAL
from gyrify.study import StoredPoint, final_state, read_results
from gyrify.study.results import RESULTS

_MOST: Final = 500


@dataclass(frozen=True, eq=False)
class _Panel:
    """One run of a study: its row of the results, and its slice where it has one."""

    row: Mapping[str, Any]
    point: StoredPoint
    keys: tuple[str, ...]

    @cached_property
    def drawing(self) -> DrawnSlice:
        mesh, radius = self.point.mesh, self.point.config.metrics.closing_radius
        region = mesh.triangle_region.astype(np.int64)
        arrays = (self.point.points, mesh.triangles, region, mesh.contour, mesh.interface, radius)
        return closed_slice(*arrays) if mesh.period is None else periodic_slice(*arrays, mesh.period)

    @property
    def clamped(self) -> FloatArray:
        mesh = self.point.mesh
        return (
            self.drawing.floor if self.drawing.is_periodic else mesh.points[[*mesh.clamped, mesh.clamped[0]]]
        )

    @property
    def has_slice(self) -> bool:
        return bool(self.point.record.final_sha256)

    @property
    def in_space(self) -> bool:
        return self.has_slice and self.point.mesh.n_dim == 3

    @property
    def label(self) -> Label:
        names = [f"{words_of(key)} {short(self.row[key])}" for key in self.keys] or [self.point.key]
        if self.row["status"] != "completed":
            return Label(tuple(names), f"run {self.row['status']}")
        gyri = self.row["n_gyri"]
        index = ("GI by area", "gi_area_closing") if self.in_space else ("GI", "gi_closing")
        said = f"{index[0]} {self.row[index[1]]:.2f}"
        return Label((*names, f"{said}, {gyri} {'gyrus' if gyri == 1 else 'gyri'}"))


def is_study(folder: str | os.PathLike[str]) -> bool:
    """Whether a folder holds the results of a study, and no run."""
    return not (Path(folder) / JOURNAL).is_file() and (Path(folder) / RESULTS).is_file()


def study_plot(
    folder: Path, what: str, others: int = 0, at: float | None = None, width_mm: float | None = None
) -> Figure:
    """Folded slices of all runs of a study; two varied numbers give the columns and rows of the grid.

    Parameters
    ----------
    folder : Path
        Study folder.
    what : str
        Only ``folded`` can be drawn of a study.
    others : int
        Runs to compare with: there is no place for them.
    at : float, optional
        Growth time: a study keeps the last state alone.
    width_mm : float, optional
        Width of the page.

    Raises
    ------
    ConfigError
        If something else than the folded slices is asked for.
    HistoryError
        If no run of the study has a state, or one cannot be read.
    """
    if what != "folded" or others or at is not None:
        asked = f"what = {what}" if what != "folded" else "compare" if others else f"at = {at:g}"
        raise ConfigError(
            f"{asked} is not possible for the study {folder}: only the folded slices of a study are drawn, "
            "in their last state.",
            f'For other pictures, write keep = "all" in the study file and name a run: {folder}/runs/KEY.',
        )
    rows = read_results(folder).to_pylist()
    if len(rows) > _MOST:
        raise ConfigError(
            f"The study {folder} has {len(rows)} runs: a picture holds at most {_MOST}.",
            f"Look at them with: gyrify report {folder}",
        )
    keys = _named(rows)
    rows, columns = _arranged(rows)
    panels = [_Panel(row, final_state(folder, str(row["key"])), keys) for row in rows]
    in_space = [panel for panel in panels if panel.in_space]
    if in_space:
        return _bodies(in_space, len(panels), width_mm)
    frames = [(panel.drawing.low, panel.drawing.high) for panel in panels if panel.has_slice]
    if not frames:
        raise HistoryError(
            f"No run of the study {folder} has a state to draw.", f"See why with: gyrify table {folder}"
        )
    width = width_mm or DOUBLE
    whole = [(panel.drawing.low, panel.drawing.high) if panel.has_slice else frames[0] for panel in panels]
    columns = columns or grid_columns(len(panels), width)
    page = board(whole, [panel.label for panel in panels], width, columns=columns)
    for axes, panel in zip(page.panels, panels, strict=True):
        if panel.has_slice:
            draw_tissues(axes, panel.drawing.points, panel.drawing.cells, panel.drawing.region)
            for piece in panel.drawing.exposed:
                axes.add_line(line(piece, **OUTLINE))
            draw_lines(axes, panel.drawing, panel.clamped)
    legend(page.figure, tissue_handles(), columns=3 if width >= DOUBLE else 2, middle_mm=0.5 * BAR_MM)
    return page.figure


def _bodies(panels: Sequence[_Panel], count: int, width_mm: float | None) -> Figure:
    """A row for every run of a study of bodies in space that has a state."""
    rows = [Row(DrawnBody(panel.point.mesh, panel.point.points), panel.label) for panel in panels]
    missing = count - len(panels)
    note = f"{missing} of {count} runs, slices or without a state, are not drawn here" if missing else ""
    return body_rows(rows, width_mm, Label((), note) if note else None)


def _named(rows: Sequence[Mapping[str, Any]]) -> tuple[str, ...]:
    """Columns that tell the runs apart, the seed too where it differs."""
    seeds = ["seed"] if len({row.get("seed") for row in rows}) > 1 else []
    return (*varied(rows), *seeds)


def _arranged(rows: list[dict[str, Any]]) -> tuple[list[dict[str, Any]], int]:
    """Rows of the page, and its columns: a grid of two numbers as in a phase diagram, else as they are."""
    keys = varied(rows)
    if len(keys) != 2 or numeric(rows, keys) != keys:
        return rows, 0
    x, y = keys
    wide, tall = len({row[x] for row in rows}), len({row[y] for row in rows})
    if wide * tall != len(rows) or wide < 2 or wide > 6:
        return rows, 0
    return sorted(rows, key=lambda row: (-row[y], row[x])), wide
