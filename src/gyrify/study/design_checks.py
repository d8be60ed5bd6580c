"""What the checks of a study file have in common."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from gyrify.config.faults import nearest
from gyrify.config.words import shorten, show
from gyrify.errors import ConfigError


def require_known(table: Mapping[str, Any], known: Iterable[str], where: str) -> None:
    """Refuse a key that a table does not have.

    Raises
    ------
    ConfigError
        With the nearest key.
    """
    for key in table:
        if key not in known:
            close = nearest(str(key), known)
            hint = f"Did you mean {close}?" if close else f"Known: {', '.join(known)}."
            raise ConfigError(f"{shorten(str(key))} is not a known key of {where}.", hint)


def whole_number(value: object, name: str, low: int, high: int) -> int:
    """Return a whole number within bounds.

    Raises
    ------
    ConfigError
        If it is none.
    """
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise ConfigError(
            f"{name} = {show(value)} is not allowed: it must be a whole number from {low} to {high}.",
            f"Try {max(low, 1)}.",
        )
    return value
