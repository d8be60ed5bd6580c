"""``results.parquet``: one tidy row per run, with the same bytes for the same results."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from gyrify.base.arguments import Pathlike, as_path
from gyrify.config import Config
from gyrify.config.body_sections import PERIODIC
from gyrify.config.words import shorten, show
from gyrify.errors import ConfigError, HistoryError
from gyrify.metrics.quantities import flat, quantities
from gyrify.phenotype import classify, grown_thickness
from gyrify.run.units import unit_of
from gyrify.store.files import whole_file
from gyrify.study.archive import Record
from gyrify.study.definition import Point, value_of
from gyrify.study.parameter import require_variable

if TYPE_CHECKING:
    from pyarrow import DataType, Table

RESULTS: Final = "results.parquet"
TIMINGS: Final = "timings.csv"
_IDENTITY: Final = ("key", "config_hash", "solver_version", "status", "reason", "advice")
# Not quantities, given elsewhere in the row, or different from one machine to the next.
_LEFT_OUT: Final = {
    *_IDENTITY,
    "versions",
    "seed",
    "result_hash",
    "solver_wall_s",
    "stability_changes",
    "parameters",
    "units",
    "expected_theory",
    "expected_not_covered",
    "converged_known",
    "converged_converged",
    "converged_limit",
    "converged_sentence",
    "converged_command",
}
# What an incomplete run has too.
_OF_ANY_END: Final = ("growth_time", "solver_", "warnings", "expected_")
_INT, _TEXT, _BOOL, _FLOAT = "int64", "string", "bool", "float64"
_ALIAS: Final[dict[type, str]] = {int: _INT, str: _TEXT, bool: _BOOL, float: _FLOAT}


def column_types() -> dict[str, str]:
    """Columns that are always there, with their types; what else a summary holds comes after them."""
    return {quantity.key: _ALIAS[quantity.type] for quantity in quantities() if quantity.in_results}


def dimensions(table: Table) -> tuple[int, ...]:
    """Whether rows are of bodies in the plane (2), in space (3) or both, as far as their indices tell."""
    named = {name: 3 if name == "gi_area_closing" else 2 for name in ("gi_closing", "gi_area_closing")}
    found = tuple(
        n_dim
        for name, n_dim in named.items()
        if name in table.column_names and table[name].null_count < table.num_rows
    )
    return found or (2,)


def write_results(folder: Path, points: Sequence[Point], records: Mapping[str, Record]) -> None:
    """Write ``results.parquet`` and ``timings.csv``, by atomic rename.

    Parameters
    ----------
    folder : Path
        Study folder.
    points : sequence of Point
        The design, in the order of the rows.
    records : mapping
        What is known, by key; points that are not have no row.
    """
    import pyarrow.parquet as pq

    known = [point for point in points if point.key in records]
    with whole_file(folder / RESULTS) as partial:
        pq.write_table(results_table(known, records), partial, compression="zstd")
    lines = [f"{point.key},{records[point.key].wall_s:.4f}\n" for point in known]
    with whole_file(folder / TIMINGS) as partial:
        partial.write_text("".join(["key,wall_s\n", *lines]), encoding="utf-8")


def results_table(points: Sequence[Point], records: Mapping[str, Record]) -> Table:
    """One row per point.

    Parameters
    ----------
    points : sequence of Point
        The rows, in order; where one lacks a parameter that another has, its configuration's value stands.
    records : mapping
        What each came to, by key.

    Returns
    -------
    pyarrow.Table
        Its fields carry their units as metadata, under the key ``unit``.
    """
    import pyarrow as pa

    varied = list(dict.fromkeys(key for point in points for key in point.parameters))
    rows = [_row(point, records[point.key], varied) for point in points]
    names = list(
        dict.fromkeys([*_IDENTITY, *varied, *column_types(), *(name for row in rows for name in row)])
    )
    last = ("phenotype", "phenotype_rule", "result_hash")
    names = [*(name for name in names if name not in last), *last]
    columns, described = [], []
    n_dims = sorted({point.config.geometry.n_dim for point in points})
    for name in names:
        values = [row.get(name) for row in rows]
        kind = _kind(name, values)
        if kind == pa.string():
            values = [value if value is None or isinstance(value, str) else repr(value) for value in values]
        columns.append(pa.array(values, kind))
        unit = " or ".join(dict.fromkeys(unit_of(name, n_dim) for n_dim in n_dims))
        described.append(pa.field(name, kind, metadata={"unit": unit} if unit else None))
    return pa.table(columns, pa.schema(described))


def read_results(folder: Pathlike) -> Table:
    """Results of a study, with the time that each run took.

    Parameters
    ----------
    folder : path
        Study folder.

    Returns
    -------
    pyarrow.Table
        The columns of ``results.parquet``, and ``wall_s`` [s] from ``timings.csv``.

    Raises
    ------
    HistoryError
        If there are none.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    path = as_path("folder", folder) / RESULTS
    if not path.is_file():
        raise HistoryError(
            f"There are no results in {folder}.", "Name a folder that `gyrify study` has written."
        )
    try:
        table = pq.read_table(path)
        table.validate(full=True)
        _require_columns(table)
    except (OSError, ValueError, pa.ArrowException, MemoryError) as fault:
        raise HistoryError(
            f"{path} is damaged: {shorten(' '.join(str(fault).split()), 120)}.",
            "Run the study again: it rebuilds its results from the stored runs.",
        ) from fault
    times = _timings(path.with_name(TIMINGS))
    return table.append_column("wall_s", pa.array(map(times.get, table["key"].to_pylist()), pa.float64()))


def _require_columns(table: Table) -> None:
    """Refuse what is no table of a study: other columns or types, or a key that is no name of a run."""
    kinds = dict(zip(table.column_names, map(str, table.schema.types), strict=True))
    kinds = {name: _FLOAT if kind == "double" else kind for name, kind in kinds.items()}
    if len(kinds) < table.num_columns:
        raise ValueError("a column appears twice")
    wanted = dict.fromkeys(_IDENTITY, _TEXT) | column_types() | {"result_hash": _TEXT, "wall_s": "nothing"}
    for name, kind in kinds.items():
        known = wanted.get(name)
        if kind not in (_INT, _TEXT, _BOOL, _FLOAT) or (known is not None and kind != known):
            raise ValueError(f"the column {shorten(name)} holds {shorten(kind)}")
        if "." in name:
            require_variable(name, "its columns")
    for name in _IDENTITY:
        if name not in kinds or table[name].null_count:
            raise ValueError(f"the column {name} is missing or has gaps")
    for key in table["key"].to_pylist():
        if not re.fullmatch(r"[0-9a-f]{12}", key):
            raise ValueError(f"{show(key)} is not the key of a run")


def _row(point: Point, record: Record, varied: Iterable[str]) -> dict[str, Any]:
    summary = record.summary or {}
    if "warnings" in summary:
        summary = {**summary, "warnings": "\n".join(summary["warnings"])}
    quantities = flat(
        {key: value for key, value in summary.items() if key not in _LEFT_OUT and value is not None}
    )
    is_whole = record.status == "completed"
    label, rule = _phenotype(quantities, point.config) if is_whole else (None, None)
    return {
        "key": point.key,
        **{name: getattr(record, name) for name in _IDENTITY[1:]},
        **{key: value_of(point.config, key) for key in varied},
        **{
            name: value
            for name, value in quantities.items()
            if name not in _LEFT_OUT and (is_whole or name.startswith(_OF_ANY_END))
        },
        "phenotype": label,
        "phenotype_rule": rule,
        "result_hash": summary.get("result_hash"),
    }


def _phenotype(quantities: Mapping[str, Any], config: Config) -> tuple[str | None, str | None]:
    """Label and rule; none for a strip or a patch, whose gyri are not those of a slice."""
    if config.geometry.shape in PERIODIC:
        return None, None
    try:
        found = classify(quantities, grown_thickness(config))
    except ConfigError:  # a metric is not finite, or in space the rules ask for one that it does not have
        return None, None
    return found.label, found.rule


def _kind(name: str, values: Sequence[object]) -> DataType:
    """Type of a column: the known one, or that of its values."""
    import pyarrow as pa

    if (known := column_types().get(name)) is not None:
        return pa.type_for_alias(known)
    kinds = {type(value) for value in values if value is not None}
    if not kinds:
        return pa.string() if name == "result_hash" or name in _IDENTITY else pa.float64()
    for kind, alias in ({bool}, _BOOL), ({int}, _INT), ({int, float}, _FLOAT):
        if kinds <= kind:
            return pa.type_for_alias(alias)
    return pa.string()


def _timings(path: Path) -> dict[str, float]:
    try:
        lines = path.read_text(encoding="utf-8").splitlines()[1:]
        return {key: float(value) for key, value in (line.split(",") for line in lines)}
    except (OSError, ValueError):
        return {}
