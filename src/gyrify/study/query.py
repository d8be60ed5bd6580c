"""Questions to the results of a study, in SQL, without a way to files or to anything else."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from gyrify.config.faults import nearest
from gyrify.config.words import shorten
from gyrify.errors import ConfigError
from gyrify.study.results import read_results

if TYPE_CHECKING:
    from pyarrow import Table

_QUOTED: Final = re.compile(r"""('(?:[^']|'')*'|"(?:[^"]|"")*")""")
_COLUMNS: Final = "`gyrify table DIR --csv --limit 0` lists all columns."
# What DuckDB says, and what that means for who wrote the expression; {0} is what stands in brackets.
_REASONS: Final = (
    (r'Referenced (?:column|table) "(.*?)" not found', 'there is no column "{0}"'),
    (r'syntax error at or near "(.*?)"', 'it cannot be read at "{0}"'),
    (r"syntax error at end of input", "it ends too early"),
    (r"unterminated", "a quotation mark is missing at its end"),
    (r"Could not convert string '(.*?)' to (\w+)", "'{0}' is not {1}"),
    (r"Function with name (\S+) does not exist", 'there is no function "{0}"'),
    (r'Function "(.*?)" is a table function', 'the function "{0}" is not allowed'),
    (r"Table with name (\S+) does not exist", 'there is no table "{0}"'),
    (r"Type with name (\S+) does not exist", 'there is no type "{0}"'),
    (r"argument types '(\S+?)\(", '"{0}" cannot join these columns, such as a word and a number'),
    (r"GROUP BY|aggregate", "sums and counts over several rows are not possible here"),
    (r"modifiers", "it must be one expression"),
    (r"external access|disabled", "it may not read files"),
)
_ALIKE: Final = 0.75
_KINDS: Final = {
    "BOOL": "true or false",
    **dict.fromkeys(("DOUBLE", "FLOAT", "INT32", "INT64", "BIGINT", "INTEGER"), "a number"),
}
_SETTINGS: Final = {
    "enable_external_access": "false",
    "autoinstall_known_extensions": "false",
    "autoload_known_extensions": "false",
    "python_enable_replacements": "false",
    "threads": "1",
    "lock_configuration": "true",
}


def query_results(
    folder: str | Path, where: str = "", columns: str = "", sort: str = "", limit: int | None = None
) -> Table:
    """Rows of a study's results.

    Parameters
    ----------
    folder : path
        Study folder.
    where : str
        Which rows, as an SQL condition; dotted columns need no quotes: ``growth.ratio > 2``.
    columns : str
        Which columns, separated by commas, as SQL expressions; all by default.
    sort : str
        How rows are ordered, such as ``gi_closing desc``; as in the design by default.
    limit : int, optional
        Most rows.

    Returns
    -------
    pyarrow.Table

    Raises
    ------
    ConfigError
        If an expression is wrong.
    HistoryError
        If the folder holds no results.
    """
    import duckdb

    table = read_results(folder)
    names = table.column_names
    with duckdb.connect(":memory:") as connection:
        rows = connection.from_arrow(table)
        for setting, value in _SETTINGS.items():
            connection.execute(f"SET {setting} = {value}")
        if where.strip():
            rows = _understood("--where", where, names, rows.filter)
        if sort.strip():
            rows = _understood("--sort", sort, names, rows.order)
        if columns.strip():
            rows = _understood("--columns", columns, names, rows.project)
        chosen = rows if limit is None else rows.limit(limit)
        asked = " ".join(filter(None, (where, sort, columns)))
        return _understood("The expression", asked, names, lambda _: chosen.to_arrow_table())


def _understood(option: str, text: str, names: Sequence[str], step: Callable[[str], Any]) -> Any:
    """Take a step with an expression, or say in plain words what is wrong with it."""
    import duckdb

    try:
        return step(quoted(text, names))
    except (duckdb.Error, RuntimeError) as fault:
        reason = _reason(str(fault), text)
        what = f"{option} {shorten(text, 120)!r} is not understood: {reason}."
        raise ConfigError(what, _advice(text, names, str(fault))) from fault


def _reason(message: str, text: str) -> str:
    """What is wrong with an expression, in our own words; DuckDB speaks of its inner tables and types."""
    for pattern, reason in _REASONS:
        if found := re.search(pattern, message):
            groups = [_KINDS.get(group, shorten(group)) for group in found.groups()]
            if "Referenced table" in message:  # a dotted name is read as that of a table
                dotted = re.search(rf"\b{re.escape(found[1])}\.\w+", text)
                groups = [shorten(dotted[0])] if dotted else groups
            return reason.format(*groups)
    return "it cannot be evaluated"


def _advice(text: str, names: Sequence[str], message: str) -> str:
    """The column that was meant, where one is not known; quotes where a word lacks them."""
    plain = "".join(_QUOTED.split(text)[::2])
    if "not found" in message:
        for word in re.findall(r"[A-Za-z_][\w.]*", plain):
            compared = re.search(rf"[=<>]\s*{re.escape(word)}(?![\w.])", plain)
            if word not in names and compared and not get_close_matches(word, names, 1, _ALIKE):
                return f"Put a word that is a value in single quotes: '{word}'. {_COLUMNS}"
            if word not in names and (close := nearest(word, names)):
                return f"Did you mean {close}? {_COLUMNS}"
    return f"An example: \"growth.ratio > 2 and status = 'completed'\". {_COLUMNS}"


def quoted(text: str, names: Iterable[str]) -> str:
    """Put dotted column names in double quotes, outside of what is quoted already.

    Parameters
    ----------
    text : str
        An SQL expression.
    names : iterable of str
        Column names.

    Returns
    -------
    str
    """
    dotted = sorted((name for name in names if "." in name), key=len, reverse=True)
    if not dotted:
        return text
    pattern = re.compile(rf"(?<![\w.])({'|'.join(map(re.escape, dotted))})(?![\w.(])", re.IGNORECASE)
    pieces = _QUOTED.split(text)
    return "".join(piece if i % 2 else pattern.sub(r'"\1"', piece) for i, piece in enumerate(pieces))
