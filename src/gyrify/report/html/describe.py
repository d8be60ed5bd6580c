"""What a page says of a run in words and numbers: its end, its settings, its work, how to run it again."""

from __future__ import annotations

from shlex import quote
from typing import Any

from gyrify.config import Config
from gyrify.config.rows import plain, rows
from gyrify.config.words import decimals
from gyrify.metrics.quantities import flat, shown_in
from gyrify.run.units import force_unit
from gyrify.store.history import History


def about(history: History, name: str, summary: dict[str, Any]) -> dict[str, Any]:
    """Everything that a page says of a run besides its pictures.

    Parameters
    ----------
    history : History
        The run.
    name : str
        What to call it; any text.
    summary : dict
        From `gyrify.run.summary.summarise`.

    Returns
    -------
    dict
        Ready for JSON.
    """
    config = history.config
    return {
        "name": name,
        "subtitle": subtitle(config),
        "status": summary["status"],
        "grown": float(history.fractions[-1]),
        "duration": config.growth.duration,
        "reason": summary["reason"],
        "advice": summary["advice"],
        "warnings": summary["warnings"],
        "mesh": {key: summary["converged"][key] for key in ("converged", "sentence", "command")},
        "note": summary["stability_note"],
        "numbers": numbers(summary, history.mesh.n_dim),
        "onset": _onset(summary, history),
        "settings": settings(config),
        "solver": solver(summary, history.mesh.n_dim),
        "versions": [[key, str(value)] for key, value in summary["versions"].items()],
        "hashes": [["configuration", summary["config_hash"]], ["result", summary["result_hash"]]],
        "toml": config.to_toml(),
        "command": f"gyrify run config.toml --out {quote(name)}",
    }


def _onset(summary: dict[str, Any], history: History) -> dict[str, Any] | None:
    """The onset; of a closed surface the number of its mode is a degree, not one of waves."""
    onset: dict[str, Any] | None = summary["onset"]
    is_degree = history.mesh.n_dim == 3 and history.mesh.is_closed
    return onset | {"is_degree": True} if onset is not None and is_degree else onset


def subtitle(config: Config) -> str:
    """The parameters that are varied most, in one line."""
    return " · ".join(
        (
            config.geometry.shape,
            f"stiffness ratio {config.material.stiffness_ratio:.4g}",
            f"growth ratio {config.growth.ratio:.4g}",
            f"cortex {config.geometry.cortical_thickness:g} mm",
        )
    )


def numbers(summary: dict[str, Any], n_dim: int = 2) -> list[list[Any]]:
    """Label, value, unit, decimals (None: as needed) and explanation of what the run came to."""
    values, mesh = flat(summary), summary["converged"]["sentence"]
    lead = "gi_closing" if n_dim == 2 else "gi_area_closing"
    more = {
        lead: f"with radius {values['gi_closing_radius_mm']:.4g} mm. {mesh}",
        "onset_growth_time": summary["stability_note"],
    }
    found = []
    for quantity in shown_in("run", n_dim):
        if (value := values.get(quantity.key)) is None and quantity.key not in values:
            continue
        unit = "" if quantity.unit in ("1", "growth time") else quantity.unit
        usual = quantity.decimals and decimals([value], quantity.decimals)
        about = _sentence(quantity.about, more.get(quantity.key, ""))
        found.append([quantity.label, value, unit, usual, about])
    return found


def _sentence(about: str, more: str) -> str:
    """What a quantity is, and what else there is to say: a part of the sentence, or one of its own."""
    if not more:
        return about
    return f"{about} {more}" if more[0].islower() else f"{about}. {more}"


def settings(config: Config) -> list[dict[str, Any]]:
    """Resolved configuration: one entry per key."""
    return [
        {
            "key": row.key,
            "value": plain(row.value),
            "unit": row.unit,
            "changed": row.is_changed,
            "about": row.doc,
            "source": row.source,
        }
        for row in rows(config)
    ]


def solver(summary: dict[str, Any], n_dim: int = 2) -> list[list[Any]]:
    """Label, value and unit of what the solution cost, and how good it is."""
    work, force, is_plane = summary["solver"], force_unit(n_dim).replace(" ", "·"), n_dim == 2
    nodes = "contour nodes per fold" if is_plane else "surface nodes per wavelength"
    return [
        ["increments", work["increments"], ""],
        ["Newton iterations", work["newton_iterations"], ""],
        ["factorisations", work["factorizations"], ""],
        ["symbolic analyses", work["analyses"], ""],
        ["rejected increments", work["rejected"], ""],
        ["largest nodal force at the end", work["residual"], force],
        ["tolerance of it", work["tolerance"], force],
        ["smallest J", summary["min_J"], ""],
        ["smallest elastic J", summary["min_J_elastic"], ""],
        [f"smallest gap of the {'contour' if is_plane else 'surface'}", summary["min_gap_mm"], "mm"],
        [nodes, summary["nodes_per_wavelength"], ""],
        ["linear solver", work["linear_solver"], ""],
        ["contact by", work.get("contact_library", "unknown"), ""],
        ["time spent", work["wall_s"], "s"],
    ]
