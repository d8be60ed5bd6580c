"""Fields and values in plain words, for messages, tables and the documentation."""

from __future__ import annotations

import math
import types
import typing
from collections.abc import Iterable, Mapping
from typing import Any, Final

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from gyrify.config.registered import Registered

MAX_SHOWN: Final = 60


def shorten(text: str, length: int = MAX_SHOWN) -> str:
    """Return a text fit for one line: not too long (60 characters by default), nothing unprintable."""
    short = text if len(text) <= length else text[: length - 1] + "…"
    return short if short.isprintable() else repr(short)[1:-1]


def show(value: object) -> str:
    """Return a value as TOML would write it, shortened and free of control characters."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{shorten(value)}"'
    if isinstance(value, BaseModel):
        return "{" + ", ".join(f"{key} = {show(item)}" for key, item in value) + "}"
    if isinstance(value, Mapping):
        return "a table"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(show(item) for item in value[:3]) + (", …]" if len(value) > 3 else "]")
    if isinstance(value, int) and value.bit_length() > 128:
        return "a huge whole number"
    return shorten(repr(value)) if isinstance(value, int | float) else shorten(str(value))


def decimals(values: Iterable[float | None], usual: int) -> int:
    """Digits after the point that show numbers well, also those of a body much smaller than a brain.

    Parameters
    ----------
    values : iterable of float or None
        Numbers that are shown together.
    usual : int
        Digits for numbers of usual size.

    Returns
    -------
    int
        As many as are usual, or more where the largest number is below 0.1.
    """
    largest = max((abs(value) for value in values if value is not None and math.isfinite(value)), default=0.0)
    return usual if largest == 0.0 or largest >= 0.1 else usual - math.floor(math.log10(largest))


def extra(field: FieldInfo, name: str) -> str:
    """Return the unit or source a field was declared with."""
    declared = field.json_schema_extra
    return str(declared.get(name, "")) if isinstance(declared, dict) else ""


def bounds(field: FieldInfo) -> dict[str, float]:
    """Return the bounds of a field under the names gt, ge, lt, le."""
    inner = [item for kind in typing.get_args(field.annotation) for item in getattr(kind, "__metadata__", ())]
    constraints = [*field.metadata, *(c for item in inner for c in getattr(item, "metadata", ()))]
    names = ("gt", "ge", "lt", "le")
    return {name: getattr(c, name) for c in constraints for name in names if hasattr(c, name)}


def alternatives(field: FieldInfo) -> tuple[Any, ...]:
    """Return the types of a field, without annotations."""
    annotation = field.annotation
    union = typing.get_origin(annotation) in (typing.Union, types.UnionType)
    members = typing.get_args(annotation) if union else (annotation,)
    return tuple(m.__origin__ if typing.get_origin(m) is typing.Annotated else m for m in members)


def choices(field: FieldInfo) -> tuple[Any, ...]:
    """Return the words a field may take, also as items of a list."""
    words: list[Any] = []
    for kind in alternatives(field):
        item = typing.get_args(kind)[0] if typing.get_origin(kind) is tuple else kind
        words += typing.get_args(item) if typing.get_origin(item) is typing.Literal else ()
    for metadata in field.metadata:
        words += metadata.words() if isinstance(metadata, Registered) else ()
    return tuple(words)


def is_number(field: FieldInfo) -> bool:
    """Tell whether a field takes numbers."""
    return bool({int, float} & set(alternatives(field)))


def allowed(field: FieldInfo) -> str:
    """Say in words which values a field takes.

    Parameters
    ----------
    field : FieldInfo
        A field declared with `setting`.

    Returns
    -------
    str
        Such as ``"a number from 0.1 to 0.9"`` or ``'"linear" or "exponential"'``.
    """
    unit = f" [{extra(field, 'unit')}]" if extra(field, "unit") else ""
    kinds = alternatives(field)
    parts = ["true or false"] if bool in kinds else []
    if is_number(field):
        parts.append(f"a {'whole ' if int in kinds else ''}number{_range(bounds(field))}{unit}")
    if typing.get_origin(kinds[0]) is tuple and Ellipsis in typing.get_args(kinds[0]) and not choices(field):
        parts.append("a list of whole numbers")
    elif typing.get_origin(kinds[0]) is tuple and not choices(field):
        parts.append(f"a list of {len(typing.get_args(kinds[0]))} numbers{_range(bounds(field))}{unit}")
    words = [show(word) for word in choices(field)]
    if isinstance(kinds[0], type) and issubclass(kinds[0], BaseModel):
        parts.append(f"a table with {', '.join(kinds[0].model_fields)}")
    if str in kinds and not words:
        parts.append("text")
    if words:
        listed = ", ".join(words[:-1]) + " or " + words[-1] if len(words) > 1 else words[0]
        parts.append(f"a list of {listed}" if typing.get_origin(kinds[0]) is tuple else listed)
    return " or ".join(parts)


def _range(limits: Mapping[str, float]) -> str:
    """Return bounds in words, with a leading space."""
    shown = {name: f"{v:g}" if float(f"{v:g}") == v else repr(v) for name, v in limits.items()}
    if {"ge", "le"} <= shown.keys():
        return f" from {shown['ge']} to {shown['le']}"
    words = {"gt": "above", "ge": "at least", "lt": "below", "le": "at most"}
    return (" " if shown else "") + " and ".join(
        f"{words[name]} {shown[name]}" for name in words if name in shown
    )
