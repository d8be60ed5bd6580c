"""Units of every quantity in ``summary.json``, ``metrics.csv`` and ``results.parquet``, by its flat name."""

from __future__ import annotations

from gyrify.base.force_units import energy_unit, force_unit
from gyrify.config import Config
from gyrify.config.faults import sections
from gyrify.config.words import extra
from gyrify.metrics.quantities import by_key

__all__ = ["energy_unit", "force_unit", "unit_of"]


def unit_of(name: str, n_dim: int = 2) -> str:
    """Unit of a column of the results: a quantity, or a parameter by its dotted key; empty for words.

    Parameters
    ----------
    name : str
        Such as ``gi_closing`` or ``geometry.cortical_thickness``.
    n_dim : int
        Whether of a body in the plane (2) or in space (3): forces differ.
    """
    section, dot, key = name.partition(".")
    kind = sections(Config).get(section)
    if dot and kind is not None and key in kind.model_fields:
        return extra(kind.model_fields[key], "unit")
    quantity = by_key().get(name)
    unit = quantity.unit if quantity is not None else ""
    return force_unit(n_dim) if unit == force_unit(2) else unit
