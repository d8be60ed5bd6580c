"""Questions to the results of a study, in SQL, without a way to files or to anything else."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from gyrify.config.faults import nearest
from gyrify.config.words import shorten
from gyrify.errors import ConfigError
from gyrify.study.results import read_results

if TYPE_CHECKING:
    from pyarrow import Table

_QUOTED: Final = re.compile(r"""('(?:[^']|'')*'|"(?:[^"]|"")*")""")
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
        return _understood("Of the rows,", asked, names, lambda _: chosen.to_arrow_table())


def _understood(option: str, text: str, names: Sequence[str], step: Callable[[str], Any]) -> Any:
    """Take a step with an expression, or say in plain words what is wrong with it."""
    import duckdb

    try:
        return step(quoted(text, names))
    except (duckdb.Error, RuntimeError) as fault:
        what = f"{option} {shorten(text, 120)!r} is not understood: {_plain(str(fault))}"
        raise ConfigError(what, _advice(text, names, "not found" in str(fault))) from fault


def _advice(text: str, names: Sequence[str], is_unknown: bool) -> str:
    """The column that was meant, where one is not known."""
    plain = "".join(_QUOTED.split(text)[::2])
    for word in re.findall(r"[A-Za-z_][\w.]*", plain) if is_unknown else ():
        if word not in names and (close := nearest(word, names)):
            return f"Did you mean {close}? `gyrify table DIR --csv --limit 0` lists all columns."
    return "Write conditions as in SQL; `gyrify table DIR --csv --limit 0` lists all columns."


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


def _plain(message: str) -> str:
    """First sentence of what DuckDB says, without its drawing of the place."""
    lines = [line.strip() for line in message.splitlines() if line.strip()]
    text = " ".join(line for line in lines if not line.startswith(("LINE", "^"))).split(" Candidate")[0]
    return text[:240] + ("" if text[:240].endswith(".") else ".")
