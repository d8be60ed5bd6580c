"""Units of every quantity in ``summary.json``, ``metrics.csv`` and ``results.parquet``, by its flat name."""

from __future__ import annotations

from typing import Final

from gyrify.config import Config
from gyrify.config.faults import sections
from gyrify.config.words import extra

# Pure numbers and counts have the unit 1, as in SI.
UNITS: Final[dict[str, str]] = {
    "growth_time": "growth time",
    "growth_fraction": "1",
    "gi_hull": "1",
    "gi_closing": "1",
    "gi_closing_radius_mm": "mm",
    "gi_exposed": "1",
    "n_gyri": "1",
    "sulcal_depth_mm_max": "mm",
    "sulcal_depth_mm_mean": "mm",
    "thickness_mm_crown": "mm",
    "thickness_mm_fundus": "mm",
    "gyrus_width_mm": "mm",
    "gyrus_flatness": "1",
    "fold_sharpness": "1",
    "contour_length_mm": "mm",
    "min_gap_mm": "mm",
    "min_J": "1",
    "min_J_elastic": "1",
    "nodes_per_wavelength": "1",
    "onset_growth_time": "growth time",
    "onset_mode_number": "1",
    "onset_wavelength_mm": "mm",
    "onset_visible_delay": "growth time",
    "onset_eigenvalue": "Pa/mm²",
    "visible_growth_time": "growth time",
    "relaxed_gi_closing": "1",
    "relaxed_n_gyri": "1",
    "relaxed_moved_mm": "mm",
    "expected_growth_time": "growth time",
    "expected_mode_number": "1",
    "expected_wavelength_mm": "mm",
    "converged_error": "1",
    "converged_limit": "1",
    "solver_increments": "1",
    "solver_newton_iterations": "1",
    "solver_factorizations": "1",
    "solver_analyses": "1",
    "solver_rejected": "1",
    "solver_residual": "Pa mm",
    "solver_tolerance": "Pa mm",
    "solver_wall_s": "s",
    "wall_s": "s",
}


def unit_of(name: str) -> str:
    """Unit of a column of the results: a quantity, or a parameter by its dotted key; empty for words.

    Parameters
    ----------
    name : str
        Such as ``gi_closing`` or ``geometry.cortical_thickness``.
    """
    section, dot, key = name.partition(".")
    kind = sections(Config).get(section)
    if dot and kind is not None and key in kind.model_fields:
        return extra(kind.model_fields[key], "unit")
    return UNITS.get(name, "")
