"""What a page says of a run in words and numbers: its end, its settings, its work, how to run it again."""

from __future__ import annotations

from shlex import quote
from typing import Any

from gyrify.config import Config
from gyrify.config.table import plain, rows
from gyrify.config.words import decimals
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
        From `gyrify.summary.summarise`.

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
        "numbers": numbers(summary),
        "onset": summary["onset"],
        "settings": settings(config),
        "solver": solver(summary),
        "versions": [[key, str(value)] for key, value in summary["versions"].items()],
        "hashes": [["configuration", summary["config_hash"]], ["result", summary["result_hash"]]],
        "toml": config.to_toml(),
        "command": f"gyrify run config.toml --out {quote(name)}",
    }


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


def numbers(summary: dict[str, Any]) -> list[list[Any]]:
    """Label, value, unit, decimals (None: as needed) and explanation of what the run came to."""
    gi, depth, thickness, onset = (summary[key] for key in ("gi", "sulcal_depth_mm", "thickness_mm", "onset"))
    sentence = summary["converged"]["sentence"]
    closing = (
        f"Contour over the outline of the closing with radius {gi['closing_radius_mm']:g} mm. {sentence}"
    )
    found = [
        ["GI, closing", gi["closing"], "", 3, closing],
        ["GI, hull", gi["hull"], "", 3, "Contour over the perimeter of the convex hull"],
        ["GI, exposed", gi["exposed"], "", 3, "Contour over the part of it on the closing's outline"],
        ["gyri", summary["n_gyri"], "", None, "Maxima of the normal displacement from the smooth contour"],
        _length("deepest sulcus", depth["max"], "Distance of the deepest fundus to the closing's outline"),
        _length("cortex at crowns", thickness["crown"], "Mean shortest distance to the interface"),
        _length("cortex at fundi", thickness["fundus"], "Mean shortest distance to the interface"),
    ]
    if onset is not None:
        lost = f"Growth time at which the slice lost stability. {summary['stability_note']}".strip()
        found.append(["stability lost at time", onset["growth_time"], "", 1, lost])
    return found


def _length(label: str, value: float, about: str) -> list[Any]:
    return [label, value, "mm", decimals([value], 2), about]


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


def solver(summary: dict[str, Any]) -> list[list[Any]]:
    """Label, value and unit of what the solution cost, and how good it is."""
    work = summary["solver"]
    return [
        ["increments", work["increments"], ""],
        ["Newton iterations", work["newton_iterations"], ""],
        ["factorisations", work["factorizations"], ""],
        ["symbolic analyses", work["analyses"], ""],
        ["rejected increments", work["rejected"], ""],
        ["largest nodal force at the end", work["residual"], "Pa·mm"],
        ["tolerance of it", work["tolerance"], "Pa·mm"],
        ["smallest J", summary["min_J"], ""],
        ["smallest elastic J", summary["min_J_elastic"], ""],
        ["smallest gap of the contour", summary["min_gap_mm"], "mm"],
        ["contour nodes per fold", summary["nodes_per_wavelength"], ""],
        ["linear solver", work["linear_solver"], ""],
        ["contact by", work.get("contact_library", "unknown"), ""],
        ["time spent", work["wall_s"], "s"],
    ]
