"""A configuration as rows: for terminals, notebooks and the documentation."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from gyrify.config.faults import sections
from gyrify.config.words import allowed, extra, show

if TYPE_CHECKING:
    from gyrify.config.settings import Config


@dataclass(frozen=True)
class Row:
    """One setting, in words.

    Attributes
    ----------
    key : str
        Dotted name.
    value : object
        The value in the configuration at hand.
    default : object
        The default; None where it follows another field.
    unit, allowed, doc : str
        Unit, range and one line of documentation.
    source : str
        Where the value was published; empty when it is not the published one.
    follows : str
        What the value is when it is not given, in words; empty where the default is a number or a word.
    is_given : bool
        Whether the value was stated, rather than left to its default.
    is_changed : bool
        Whether the value differs from what it is when it is not given.
    """

    key: str
    value: Any
    default: Any
    unit: str
    allowed: str
    doc: str
    source: str
    follows: str
    is_given: bool
    is_changed: bool

    @property
    def origin(self) -> str:
        """Where the value comes from: a publication, or other values that it follows."""
        return self.source or ("" if self.is_given else self.follows)


def rows(config: Config) -> list[Row]:
    """Return one row for each setting, in the order of the file format."""
    followed = config.replace(**dict.fromkeys(_followers(config)))
    found = [_row("", name, config, followed, type(config).model_fields[name]) for name in config.top_level()]
    for section, kind in sections(type(config)).items():
        groups = getattr(config, section), getattr(followed, section)
        found += [_row(f"{section}.", name, *groups, field) for name, field in kind.model_fields.items()]
    return found


def _followers(config: Config) -> list[str]:
    """Dotted keys whose value follows others when it is not given."""
    return [
        f"{section}.{name}"
        for section, kind in sections(type(config)).items()
        for name, field in kind.model_fields.items()
        if field.default is None
    ]


def _row(prefix: str, name: str, group: BaseModel, followed: BaseModel, field: FieldInfo) -> Row:
    value = getattr(group, name)
    unset = getattr(followed, name) if field.default is None else field.default
    published = value == getattr(type(group)(), name)
    return Row(
        prefix + name,
        value,
        field.default,
        extra(field, "unit"),
        allowed(field),
        field.description or "",
        extra(field, "source") if published else "",
        extra(field, "follows"),
        name in group.model_fields_set,
        value != unset,
    )


def plain(value: object) -> str:
    """Return a value for people: words without quotes, lists with commas."""
    if isinstance(value, BaseModel):
        return show(value)
    if isinstance(value, list | tuple):
        return ", ".join(plain(item) for item in value)
    return str(value).lower() if isinstance(value, bool) else str(value)


def html_table(config: Config) -> str:
    """Return a table with field, value, unit and doc line, everything escaped."""
    head = "<tr><th>field</th><th>value</th><th>unit</th><th>what it is</th></tr>"
    cells = ((row.key, plain(row.value), row.unit, row.doc) for row in rows(config))
    body = "".join("<tr>" + "".join(f"<td>{escape(text)}</td>" for text in line) + "</tr>" for line in cells)
    return f"<table><caption>Config {config.config_hash[:12]}</caption>{head}{body}</table>"
