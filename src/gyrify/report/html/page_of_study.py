"""The page of a study: every run of it, to sort, to compare and to look at."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from gyrify.config.rows import plain
from gyrify.config.words import decimals
from gyrify.metrics.quantities import Quantity, shown_in
from gyrify.report.html.assembly import STUDY_SCRIPTS, page
from gyrify.report.html.colours import colour_maps
from gyrify.report.html.study_runs import described_run, warnings_of
from gyrify.report.study_data import Row, axis_label, numeric, varied
from gyrify.study import read_results

# Bytes of deflated arrays that a page of a study carries; the scene of a run gets its share, but no less than
# one state needs. Runs that find no room are shown by their outlines.
_BUDGET: Final = 12_000_000
_LEAST: Final = 60_000
_MOST: Final = 24_000_000


def study_page(folder: Path, name: str) -> str:
    """Everything about a study in one HTML page.

    Parameters
    ----------
    folder : Path
        Study folder, with ``results.parquet``.
    name : str
        What to call it; any text.

    Returns
    -------
    str
        HTML that needs no network and no other file; equal results and names give equal pages.

    Raises
    ------
    HistoryError
        If there are no results.
    """
    rows = read_results(folder).to_pylist()
    keys = varied(rows)
    payloads: dict[str, str] = {}
    budget, room = max(_LEAST, _BUDGET // max(len(rows), 1)), _MOST
    runs = []
    for number, row in enumerate(rows):
        run, payload = described_run(folder, row, budget if room > 0 else 0)
        if payload:
            room -= len(payload) * 3 // 4
            run["payload"] = f"payload-{number}"
            payloads[run["payload"]] = payload
        runs.append(run | {"name": row["key"], "title": _title(row, keys), "values": _values(row, keys)})
    document = {
        "kind": "study",
        "colours": colour_maps(),
        "study": {"name": name, "columns": _columns(rows, keys), "axes": numeric(rows, keys), "runs": runs},
    }
    return page(document, payloads, STUDY_SCRIPTS)


def _columns(rows: Sequence[Row], keys: Sequence[str]) -> list[dict[str, Any]]:
    """What the table shows: what varies, then what came of it."""
    numbers = set(numeric(rows, keys))
    columns = [_column(key, axis_label(key), is_number=key in numbers, is_given=True) for key in keys]
    if any(map(warnings_of, rows)):
        columns.append(_column("n_warnings", "warnings"))
    if any(row.get("phenotype") is not None for row in rows):
        columns.append(_column("phenotype", "phenotype", is_number=False))
    return columns + [
        _column(q.key, q.axis, q.decimals and decimals((row.get(q.key) for row in rows), q.decimals))
        for q in _quantities()
        if any(row.get(q.key) is not None for row in rows)
    ]


def _quantities() -> list[Quantity]:
    """Those of slices and of bodies in space, which may be in one study."""
    return list({q.key: q for n_dim in (2, 3) for q in shown_in("study", n_dim)}.values())


def _column(
    key: str, label: str, decimals: int | None = None, *, is_number: bool = True, is_given: bool = False
) -> dict[str, Any]:
    return {
        "key": key,
        "label": label,
        "decimals": decimals,
        "is_number": is_number,
        "is_given": is_given,
    }


def _values(row: Row, keys: Sequence[str]) -> dict[str, Any]:
    """Values of the table's columns in one row."""
    found = {key: row[key] if isinstance(row[key], int | float) else plain(row[key]) for key in keys}
    found["n_warnings"] = len(warnings_of(row))
    return found | {key: row.get(key) for key in ("phenotype", *(quantity.key for quantity in _quantities()))}


def _title(row: Row, keys: Sequence[str]) -> str:
    """What tells a run from the others, in one line."""
    told = []
    for key in keys:
        name, bracket, unit = axis_label(key).partition(" [")
        value = f"{row[key]:.4g}" if isinstance(row[key], float) else plain(row[key])
        told.append(f"{name} {value}{' ' + unit.rstrip(']') if bracket else ''}")
    return " · ".join(told) or str(row["key"])
