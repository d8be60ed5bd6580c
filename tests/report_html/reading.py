"""Reading what a page says and shows."""

from __future__ import annotations

import re

import numpy as np

NUMBER = r"([−\d.]+(?: × 10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?)"


def number(text: str) -> float:
    """A number as the page writes it."""
    stem, _, power = text.replace("−", "-").partition(" × 10")
    digits = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
    return float(stem) * 10.0 ** int(power.translate(digits) or 0)


def changed(before: np.ndarray, after: np.ndarray) -> float:
    """Part of the pixels that differ by more than a rounding."""
    return float((np.abs(before - after).max(axis=2) > 8).mean())


def check_value(tip: str, stored: float, spread: float, precision: float = 2e-5) -> None:
    """The first line is the stored value within what the last line says, and that is little of the spread."""
    shown = number(re.match(NUMBER, tip).group(1))
    error = number(re.search(f"shown to ± {NUMBER}", tip).group(1))
    assert abs(shown - stored) <= 1.06 * error  # the error itself is written with two digits
    assert error <= precision * max(spread, abs(stored))
