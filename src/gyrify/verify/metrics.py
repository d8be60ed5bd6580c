"""Stored numbers of a run against those that its states give."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

from gyrify.config.words import shorten
from gyrify.errors import HistoryError
from gyrify.store.derived import read_metrics
from gyrify.store.history import History
from gyrify.summary import summarise
from gyrify.verify.result import Check
from gyrify.versions import versions

# Largest relative difference between a stored and a recomputed metric.
METRIC_BOUND: Final = 1e-9
# Keys of a summary that older versions did not write.
LATER_KEYS: Final = frozenset(
    {"warnings", "stability_changes", "visible_growth_time", "relaxed", "parameters", "units"}
)


def check_metrics(
    history: History, folder: Path, rows: list[dict[str, Any]], summary: dict[str, Any] | None
) -> Iterator[Check]:
    """Stored metrics against recomputed ones."""
    path = folder / "metrics.csv"
    if path.is_file():
        try:
            stored = read_metrics(path)
        except HistoryError as damaged:
            yield Check("metrics.csv", False, str(damaged))
            return
        found = {str(n): row for n, row in enumerate(rows)}
        yield _compare("metrics.csv", stored, found)
    if summary is not None:
        yield _compare("summary.json", *_comparable(history, summary, summarise(history)))


def _comparable(
    history: History, stored: dict[str, Any], found: dict[str, Any]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Both summaries, but for sentences and keys of another version of gyrify."""
    if history.versions.get("gyrify") == versions()["gyrify"] and stored.keys() >= LATER_KEYS:
        return stored, found
    left_out = {"warnings", *(LATER_KEYS - stored.keys())}
    return tuple({k: v for k, v in summary.items() if k not in left_out} for summary in (stored, found))  # type: ignore[return-value]


def _compare(name: str, stored: dict[str, Any], found: dict[str, Any]) -> Check:
    differing = list(_differences(stored, found, ""))
    if not differing:
        return Check(name, True, f"Equals what the states give, to {METRIC_BOUND:g}.", 0.0, METRIC_BOUND)
    more = f" and {len(differing) - 1} more" if len(differing) > 1 else ""
    return Check(name, False, f"Differs from what the states give: {differing[0]}{more}.")


def _differences(stored: Any, found: Any, place: str) -> Iterator[str]:
    """Names of the values that differ, tables opened."""
    if isinstance(stored, dict) and isinstance(found, dict):
        for key in sorted({*stored, *found}):
            inner = f"{place}.{key}" if place else str(key)
            yield from _differences(stored.get(key, "missing"), found.get(key, "missing"), inner)
    elif not _is_equal(stored, found):
        yield f"{shorten(place)} = {shorten(str(stored))}, not {shorten(str(found))}"


def _is_equal(stored: Any, found: Any) -> bool:
    """Equal as text (CSV holds nothing else), or as numbers up to rounding."""
    if stored == found or str(stored) == str(found) or (stored == "" and found is None):
        return True
    try:
        return math.isclose(float(stored), float(found), rel_tol=METRIC_BOUND, abs_tol=1e-12)
    except (TypeError, ValueError, OverflowError):
        return False
