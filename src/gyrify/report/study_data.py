"""Results of a study as arrays for pictures: cells of equal parameters, with the runs that differ in seed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from gyrify.config import Config
from gyrify.config.faults import sections
from gyrify.config.words import extra

FloatArray = NDArray[np.float64]
Row = Mapping[str, Any]

INDEX: Final = "gyrification index (closing)"


@dataclass(frozen=True)
class Cell:
    """Runs of equal parameters but for their seeds.

    Attributes
    ----------
    at : tuple
        Values of the parameters.
    gi, gyri : tuple of float
        Gyrification index (closing; in space of areas) and number of gyri of the runs that completed.
    phenotype : str
        The most frequent one; empty where no run completed, or none has one.
    n_failed : int
        Runs that did not complete.
    """

    at: tuple[Any, ...]
    gi: tuple[float, ...]
    gyri: tuple[float, ...]
    phenotype: str
    n_failed: int


def varied(rows: Sequence[Row]) -> list[str]:
    """Dotted columns that take more than one value."""
    names = [name for name in rows[0] if "." in name] if rows else []
    return [name for name in names if len({row[name] for row in rows}) > 1]


def numeric(rows: Sequence[Row], keys: Sequence[str]) -> list[str]:
    """Keys whose values are all numbers."""
    return [key for key in keys if all(type(row[key]) in (int, float) for row in rows)]


def cells(rows: Sequence[Row], keys: Sequence[str]) -> list[Cell]:
    """Rows gathered by the values of some parameters, in order of appearance."""
    groups: dict[tuple[Any, ...], list[Row]] = {}
    for row in rows:
        groups.setdefault(tuple(row[key] for key in keys), []).append(row)
    return [_cell(at, group) for at, group in groups.items()]


def axis_label(key: str) -> str:
    """What a parameter is called on an axis, with its unit."""
    section, _, name = key.rpartition(".")
    unit = extra(sections(Config)[section].model_fields[name], "unit") if section else ""
    plain = name.replace("_", " ")
    named = plain if section in ("geometry", "material") else f"{section} {plain}".strip()
    return f"{named} [{unit}]" if unit else named


def is_logarithmic(values: FloatArray) -> bool:
    """Whether values lie rather in equal ratios than at equal distances."""
    ordered = np.unique(values)
    if ordered.size < 3 or ordered[0] <= 0.0 or ordered[-1] < 3.0 * ordered[0]:
        return False
    gaps, ratios = np.diff(ordered), np.diff(np.log(ordered))
    return bool(ratios.std() / ratios.mean() < gaps.std() / gaps.mean())


def _is_finite(value: float | None) -> bool:
    return value is not None and math.isfinite(value)


def _index(row: Row) -> float | None:
    """Index by the closing, in space of areas."""
    found: float | None = row["gi_closing"]
    return row.get("gi_area_closing") if found is None else found


def index_name(rows: Sequence[Row]) -> str:
    """What the index of some rows is called."""
    in_space = [row.get("gi_area_closing") is not None for row in rows]
    if not any(in_space):
        return INDEX
    in_plane = any(row["gi_closing"] is not None for row in rows)
    return f"gyrification index (closing{'; in space by area' if in_plane else ', by area'})"


def _cell(at: tuple[Any, ...], group: Sequence[Row]) -> Cell:
    whole = [row for row in group if row["status"] == "completed" and _is_finite(_index(row))]
    labels = [row["phenotype"] for row in whole if row.get("phenotype")]
    return Cell(
        at,
        tuple(float(_index(row)) for row in whole),  # type: ignore[arg-type]
        tuple(float(row["n_gyri"]) for row in whole),
        max(labels, key=labels.count) if labels else "",
        len(group) - len(whole),
    )
