"""``gyrify table``: rows of a study's results, chosen, sorted, and written as text, CSV or JSON."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from gyrify.cli.streams import print_json, say
from gyrify.errors import ConfigError

if TYPE_CHECKING:
    from pyarrow import Table

Expression = Annotated[str, Parameter(allow_leading_hyphen=True)]
_PLAIN_WIDTH = 240


def table(
    folder: Annotated[Path, Parameter(name="DIR", help="Study folder.")],
    /,
    *,
    where: Expression = "",
    columns: Expression = "",
    sort: Expression = "",
    limit: int | None = None,
    csv: bool = False,
    json: bool = False,
    quiet: bool = False,  # noqa: ARG001 - for uniformity
) -> None:
    """Show the results of a study, one row per run.

    Parameters
    ----------
    where : str
        Which rows, as an SQL condition: "growth.ratio > 2 and status = 'completed'".
    columns : str
        Which columns, separated by commas: "growth.ratio, gi_closing".
    sort : str
        How rows are ordered: "gi_closing desc".
    limit : int, optional
        Most rows.
    csv : bool
        Print CSV; all columns unless some are named.
    json : bool
        Print one JSON document; all columns unless some are named.
    quiet : bool
        Show no progress.
    """
    from gyrify.study.query import query_results

    if csv and json:
        raise ConfigError("Both --csv and --json are given.", "Give one of them.")
    if limit is not None and limit < 0:
        raise ConfigError(f"--limit {limit} is out of range (0 or more).", "Try 10.")
    rows = query_results(folder, where, columns, sort, limit)
    if json:
        print_json({"columns": rows.column_names, "rows": _finite(rows.to_pylist())})
    elif csv:
        _print_csv(rows)
    else:
        _print_table(rows if columns.strip() else _brief(rows))
        say(f"{rows.num_rows} runs{_warned(rows)}")


def _print_csv(rows: Table) -> None:
    import csv

    writer = csv.writer(sys.stdout, lineterminator="\n")
    writer.writerow(rows.column_names)
    writer.writerows(zip(*(column.to_pylist() for column in rows.columns), strict=True))


def _brief(rows: Table) -> Table:
    """Key, status, what is varied, and the first things to look at."""
    from gyrify.metrics.quantities import shown_in
    from gyrify.study.results import dimensions

    varied = [name for name in rows.column_names if "." in name or name == "seed"]
    shown = (quantity.key for n_dim in dimensions(rows) for quantity in shown_in("table", n_dim))
    wanted = dict.fromkeys(["key", "status", *varied, "phenotype", *shown])
    return rows.select([name for name in wanted if name in rows.column_names])


def _print_table(rows: Table) -> None:
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table as Grid

    width = None if sys.stdout.isatty() else int(os.environ.get("COLUMNS", _PLAIN_WIDTH))
    console, grid = Console(width=width), Grid(box=None, pad_edge=False)
    for name in rows.column_names:
        is_text = str(rows.schema.field(name).type) == "string"
        grid.add_column(escape(name), justify="left" if is_text else "right", overflow="fold")
    for row in zip(*(column.to_pylist() for column in rows.columns), strict=True):
        grid.add_row(*(escape(_shown(value)) for value in row))
    console.print(grid)


def _warned(rows: Table) -> str:
    """How many runs have warnings, where these are among the columns."""
    if "warnings" not in rows.column_names or str(rows.schema.field("warnings").type) != "string":
        return ""
    number = sum(bool(text) for text in rows["warnings"].to_pylist())
    return f", {number} with warnings: see --columns key,warnings" if number else ""


def _shown(value: Any) -> str:
    if value is None:
        return "-"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _finite(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """JSON knows no infinities, and no types beyond the plain ones."""
    return [{name: _json_value(value) for name, value in row.items()} for row in rows]


def _json_value(value: Any) -> Any:
    if isinstance(value, float):
        return value if abs(value) < float("inf") else None
    return value if value is None or isinstance(value, bool | int | str) else str(value)
