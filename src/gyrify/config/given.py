"""Whatever a caller gives for a configuration: one itself, tables, or the path of a file."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from gyrify.config.preset_files import preset_names
from gyrify.config.settings import Config
from gyrify.config.words import shorten
from gyrify.errors import ConfigError

ConfigLike = Config | Mapping[str, Any] | str | os.PathLike[str]


def as_config(given: ConfigLike) -> Config:
    """Return the configuration that is meant.

    Parameters
    ----------
    given : Config, mapping, str or path
        A configuration, its tables by section (dotted keys are allowed, too), or the path of a TOML file.

    Returns
    -------
    Config

    Raises
    ------
    ConfigError
        If it is none of these, or not valid.
    """
    if isinstance(given, Config):
        return given
    if isinstance(given, Mapping):
        dotted = {key: value for key, value in given.items() if "." in str(key)}
        tables = Config.from_dict({key: value for key, value in given.items() if key not in dotted})
        return tables.with_overrides(dotted) if dotted else tables
    if not isinstance(given, str | os.PathLike):
        raise ConfigError(
            f"A configuration cannot be made from an object of type {type(given).__name__}.",
            "Give a Config, a dict of tables, or the path of a TOML file.",
        )
    path = Path(given)
    if isinstance(given, str) and given in preset_names() and not path.exists():
        raise ConfigError(f'"{given}" is a preset, not a file.', f'Give Config.preset("{given}"), or a path.')
    if isinstance(given, str) and ("\n" in given or "=" in given) and not path.is_file():
        raise ConfigError(
            f'"{shorten(given)}" is not the path of a file.',
            "For the text of a configuration, give Config.from_toml(text).",
        )
    return Config.load(path)
