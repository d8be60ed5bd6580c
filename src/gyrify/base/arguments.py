"""What callers pass: NumPy scalars and arrays become plain Python values, or are refused by name.

No NumPy is loaded for it: its scalars, its arrays and those of like libraries know how to become plain.
"""

from __future__ import annotations

import math
import operator
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from gyrify.errors import ConfigError

Pathlike = str | os.PathLike[str]
_SHOWN = 60


def native(value: object) -> object:
    """Return plain Python values in place of NumPy scalars and arrays, in tables and lists too.

    Parameters
    ----------
    value : object
        Anything; what is plain already is returned as it is.

    Returns
    -------
    object
        A scalar or an array with one entry and no axis becomes a number, any other array a list.
    """
    if isinstance(value, Mapping):
        return {key: native(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return type(value)(map(native, value)) if type(value) in (list, tuple) else value
    plain = getattr(value, "tolist", None)
    return plain() if callable(plain) else value


def plain_tables(tables: Mapping[str, Any]) -> dict[str, Any]:
    """Return nested tables with plain Python values."""
    return {str(key): native(value) for key, value in tables.items()}


def real_number(name: str, value: object) -> float:
    """Return one number as a float; a text, a truth value or several numbers are refused.

    Parameters
    ----------
    name : str
        What to call it in the message.
    value : object
        Number, NumPy scalar, or array without axes.

    Raises
    ------
    ConfigError
        If it is none. Infinity and NaN are numbers.
    """
    found = native(value)
    if isinstance(found, bool) or not isinstance(found, int | float):
        raise ConfigError(f"{name} = {_shown(value)} is not a number.", f"Give {name} as one number.")
    return float(found)


def whole_number(name: str, value: object, low: int | None = None, high: int | None = None) -> int:
    """Return one whole number as an int.

    Parameters
    ----------
    name : str
        What to call it in the message.
    value : object
        Whole number, NumPy integer, or array of one without axes.
    low, high : int, optional
        What is allowed.

    Raises
    ------
    ConfigError
        If it is no whole number, or out of range.
    """
    allowed = {
        (False, False): "",
        (True, False): f" of {low} or more",
        (False, True): f" of {high} or less",
        (True, True): f" from {low} to {high}",
    }[low is not None, high is not None]
    found = index_of(value)
    if found is None:
        raise ConfigError(
            f"{name} = {_shown(value)} is not a whole number.", f"Give {name} as a whole number{allowed}."
        )
    if found < (-math.inf if low is None else low) or found > (math.inf if high is None else high):
        raise ConfigError(f"{name} = {found} is out of range.", f"Give {name} as a whole number{allowed}.")
    return found


def index_of(value: object) -> int | None:
    """Return a whole number as an int; None for anything else, truth values and 2.0 among it."""
    if isinstance(native(value), bool):
        return None
    try:
        return operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        return None


def as_path(name: str, value: object) -> Path:
    """Return a path given as text or as any kind of path.

    Raises
    ------
    ConfigError
        If it is none.
    """
    if not isinstance(value, str | bytes | os.PathLike) or not value:
        raise ConfigError(f"{name} = {_shown(value)} is not a path.", f"Give {name} as text or as a Path.")
    return Path(os.fsdecode(value))


def as_words(name: str, value: object) -> tuple[str, ...]:
    """Return one word, or several in a list or an array, as a tuple.

    Raises
    ------
    ConfigError
        If something else is among them.
    """
    found = native(value)
    if isinstance(found, str):
        return (str(found),)
    words = tuple(found) if isinstance(found, Iterable) else (found,)
    if not all(isinstance(word, str) for word in words):
        raise ConfigError(f"{name} = {_shown(value)} is not a list of words.", f"Give {name} as words.")
    return words


def _shown(value: object) -> str:
    text = " ".join(repr(value).split())
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…"
