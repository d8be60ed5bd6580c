"""A configuration as rows: for terminals, notebooks and the documentation."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import Any

from pydantic.fields import FieldInfo

from gyrify.config.faults import sections
from gyrify.config.model import Config
from gyrify.config.words import allowed, extra


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
    """

    key: str
    value: Any
    default: Any
    unit: str
    allowed: str
    doc: str
    source: str


def rows(config: Config) -> list[Row]:
    """Return one row for each setting, in the order of the file format."""
    found = [_row("", name, config, Config.model_fields[name]) for name in Config.top_level()]
    for section, kind in sections(Config).items():
        group = getattr(config, section)
        found += [_row(f"{section}.", name, group, field) for name, field in kind.model_fields.items()]
    return found


def _row(prefix: str, name: str, group: object, field: FieldInfo) -> Row:
    value = getattr(group, name)
    published = value == getattr(type(group)(), name)
    return Row(
        prefix + name,
        value,
        field.default,
        extra(field, "unit"),
        allowed(field),
        field.description or "",
        extra(field, "source") if published else "",
    )


def plain(value: object) -> str:
    """Return a value for people: words without quotes, lists with commas."""
    if isinstance(value, list | tuple):
        return ", ".join(plain(item) for item in value)
    return str(value).lower() if isinstance(value, bool) else str(value)


def html_table(config: Config) -> str:
    """Return a table with field, value, unit and doc line, everything escaped."""
    head = "<tr><th>field</th><th>value</th><th>unit</th><th>what it is</th></tr>"
    cells = ((row.key, plain(row.value), row.unit, row.doc) for row in rows(config))
    body = "".join("<tr>" + "".join(f"<td>{escape(text)}</td>" for text in line) + "</tr>" for line in cells)
    return f"<table><caption>Config {config.config_hash[:12]}</caption>{head}{body}</table>"
