"""Metrics of the states of a run, by its own lengths of measuring or by others."""

from __future__ import annotations

import csv
import math
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from gyrify.base.arguments import real_number
from gyrify.config import Config
from gyrify.config.run_sections import Metrics
from gyrify.metrics import Measures
from gyrify.run.body_measures import measured, surface_of
from gyrify.run.validity.lengths import check_lengths
from gyrify.solve.types import FloatArray
from gyrify.store.files import whole_file
from gyrify.store.history import History
from gyrify.store.state_numbers import state_number


def measure_state(
    history: History,
    index: int = -1,
    *,
    closing_radius: float | None = None,
    gyrus_prominence: float | None = None,
) -> Measures:
    """Metrics of one state of a run, also with other lengths than those it was first measured with.

    Parameters
    ----------
    history : History
        The run.
    index : int
        State; negative indices count from the end.
    closing_radius : float, optional
        Radius of the morphological closing [mm], > 0; the configuration's own by default.
    gyrus_prominence : float, optional
        Smallest prominence of a gyrus [mm], > 0; the configuration's own by default.

    Returns
    -------
    Measures
        Every metric. Nothing that is stored changes.

    Raises
    ------
    ConfigError
        If a length is out of range.
    HistoryError
        If there is no such state.

    Warns
    -----
    UserWarning
        If a length that is given does not fit the body.
    """
    config = measured_with(history.config, closing_radius, gyrus_prominence)
    if config is not history.config:
        for sentence in check_lengths(config):
            warnings.warn(sentence, UserWarning, stacklevel=2)
    return _measured(history, index, config.metrics)


def measured_with(config: Config, closing_radius: float | None, gyrus_prominence: float | None) -> Config:
    """Return the configuration with other lengths of measuring [mm], where they are given."""
    lengths = {"metrics.closing_radius": closing_radius, "metrics.gyrus_prominence": gyrus_prominence}
    given = {key: real_number(key, length) for key, length in lengths.items() if length is not None}
    return config.with_overrides(given) if given else config


def _measured(history: History, index: int, chosen: Metrics, *, earlier: bool = False) -> Measures:
    number, lengths = state_number(index, len(history)), (chosen.closing_radius, chosen.gyrus_prominence)
    key = ("measures", number, *lengths, chosen.samples, earlier)
    if key not in history.known_measures:
        x, mesh = history.points(number), history.mesh
        if mesh.n_dim == 3:
            surface = surface_of(mesh, x, chosen)
            history.known_measures[key] = Measures.of(surface)
            history.known_measures["depth", number, *lengths] = surface.depth[: history.mesh.contour.size]
        else:
            history.known_measures[key] = measured(mesh, x, chosen, earlier=earlier)
    found: Measures = history.known_measures[key]
    return found


def surface_depth(history: History, index: int = -1) -> FloatArray:
    """(n_contour,) depth of the points of the outer surface below its closing, of a body in space [mm]."""
    number, chosen = state_number(index, len(history)), history.config.metrics
    _measured(history, number, chosen)
    found: FloatArray = history.known_measures[
        "depth", number, chosen.closing_radius, chosen.gyrus_prominence
    ]
    return found


def volume_extremes(history: History, index: int = -1) -> tuple[float, float]:
    """Smallest J = det F and smallest J_e = J / J_g over the whole of all cells of a state [-].

    Where J varies inside the cells (quadratic ones) these are bounds from below, at most a millionth of
    themselves or of 1 below the smallest value.
    """
    number = state_number(index, len(history))
    if ("volumes", number) not in history.known_measures:
        time = float(history.growth_times[number])
        J, J_e = history.slice.least_volume_ratios(history.state_vector(number), time)
        history.known_measures["volumes", number] = float(J.min()), float(J_e.min())
    found: tuple[float, float] = history.known_measures["volumes", number]
    return found


def point_extremes(history: History, index: int = -1) -> tuple[float, float]:
    """`volume_extremes` at the integration points alone, as earlier versions stored them."""
    problem, number = history.slice, state_number(index, len(history))
    J = problem.volume_ratio(history.state_vector(number))
    J_g = problem.volume_growth(float(history.growth_times[number]))
    return float(J.min()), float((J / J_g).min())


def metrics_rows(
    history: History,
    states: Sequence[int] | None = None,
    *,
    closing_radius: float | None = None,
    gyrus_prominence: float | None = None,
) -> list[dict[str, Any]]:
    """One row of flat metrics per state, as in ``metrics.csv``.

    Parameters
    ----------
    history : History
        The run.
    states : sequence of int, optional
        States, counted from 0; all by default.
    closing_radius, gyrus_prominence : float, optional
        Lengths to measure with [mm], as in `measure_state`.

    Returns
    -------
    list of dict
        Values by the names of the columns.
    """
    chosen = measured_with(history.config, closing_radius, gyrus_prominence).metrics
    return _rows(history, states, lambda index: _measured(history, index, chosen))


def earlier_rows(history: History) -> list[dict[str, Any]]:
    """`metrics_rows` by the rules of measuring of earlier runs, see `metrics.measure.measure_valid`."""
    return _rows(history, None, lambda index: earlier_measures(history, index))


def earlier_measures(history: History, index: int = -1) -> Measures:
    """`measure_state` by the rules of measuring of earlier runs."""
    return _measured(history, index, history.config.metrics, earlier=True)


def _rows(
    history: History, states: Sequence[int] | None, measured: Callable[[int], Measures]
) -> list[dict[str, Any]]:
    times, fractions, residuals = history.growth_times, history.fractions, history.residuals
    work = {
        name: history.journal.column(name) for name in ("newton_iterations", "factorizations", "analyses")
    }
    rows = []
    for index in range(len(history)) if states is None else states:
        measures, (min_J, min_J_elastic) = measured(index), volume_extremes(history, index)
        rows.append(
            {
                "increment": index,
                "growth_time": float(times[index]),
                "growth_fraction": float(fractions[index]),
                **measures.flat(),
                "min_J": min_J,
                "min_J_elastic": min_J_elastic,
                "nodes_per_wavelength": nodes_per_wavelength(history, measures),
                "solver_residual": float(residuals[index]),
                **{f"solver_{name}": column[index] for name, column in work.items()},
            }
        )
    return rows


def nodes_per_wavelength(history: History, measures: Measures) -> float | None:
    """Points of the contour on one fold, in space on a wavelength; None without gyri."""
    if history.mesh.n_dim == 3:
        area_per_point = measures.surface_area / history.mesh.contour.size
        return measures.wavelength / math.sqrt(area_per_point) if measures.wavelength else None
    return history.mesh.contour.size / measures.n_gyri if measures.n_gyri else None


def write_metrics(
    history: History,
    path: Path,
    states: Sequence[int] | None = None,
    *,
    closing_radius: float | None = None,
    gyrus_prominence: float | None = None,
) -> None:
    """Write ``metrics.csv``, one row per state, by atomic rename; parameters as in `metrics_rows`."""
    rows = metrics_rows(history, states, closing_radius=closing_radius, gyrus_prominence=gyrus_prominence)
    with whole_file(path) as partial, partial.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
