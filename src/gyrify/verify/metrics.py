"""Stored numbers of a run against those that its states give."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from gyrify.base.versions import versions
from gyrify.config.words import shorten
from gyrify.errors import HistoryError
from gyrify.run.measuring import earlier_rows, point_extremes
from gyrify.run.summary import earlier_summary, summarise
from gyrify.store.derived import read_metrics
from gyrify.store.history import History
from gyrify.verify.verification import Check

# Largest relative difference between a stored and a recomputed metric.
METRIC_BOUND: Final = 1e-9
# Largest difference of what is zero but for rounding; of lengths, in a body as large as the standard slice.
ROUNDING: Final = 1e-12
# Keys of a summary that older versions did not write (a dot: inside of a table).
LATER_KEYS: Final = frozenset(
    {
        "warnings",
        "expected",
        "converged",
        "stability_changes",
        "visible_growth_time",
        "relaxed",
        "parameters",
        "units",
        "onset.kind",
        "onset.visible_delay",
        "solver.contact_library",
    }
)
# Sentences that they worded otherwise.
WORDED: Final = frozenset({"warnings", "stability_note"})


def check_metrics(
    history: History, folder: Path, rows: list[dict[str, Any]], summary: dict[str, Any] | None
) -> Iterator[Check]:
    """Stored metrics against recomputed ones."""
    path, scale = folder / "metrics.csv", history.config.geometry.scale
    if path.is_file():
        try:
            stored = read_metrics(path)
        except HistoryError as damaged:
            yield Check("metrics.csv", False, str(damaged))
            return
        check = _compare("metrics.csv", stored, _numbered(history, stored, rows), scale)
        if not check.passed:
            earlier = _numbered(history, stored, earlier_rows(history))
            check = _by_earlier_rules(check, stored, earlier, scale)
        yield check
    if summary is not None:
        found = _with_stored_volumes(history, -1, summary, summarise(history))
        check = _compare("summary.json", *_comparable(history, summary, found), scale)
        if not check.passed:
            earlier = _with_stored_volumes(history, -1, summary, earlier_summary(history))
            earlier["warnings"] = summary.get("warnings")
            check = _by_earlier_rules(check, *_comparable(history, summary, earlier), scale)
        yield check


def _numbered(history: History, stored: dict[str, Any], rows: list[dict[str, Any]]) -> dict[str, Any]:
    return {str(n): _with_stored_volumes(history, n, stored.get(str(n)), row) for n, row in enumerate(rows)}


def _with_stored_volumes(history: History, index: int, stored: Any, found: dict[str, Any]) -> dict[str, Any]:
    """Recomputed numbers of a state, with the smallest J of the integration points where that was stored.

    Earlier versions knew no other.
    """
    names = ("min_J", "min_J_elastic")
    if history.slice.simplices.curved is None or not isinstance(stored, dict):
        return found
    for extremes in (tuple(found[name] for name in names), point_extremes(history, index)):
        if all(_is_equal(stored.get(name), J, ROUNDING) for name, J in zip(names, extremes, strict=True)):
            return {**found, **dict(zip(names, extremes, strict=True))}
    return found


def _by_earlier_rules(check: Check, stored: Any, found: Any, scale: float) -> Check:
    """A failed check, unless the numbers are those of the rules of measuring of the time."""
    earlier = _compare(check.name, stored, found, scale)
    if not earlier.passed:
        return check
    text = (
        "Equals what the states give by the earlier rules of measuring: bumps without sulci count as gyri, "
        "and GI closing may exceed GI hull. `gyrify export --format metrics` measures again."
    )
    return replace(earlier, sentence=text)


def _comparable(
    history: History, stored: dict[str, Any], found: dict[str, Any]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Both summaries, but for sentences and keys of another version of gyrify."""
    later = {key for key in LATER_KEYS if _lacks(stored, key)}
    if history.versions.get("gyrify") == versions()["gyrify"] and not later:
        return stored, found
    left_out = later | WORDED
    return _without(stored, left_out), _without(found, left_out)


def _lacks(table: dict[str, Any], key: str) -> bool:
    """Whether a key is missing in a table, or in a table inside of it that is there."""
    outer, _, inner = key.partition(".")
    if not inner:
        return outer not in table
    return isinstance(table.get(outer), dict) and inner not in table[outer]


def _without(table: dict[str, Any], keys: set[str], place: str = "") -> dict[str, Any]:
    """The table, and those inside of it, but for some keys."""
    return {
        name: _without(value, keys, f"{place}{name}.") if isinstance(value, dict) else value
        for name, value in table.items()
        if f"{place}{name}" not in keys
    }


def _compare(name: str, stored: dict[str, Any], found: dict[str, Any], scale: float) -> Check:
    """Both tables; ``scale`` is the size of the body over that of the standard slice."""
    differing = list(_differences(stored, found, "", scale))
    if not differing:
        return Check(name, True, f"Equals what the states give, to {METRIC_BOUND:g}.", 0.0, METRIC_BOUND)
    more = f" and {len(differing) - 1} more" if len(differing) > 1 else ""
    return Check(name, False, f"Differs from what the states give: {differing[0]}{more}.")


def _differences(stored: Any, found: Any, place: str, scale: float) -> Iterator[str]:
    """Names of the values that differ, tables opened."""
    if isinstance(stored, dict) and isinstance(found, dict):
        for key in sorted({*stored, *found}):
            inner = f"{place}.{key}" if place else str(key)
            yield from _differences(stored.get(key, "missing"), found.get(key, "missing"), inner, scale)
    elif not _is_equal(stored, found, ROUNDING * (scale if "_mm" in place else 1.0)):
        yield f"{shorten(place)} = {shorten(str(stored))}, not {shorten(str(found))}"


def _is_equal(stored: Any, found: Any, rounding: float) -> bool:
    """Equal as text (CSV holds nothing else), or as numbers up to rounding."""
    if stored == found or str(stored) == str(found) or (stored == "" and found is None):
        return True
    try:
        return math.isclose(float(stored), float(found), rel_tol=METRIC_BOUND, abs_tol=rounding)
    except (TypeError, ValueError, OverflowError):
        return False
