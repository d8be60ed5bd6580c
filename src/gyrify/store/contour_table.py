"""The outer contour as a table: place, shape, thickness, depth, stresses and contact."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Final

import numpy as np

from gyrify.config.run_sections import OutputField
from gyrify.mesh import Mesh
from gyrify.metrics.contour import filled, fitting_radius, offset_outline
from gyrify.metrics.periodic import strip_sulcal_depth
from gyrify.metrics.sulci import depth_below
from gyrify.solve.types import FloatArray
from gyrify.store.fields import FieldMaker
from gyrify.store.files import fresh
from gyrify.store.history import History

COLUMNS: Final = (
    "increment",
    "growth_time",
    "point",
    "arc_length_mm",
    "x_mm",
    "y_mm",
    "X_mm",
    "Y_mm",
    "normal_x",
    "normal_y",
    "curvature_per_mm",
    "thickness_mm",
    "depth_mm",
    "von_mises_Pa",
    "mean_stress_Pa",
    "circumferential_stress_Pa",
    "contact_force_x_Pa_mm",
    "contact_force_y_Pa_mm",
)
_STRESSES: Final[tuple[OutputField, ...]] = ("von_mises", "mean_stress", "circumferential_stress")


def write_contour(history: History, path: Path, states: list[int]) -> list[Path]:
    """Write the contour of some states to one CSV file, in the order of the contour."""
    maker = FieldMaker(history.slice)
    with fresh(path).open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for number in states:
            time = float(history.growth_times[number])
            for point, row in zip(
                history.mesh.contour.tolist(), contour_rows(history, number, maker).tolist(), strict=True
            ):
                writer.writerow((number, time, point, *row))
    return [path]


def contour_rows(history: History, number: int, maker: FieldMaker | None = None) -> FloatArray:
    """Columns of a state from ``arc_length_mm`` on.

    Parameters
    ----------
    history : History
        The run.
    number : int
        The state, from 0.
    maker : FieldMaker, optional
        That of the run, where it is at hand.

    Returns
    -------
    (n_contour, 15) float array
        Arc length, normal, curvature, thickness and depth are those of the current state. A stress is the
        mean over the cells that meet in the point, by their reference areas. Forces are per unit thickness
        of the slice.
    """
    mesh, u = history.mesh, history.state_vector(number)
    before = history.state_vector(max(number - 1, 0))
    state = (maker or FieldMaker(history.slice)).state(u, float(history.fractions[number]), before)
    x = mesh.points[mesh.contour] + u[mesh.contour]
    edges, lengths = _edges(mesh, x)
    parts = [
        np.concatenate([[0.0], np.cumsum(lengths)[:-1]]),
        x,
        mesh.points[mesh.contour],
        _normals(edges / lengths[:, None], mesh),
        state["curvature"][mesh.contour],
        state["thickness"][mesh.contour],
        _depth(history, x),
        *(_at_contour(mesh, state[name]) for name in _STRESSES),
        state["contact_force"][mesh.contour],
    ]
    return np.column_stack(parts)


def _edges(mesh: Mesh, x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Edges from each point of the contour to the next one, and their lengths [mm]."""
    edges = np.roll(x, -1, axis=0) - x
    if mesh.period is not None:
        start, after = mesh.points[mesh.contour[:2], 0]
        edges[-1, 0] += np.copysign(mesh.period, after - start)
    return edges, np.hypot(edges[:, 0], edges[:, 1])


def _normals(tangents: FloatArray, mesh: Mesh) -> FloatArray:
    """Unit outward normals: between those of the two edges that meet in a point."""
    along = tangents + np.roll(tangents, 1, axis=0)
    along /= np.hypot(along[:, 0], along[:, 1])[:, None]
    start, after = mesh.points[mesh.contour[:2], 0]
    # A ring runs counter-clockwise; a strip that runs to the right has the outside on its left.
    is_on_left = mesh.period is not None and bool(after > start)
    normals = np.column_stack([along[:, 1], -along[:, 0]])
    return -normals if is_on_left else normals


def _depth(history: History, x: FloatArray) -> FloatArray:
    """Distance to the outline of the closing [mm]."""
    radius, period = history.config.metrics.closing_radius, history.mesh.period
    if period is not None:
        return strip_sulcal_depth(x, period, radius)
    tissue = filled(x)
    radius = fitting_radius(tissue, radius)
    return depth_below(x, offset_outline(tissue, radius), radius)


def _at_contour(mesh: Mesh, values: FloatArray) -> FloatArray:
    """Means over the cells that meet in each point of the contour, by their reference areas."""
    corners = mesh.cell_points[:, :3]
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    areas = 0.5 * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    n_nodes = mesh.cells.shape[1]
    weights, sums = (
        np.bincount(mesh.cells.ravel(), np.repeat(what, n_nodes), mesh.n_points)
        for what in (areas, areas * values)
    )
    return np.asarray((sums / weights)[mesh.contour])
