"""What is plotted against growth time: gyrification, depth and energy of every state."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import accumulate
from typing import Any, Final

from gyrify.run.reevaluation import reevaluated
from gyrify.run.summary import metrics_rows
from gyrify.store.history import History

_MILLI: Final = 1e-6


def plots(history: History) -> list[dict[str, Any]]:
    """Plots of a run, each with its lines over all states.

    Parameters
    ----------
    history : History
        The run.

    Returns
    -------
    list of dict
        ``title``, ``unit``, ``times`` and ``lines`` (``label``, ``values``; None where there is no number).
    """
    rows = metrics_rows(history)
    # 1 Pa mm^2 is 1e-6 mJ per mm out of the plane; in space 1 Pa mm^3 is 1e-6 mJ
    unit = "mJ/mm" if history.mesh.n_dim == 2 else "mJ"
    return [*folding_plots(rows), _plot("Energy", unit, rows, energy_lines(history))]


def folding_plots(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """The plots that follow from the metrics alone."""
    radius, in_space = rows[0]["gi_closing_radius_mm"], "gi_area_hull" in rows[0]
    index = (
        (
            (f"closing {radius:.2g} mm", "gi_area_closing"),
            ("hull", "gi_area_hull"),
            ("sections", "gi_sections"),
        )
        if in_space
        else ((f"closing {radius:g} mm", "gi_closing"), ("hull", "gi_hull"), ("exposed", "gi_exposed"))
    )
    depth = (("deepest", "sulcal_depth_mm_max"), ("mean", "sulcal_depth_mm_mean"))
    return [
        _plot(f"Gyrification index{' by area' if in_space else ''}", "", rows, _columns(rows, index)),
        _plot("Sulcal depth", "mm", rows, _columns(rows, depth)),
    ]


def energy_lines(history: History) -> list[dict[str, Any]]:
    """Energies of every state, summed up over the increments as they are evaluated again.

    They are in mJ/mm, in space in mJ.

    Work of growth is what goes in; the rest is stored elastically, in contact or in the surroundings, if
    there are any, or dissipated.
    """
    increments = list(reevaluated(history))
    outside = [i.external for i in increments]
    parts = (
        ("elastic", [i.stored for i in increments]),
        ("dissipated", [i.dissipated for i in increments]),
        ("contact", [i.contact for i in increments]),
        *([("surroundings", outside)] if any(outside) else ()),
        ("work of growth", [i.work for i in increments]),
    )
    return [
        {"label": label, "values": [_number(_MILLI * v) for v in accumulate(changes, initial=0.0)]}
        for label, changes in parts
    ]


def _columns(rows: Sequence[dict[str, Any]], names: Iterable[tuple[str, str]]) -> list[dict[str, Any]]:
    return [{"label": label, "values": [_number(row[key]) for row in rows]} for label, key in names]


def _plot(
    title: str, unit: str, rows: Sequence[dict[str, Any]], lines: list[dict[str, Any]]
) -> dict[str, Any]:
    return {"title": title, "unit": unit, "times": [row["growth_time"] for row in rows], "lines": lines}


def _number(value: float | None) -> float | None:
    """Enough digits for a plot and its legend; None where it is not finite."""
    return float(f"{value:.7g}") if value is not None and math.isfinite(value) else None
