"""What a run came to: the metrics of its states, and the summary of the whole."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

import numpy as np
from pydantic import BaseModel

from gyrify.config import Config
from gyrify.config.inputs.named_files import FILE_KEYS, kept_name
from gyrify.config.rows import rows
from gyrify.metrics import Measures
from gyrify.metrics.quantities import Quantity, by_key
from gyrify.run.measuring import (
    earlier_measures,
    measure_state,
    metrics_rows,
    nodes_per_wavelength,
    volume_extremes,
    write_metrics,
)
from gyrify.run.onset.visible_time import visible_time
from gyrify.run.units import unit_of
from gyrify.run.validity import config_warnings, run_warnings
from gyrify.run.validity.converged import convergence
from gyrify.run.validity.expected import expected_onset
from gyrify.solve.stability import StabilityChange
from gyrify.store.files import whole_file
from gyrify.store.history import History

__all__ = [
    "measure_state",
    "metrics_rows",
    "summarise",
    "volume_extremes",
    "write_metrics",
    "write_summary",
]

# Parameters that every summary tells.
_TOLD: Final = frozenset(
    {
        "geometry.shape",
        "geometry.cortical_thickness",
        "material.stiffness_ratio",
        "growth.ratio",
        "growth.rate",
        "growth.duration",
        "dissipation.kind",
        "dissipation.number",
        "mesh.n_around",
        "mesh.n_layers",
        "mesh.element",
        "solver.increments",
    }
)


def summarise(history: History) -> dict[str, Any]:
    """Summary of a run, with the keys of ``summary.json``.

    Parameters
    ----------
    history : History
        The run, complete or not.

    Returns
    -------
    dict
        Plain values under the names of ``summary.json``.
    """
    return _summary(history, measure_state(history))


def earlier_summary(history: History) -> dict[str, Any]:
    """`summarise` by the rules of measuring of earlier runs."""
    return _summary(history, earlier_measures(history))


def _summary(history: History, measures: Measures) -> dict[str, Any]:
    min_J, min_J_elastic = volume_extremes(history)
    stats, visible = history.stats, visible_time(history)
    summary: dict[str, Any] = _without_infinities(
        {
            "status": history.status,
            "reason": history.reason,
            "advice": history.advice,
            "config_hash": history.config.config_hash,
            "result_hash": history.result_hash,
            "growth_time": float(history.growth_times[-1]),
            **measures.as_dict(),
            "min_J": min_J,
            "min_J_elastic": min_J_elastic,
            "nodes_per_wavelength": nodes_per_wavelength(history, measures),
            "onset": _onset(history, visible),
            "stability_changes": [_change(change) for change in history.stability_changes],
            "visible_growth_time": visible,
            "relaxed": None if history.relaxed is None else asdict(history.relaxed),
            "stable": history.stable,
            "stability_note": _stability_note(history, measures.n_gyri),
            "solver": {
                "increments": len(history) - 1,
                "newton_iterations": stats.newton_iterations,
                "factorizations": stats.factorizations,
                "analyses": stats.analyses,
                "rejected": stats.rejected,
                "residual": float(history.residuals[-1]),
                "tolerance": history.slice.stepping.criterion.force,
                "linear_solver": history.linear_solver,
                "contact_library": history.contact_library,
                "wall_s": history.wall_s,
            },
            "versions": history.versions,
            "seed": history.config.seed,
            "parameters": _parameters(history.config),
        }
    )
    is_complete = history.status == "completed"
    summary["expected"] = expected_onset(history.config).as_dict()
    summary["converged"] = convergence(history.config, measures.index, is_complete=is_complete)
    known = by_key()
    summary["units"] = {
        name: unit_of(name, history.mesh.n_dim) for name in _flat_names(summary) if _has_unit(name, known)
    }
    summary["warnings"] = [*config_warnings(history.config), *run_warnings(history, summary)]
    return summary


def _parameters(config: Config) -> dict[str, Any]:
    """What a reader asks for first, and every other value that is not the default; by dotted key."""
    told = {
        row.key: _plain(row.value)
        for row in rows(config)
        if row.key in _TOLD or (row.default is not None and row.value != row.default)
    }
    # where a file lies says nothing: its copy in the folder is told
    paths = {f"geometry.{key}": key for key in FILE_KEYS}
    return {key: kept_name(paths[key], str(value)) if key in paths else value for key, value in told.items()}


def _plain(value: Any) -> Any:
    """A value as JSON has it."""
    if isinstance(value, BaseModel):
        return value.model_dump(mode="json")
    return list(value) if isinstance(value, tuple) else value


def _has_unit(name: str, known: Mapping[str, Quantity]) -> bool:
    return name in known and known[name].unit != ""


def _flat_names(table: Mapping[str, Any], prefix: str = "") -> Iterator[str]:
    """Names of the quantities of a summary, as ``metrics.csv`` and ``results.parquet`` have them."""
    for key, value in table.items():
        if isinstance(value, dict) and key not in ("parameters", "versions"):
            yield from _flat_names(value, f"{prefix}{key}_")
        else:
            yield f"{prefix}{key}"


def _onset(history: History, visible: float | None) -> dict[str, Any] | None:
    onset = history.onset
    if onset is None:
        return None
    return {
        "growth_time": onset.growth_time,
        "kind": onset.kind,
        "mode_number": onset.mode_number,
        "wavelength_mm": onset.wavelength or None,
        "eigenvalue": onset.eigenvalue,
        "visible_delay": None if visible is None else visible - onset.growth_time,
    }


def _change(change: StabilityChange) -> dict[str, Any]:
    return {
        "growth_time": change.growth_time,
        "bracket": list(change.bracket),
        "n_unstable": [change.n_before, change.n_after],
        "kind": change.kind,
        "mode_number": change.mode_number,
        "wavelength_mm": change.wavelength or None,
    }


def _stability_note(history: History, n_gyri: int) -> str:
    """What a reader of ``onset`` and ``stable`` should know."""
    onset, relaxed, until = history.onset, history.relaxed, history.smooth_until
    if history.stable is False and history.slice.is_conservative:
        return (
            "The final state is an unstable equilibrium: an arbitrarily small disturbance leaves it. "
            "Set stability.follow_branch = true."
        )
    if not history.config.stability.detect:
        return "The loss of stability was not looked for (stability.detect = false)."
    sentences = []
    if onset is not None:
        sentences.append(
            "Onset is where the smooth equilibrium, without node jitter and dissipation, loses stability."
        )
    elif until is not None:
        sentences.append(
            f"The onset is not known: the smooth equilibrium was followed to growth time {until:.6g} only."
        )
    elif n_gyri > 0:
        sentences.append("The slice has gyri, although its smooth equilibrium is stable on this mesh.")
    if relaxed is not None and not relaxed.is_kept:
        sentences.append(
            f"The final state is held by dissipation: without it, it would become another one, with "
            f"{relaxed.n_gyri} gyri and a gyrification index of {relaxed.gi_closing:.3f}."
        )
    return " ".join(sentences)


def write_summary(summary: dict[str, Any], path: Path) -> None:
    """Write ``summary.json`` by atomic rename."""
    with whole_file(path) as partial:
        partial.write_text(json.dumps(summary, indent=2, allow_nan=False) + "\n", encoding="utf-8")


def _without_infinities(value: Any) -> Any:
    """JSON knows no infinities; they become null."""
    if isinstance(value, dict):
        return {key: _without_infinities(entry) for key, entry in value.items()}
    if isinstance(value, float | np.floating):
        return float(value) if math.isfinite(value) else None
    return value
