"""The options that choose a configuration, the same for every command that takes one."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

from cyclopts import Parameter

from gyrify.errors import ConfigError

if TYPE_CHECKING:
    from gyrify.config import Config

Text = Annotated[str | None, Parameter(allow_leading_hyphen=True)]
# What a single dash stands for, which would otherwise be read as an option.
STANDARD_INPUT: Final = Path("/dev/stdin")
ConfigPath = Annotated[
    Path | None,
    Parameter(help="Configuration in TOML, - for standard input; without it, the standard slice."),
]
SHORTCUTS: Final = {
    "stiffness_ratio": "material.stiffness_ratio",
    "growth_ratio": "growth.ratio",
    "thickness": "geometry.cortical_thickness",
    "seed": "seed",
}


@Parameter(name="*")
@dataclass(frozen=True)
class Overrides:
    """What the command line lays over a configuration file.

    Parameters
    ----------
    preset : str, optional
        Preset to start from (see gyrify presets), instead of the one that the file names.
    stiffness_ratio : str, optional
        Stiffness of the cortex over white matter; numbers may be fractions (1/1.36).
    growth_ratio : str, optional
        Growth rate of the cortex over white matter.
    thickness : str, optional
        Initial cortical thickness [mm].
    seed : str, optional
        Seed of every random choice.
    set_ : sequence of str, optional
        Any other value, as section.field=value; may be repeated.
    """

    preset: str | None = None
    stiffness_ratio: Text = None
    growth_ratio: Text = None
    thickness: Text = None
    seed: Text = None
    set_: Annotated[tuple[str, ...], Parameter(name="--set", negative="", allow_leading_hyphen=True)] = ()

    def resolve(self, path: Path | None) -> Config:
        """Return the configuration of a file (or the default) with these values laid over it."""
        shortcuts = (self.stiffness_ratio, self.growth_ratio, self.thickness, self.seed)
        return resolve_config(path, self.preset, *shortcuts, self.set_)


def resolve_config(
    config_path: Path | None = None,
    preset: str | None = None,
    stiffness_ratio: str | None = None,
    growth_ratio: str | None = None,
    thickness: str | None = None,
    seed: str | None = None,
    set_: Sequence[str] = (),
) -> Config:
    """Return the configuration that a command line asks for.

    The preset comes first, then the file, then the other values. A preset given here replaces the one that
    the file names.

    Parameters
    ----------
    config_path : Path, optional
        TOML file; ``-`` for standard input.
    preset : str, optional
        Name of a preset.
    stiffness_ratio, growth_ratio, thickness, seed : str, optional
        Values as text; numbers may be fractions.
    set_ : sequence of str, optional
        Each ``section.field=value``.

    Returns
    -------
    Config
        Checked and complete.
    """
    from gyrify.config.settings import Config, merge, nested

    shortcuts = zip(SHORTCUTS.values(), (stiffness_ratio, growth_ratio, thickness, seed), strict=True)
    pairs = [(key, text) for key, text in shortcuts if text is not None]
    texts = once([*pairs, *map(split_assignment, set_)])
    tables = _tables(config_path)
    if preset is not None:
        tables["preset"] = preset
    return Config.from_dict(merge(tables, nested({key: read_value(text) for key, text in texts.items()})))


def _tables(path: Path | None) -> dict[str, Any]:
    from gyrify.config import toml_text
    from gyrify.config.settings import read_tables

    if path == STANDARD_INPUT:
        return toml_text.parse(toml_text.read_standard_input(), "Standard input")
    return {} if path is None else read_tables(path)


def split_assignment(text: str) -> tuple[str, str]:
    """Split ``section.field=value``."""
    key, equals, value = text.partition("=")
    if not (key.strip() and equals):
        raise ConfigError(f"--set {text[:60]!r} is not an assignment.", "Write --set section.field=value.")
    return key.strip(), value.strip()


def once(pairs: Iterable[tuple[str, str]]) -> dict[str, str]:
    """Return the values by key, refusing a key that is given two values."""
    found: dict[str, str] = {}
    for key, value in pairs:
        if found.setdefault(key, value) != value:
            raise ConfigError(
                f"{key[:60]} is given twice: {found[key][:60]} and {value[:60]}.", "Give it once."
            )
    return found


def read_value(text: str) -> object:
    """Read a value from the command line: a number, true or false, a TOML list, or else a word.

    Parameters
    ----------
    text : str
        Fractions stay text: the field that takes a number reads them.

    Returns
    -------
    object
        The value.
    """
    if re.fullmatch(r"[+-]?[0-9]{1,64}", text, re.ASCII):
        return int(text)
    if re.fullmatch(r"[+-]?([0-9]+\.[0-9]*|\.[0-9]+|[0-9]+(?=[eE]))([eE][+-]?[0-9]+)?", text, re.ASCII):
        return float(text)
    try:
        tables = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        return text
    return tables["value"] if len(tables) == 1 else text
