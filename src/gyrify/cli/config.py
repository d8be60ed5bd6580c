"""``gyrify config``: show, check and describe configurations."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from cyclopts import App

from gyrify.cli.overrides import ConfigPath, Overrides
from gyrify.cli.streams import print_json, say, warn

if TYPE_CHECKING:
    from gyrify.config import Config
    from gyrify.config.rows import Row

app = App(name="config", help="Show, check and describe configurations.")
DEFAULT = Overrides()


@app.command
def show(
    config: ConfigPath = None,
    /,
    *,
    overrides: Overrides = DEFAULT,
    toml: bool = False,
    json: bool = False,
    quiet: bool = False,  # noqa: ARG001 - for uniformity
) -> None:
    """Print every value with its unit and source.

    Parameters
    ----------
    toml : bool
        Print TOML that can be used as a configuration file.
    json : bool
        Print one JSON document.
    quiet : bool
        Show no progress.
    """
    from gyrify.config.rows import rows

    resolved = overrides.resolve(config)
    if json:
        print_json({"config": resolved.to_dict(), "config_hash": resolved.config_hash})
    elif toml:
        say(resolved.to_toml().rstrip())
    elif sys.stdout.isatty():
        _print_rich(rows(resolved), resolved)
    else:
        _print_plain(rows(resolved), resolved)


@app.command
def check(
    config: ConfigPath = None,
    /,
    *,
    overrides: Overrides = DEFAULT,
    json: bool = False,
    quiet: bool = False,  # noqa: ARG001 - for uniformity
) -> None:
    """Check a configuration, its mesh too, without running it.

    Parameters
    ----------
    json : bool
        Print one JSON document.
    quiet : bool
        Show no progress.
    """
    from gyrify.model.meshing import build_mesh
    from gyrify.run.validity import config_warnings

    resolved = overrides.resolve(config)
    build_mesh(resolved)
    warnings = config_warnings(resolved)
    warn(warnings)
    if json:
        print_json({"valid": True, "config_hash": resolved.config_hash, "warnings": warnings})
    else:
        say(f"The configuration is valid (hash {resolved.config_hash[:12]}).")


@app.command
def schema(*, json: bool = True, quiet: bool = False) -> None:  # noqa: ARG001 - for uniformity
    """Print the JSON Schema of the configuration format.

    Parameters
    ----------
    json : bool
        Accepted for uniformity: the schema is JSON anyway.
    quiet : bool
        Show no progress.
    """
    from gyrify.config.schema import json_schema

    print_json(json_schema())


def _print_plain(found: list[Row], resolved: Config) -> None:
    from gyrify.config.rows import plain

    shown = [(row.key, f"{plain(row.value)} {row.unit}".strip(), row.origin) for row in found]
    key_width = max(len(key) for key, _, _ in shown)
    value_width = min(32, max(len(value) for _, value, _ in shown))
    for key, value, source in shown:
        say(f"{key:<{key_width}}  {value:<{value_width}}  {source}".rstrip())
    say(f"{'config_hash':<{key_width}}  {resolved.config_hash}")


def _print_rich(found: list[Row], resolved: Config) -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    from gyrify.config.rows import plain

    table = Table("field", "value", "unit", "source", caption=f"config_hash {resolved.config_hash}")
    for row in found:
        style = "bold" if row.is_changed else ""
        table.add_row(row.key, Text(plain(row.value), style), Text(row.unit), Text(row.origin, "dim"))
    Console().print(table)
