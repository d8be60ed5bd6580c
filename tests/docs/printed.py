"""Compares what a page says is printed with what is printed, and samples of files with real ones."""

from __future__ import annotations

import csv
import io
import re
from typing import Any

# A number of its own, not a part of a word or a hash.
_NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[+-]?\d+)?(?![\w])")
_SECONDS = re.compile(r"(?<![\w.])\d+(?:\.\d+)? s\b")
# Rounding differs between processors, and a folded state amplifies it.
RELATIVE = 0.005
# Keys of a JSON document whose numbers are anybody's.
TIMES = ("wall_s", "bytes")
ELLIPSIS = ("…", "...")


def missing_lines(shown: str, printed: str) -> list[str]:
    """Lines of a page that were not printed, in their order; an ellipsis stands for any lines.

    Parameters
    ----------
    shown : str
        The block of the page.
    printed : str
        What its command printed.

    Returns
    -------
    list of str
        Lines that have no like among those printed after the one before it.
    """
    lines, missing = printed.splitlines(), []
    for line in shown.splitlines():
        if not line.strip() or line.strip() in ELLIPSIS:
            continue
        place = next((i for i, candidate in enumerate(lines) if _alike(line, candidate)), None)
        if place is None:
            missing.append(line)
        else:
            lines = lines[place + 1 :]
    return missing


def _alike(shown: str, printed: str) -> bool:
    """Same words, and numbers equal but for rounding; times in seconds are anybody's."""
    shown, printed = (_SECONDS.sub("some s", " ".join(text.split())) for text in (shown, printed))
    if _NUMBER.sub("#", shown) != _NUMBER.sub("#", printed):
        return False
    pairs = zip(_NUMBER.findall(shown), _NUMBER.findall(printed), strict=True)
    return all(_close(a, b) for a, b in pairs)


def _close(a: str, b: str) -> bool:
    digits = len(a.partition(".")[2].partition("e")[0]) if "e" not in a else 0
    last = 10.0**-digits if "e" not in a and ("." in a or abs(float(a)) > 12) else 0.0
    return abs(float(a) - float(b)) <= max(RELATIVE * abs(float(b)), last)


def unknown_keys(sample: Any, real: Any, place: str = "") -> list[str]:
    """Keys of a JSON sample that the real document has not, or has with another type or value."""
    if isinstance(sample, dict) and isinstance(real, dict):
        absent = [f"{place}.{key}" for key in sample if key not in real]
        return absent + [
            fault
            for key in sample.keys() & real.keys()
            for fault in unknown_keys(sample[key], real[key], f"{place}.{key}")
        ]
    if isinstance(sample, list) and isinstance(real, list):
        return (
            [fault for item in sample for fault in unknown_keys(item, real[0], f"{place}[]")] if real else []
        )
    numbers = isinstance(sample, int | float) and isinstance(real, int | float)
    if numbers and not isinstance(sample, bool) and not _close(repr(sample), repr(real)):
        return [f"{place} = {sample}, not {real}"] if place.rpartition(".")[2] not in TIMES else []
    alike = numbers or type(sample) is type(real) or sample is None or real is None
    return [] if alike else [f"{place} is {type(real).__name__}"]


def unknown_columns(sample: str, real: str) -> list[str]:
    """Columns of a CSV sample that the real file has not."""
    shown, found = (next(csv.reader(io.StringIO(text))) for text in (sample, real))
    return [name for name in shown if name not in (*found, *ELLIPSIS)]
