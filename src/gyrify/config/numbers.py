"""Numbers written as text: plain or as a fraction such as ``1/1.36``; parsed, never evaluated."""

from __future__ import annotations

import math
import re
from typing import Final

MAX_LENGTH: Final = 64
_DECIMAL: Final = r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
NUMBER_PATTERN: Final = rf"^\s*{_DECIMAL}\s*(?:/\s*{_DECIMAL}\s*)?$"


def parse_number(text: str) -> float:
    """Read a decimal number or a fraction of two decimal numbers.

    Parameters
    ----------
    text : str
        Such as ``"3.6"``, ``"1e-3"`` or ``"1/1.36"``; at most 64 characters.

    Returns
    -------
    float
        The value, always finite.

    Raises
    ------
    ValueError
        When the text is no such number, divides by zero or overflows.
    """
    if len(text) > MAX_LENGTH or not re.match(NUMBER_PATTERN, text, re.ASCII):
        raise ValueError('a number looks like 3.6, 1e-3 or "1/1.36"')
    numerator, _, denominator = text.partition("/")
    divisor = float(denominator) if denominator else 1.0
    if divisor == 0.0:
        raise ValueError("the fraction divides by zero")
    value = float(numerator) / divisor
    if not math.isfinite(value):
        raise ValueError("the number is too large")
    return value


def is_fraction(value: object) -> bool:
    """Tell whether a value is text that can only be meant as a fraction."""
    return isinstance(value, str) and "/" in value


def number_advice(text: str, unit: str = "") -> str:
    """Say how text that is almost a number is to be written; empty where it is not clear what is meant.

    Parameters
    ----------
    text : str
        What was written.
    unit : str, optional
        Unit in which the number is expected.
    """
    plain = text.strip()
    if len(plain) > MAX_LENGTH:
        return ""
    if re.fullmatch(r"[+-]?[0-9]+,[0-9]+", plain, re.ASCII):
        return f"Write a decimal point: {plain.replace(',', '.')}."
    found = re.fullmatch(rf"({_DECIMAL})\s*([^\W\d_]\S*|µ\S*)", plain)
    if found and unit and found[2] != unit:
        return f"Write the number alone, in {unit}."
    if found:
        return f"Write the number without its unit: {found[1]}."
    if re.match(NUMBER_PATTERN, plain, re.ASCII) and "/" not in plain:
        return "Write the number without quotes."
    return ""
