"""Values of options that several commands share."""

from __future__ import annotations

import os

from gyrify.errors import ConfigError


def number(option: str, text: str, example: str = "") -> float:
    """Number that an option was given, which may be a fraction.

    Raises
    ------
    ConfigError
        If it is not a number.
    """
    from gyrify.config.numbers import number_advice, parse_number
    from gyrify.config.words import shorten

    try:
        return parse_number(text)
    except ValueError as fault:
        advice = number_advice(text) or (f"Try {example}." if example else "Give a number.")
        raise ConfigError(f"{option} {shorten(text)!r} is not a number: {fault}.", advice) from fault


def cores(workers: int | None) -> int:
    """Processes that were asked for; by default the cores that this process may use."""
    if workers is not None:
        return workers
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
