"""Faults of a configuration: field, value, what is allowed and what to try, in one ConfigError."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from gyrify.config.numbers import is_fraction, number_advice, parse_number
from gyrify.config.words import allowed, choices, extra, is_number, shorten, show
from gyrify.errors import ConfigError

MAX_FAULTS: Final = 10
# What users write for a key, as letters alone.
_OTHER_NAMES: Final = {
    "thickness": "geometry.cortical_thickness",
    "corticalthickness": "geometry.cortical_thickness",
    "stiffness": "material.stiffness_ratio",
    "time": "growth.duration",
    "growthtime": "growth.duration",
    "ratio": "growth.ratio",
    "walltime": "limits.wall_time",
}


def nearest(word: str, known: Iterable[str]) -> str:
    """Return the known word that is closest to a word, or an empty text."""
    matches = difflib.get_close_matches(word[:64], list(known), n=1, cutoff=0.5)
    return matches[0] if matches else ""


def raise_faults(faults: Sequence[str]) -> None:
    """Raise one ConfigError that lists the faults, one a line; do nothing when there are none."""
    if faults:
        more = len(faults) - MAX_FAULTS
        listed = [*faults[:MAX_FAULTS], *([f"… and {more} more."] if more > 0 else [])]
        raise ConfigError("\n".join(listed))


def config_error(model: type[BaseModel], errors: Iterable[Mapping[str, Any]]) -> ConfigError:
    """Turn what validation found into one error in plain words.

    Parameters
    ----------
    model : type
        The section or configuration that was validated.
    errors : iterable of mapping
        Each with ``type``, ``loc`` and ``input``, as pydantic lists them.

    Returns
    -------
    ConfigError
        One line for each field at fault.
    """
    faults: dict[str, str] = {}
    for error in errors:
        path = [str(part) for part in error["loc"][:3]]
        owner, field, depth = _locate(model, path)
        name = ".".join(path[:depth])
        if name not in faults and len(faults) <= MAX_FAULTS:
            faults[name] = _sentence(model, owner, name, field, error["input"])
    try:
        raise_faults(list(faults.values()))
    except ConfigError as error:
        return error
    return ConfigError("The configuration is not valid.")


def sections(model: type[BaseModel]) -> dict[str, type[BaseModel]]:
    """Return the fields of a model that are models themselves."""
    kinds = {name: field.annotation for name, field in model.model_fields.items()}
    return {
        name: kind for name, kind in kinds.items() if isinstance(kind, type) and issubclass(kind, BaseModel)
    }


def unknown_key(model: type[BaseModel], owner: type[BaseModel], name: str) -> str:
    """Say that a key does not exist and which one is nearest.

    Parameters
    ----------
    model : type
        The whole configuration (or the section, where one is built by itself).
    owner : type
        The section, or the configuration, that lacks the key.
    name : str
        The dotted key.

    Returns
    -------
    str
        One or two sentences.
    """
    suggestion = suggested_key(model, owner, name)
    hint = f"Did you mean {suggestion}?" if suggestion else f"Known: {', '.join(owner.model_fields)}."
    return f"{shorten(name)} is not a known key. {hint}"


def suggested_key(model: type[BaseModel], owner: type[BaseModel], name: str) -> str:
    """Dotted key that is most likely meant, or an empty text.

    The same letters come first (``Growth.Ratio``, ``growth_ratio``), then the same key in another section,
    then a whole word of a key (``thickness``), and last what is written alike.
    """
    prefix, _, key = name[:120].rpartition(".")
    known = [
        *(field for field in model.model_fields if field not in sections(model)),
        *(f"{name}.{field}" for name, kind in sections(model).items() for field in kind.model_fields),
    ]
    own = [f"{prefix}.{field}" if prefix else field for field in owner.model_fields]
    if _letters(name) in _OTHER_NAMES and _OTHER_NAMES[_letters(name)] in known:
        return _OTHER_NAMES[_letters(name)]
    for candidates in ([*own, *known], known):
        same = [it for it in candidates if _letters(it) == _letters(name)]
        if same:
            return same[0]
    last = [it for it in known if _letters(it.rpartition(".")[2]) == _letters(key)]
    close = nearest(key.lower(), owner.model_fields)
    words = [it for it in known if len(key) > 4 and key.lower() in it.rpartition(".")[2].split("_")]
    if last or words:
        return (last or words)[0]
    if close:
        return f"{shorten(prefix)}.{close}" if prefix else close
    ends = {it.rpartition(".")[2]: it for it in known}
    return ends.get(nearest(key.lower(), ends), "")


def _letters(name: str) -> str:
    """A key without what separates its words."""
    return re.sub(r"[^a-z0-9]", "", name.lower())


def _locate(model: type[BaseModel], path: Sequence[str]) -> tuple[type[BaseModel], FieldInfo | None, int]:
    """Return the model that owns the last key of a path, its field if it has one, and the key's depth."""
    owner, depth = model, 1
    while len(path) > depth and (inner := sections(owner).get(path[depth - 1])) is not None:
        owner, depth = inner, depth + 1
    return owner, owner.model_fields.get(path[depth - 1]) if path else None, depth


def _sentence(
    model: type[BaseModel], owner: type[BaseModel], name: str, field: FieldInfo | None, value: object
) -> str:
    if field is None:
        return unknown_key(model, owner, name)
    if name in sections(owner):
        return (
            f"{name} = {show(value)} is not allowed: it must be a table. Write [{name}] with its keys below."
        )
    return f"{name} = {show(value)} is not allowed: it must be {allowed(field)}. {_advice(field, value)}"


def _advice(field: FieldInfo, value: object) -> str:
    """Say what to try instead of a value."""
    if is_number(field) and is_fraction(value):
        try:
            parse_number(str(value))
        except ValueError as reason:
            return f"Check the fraction: {reason}."
    if is_number(field) and isinstance(value, str) and value not in choices(field):
        return number_advice(value, extra(field, "unit")) or _default(field)
    words = [word for word in choices(field) if isinstance(word, str)]
    close = nearest(value.lower(), words) if isinstance(value, str) else ""
    return f'Did you mean "{close}"?' if close else _default(field)


def _default(field: FieldInfo) -> str:
    if field.default is None:
        return f"Leave it out to take {extra(field, 'follows')}."
    return f"The default is {show(field.default)}."
