"""Presets: published parameter sets, kept as TOML files with the source of each value."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from typing import Any, Final

from gyrify.config import toml_text
from gyrify.config.faults import nearest
from gyrify.config.words import shorten
from gyrify.errors import ConfigError

ABOUT: Final = "about"


@dataclass(frozen=True)
class PresetAbout:
    """What a preset says of itself.

    Attributes
    ----------
    name : str
        Its name.
    description : str
        One sentence.
    reference : str
        The publication, if there is one.
    not_claimed : tuple of str
        What the preset does not claim.
    sources : dict
        Where each value comes from, by dotted key.
    gi_definition : str
        Which gyrification index the publication's values are compared with, as `gyrify paper --gi` takes it.
    """

    name: str
    description: str
    reference: str = ""
    not_claimed: tuple[str, ...] = ()
    sources: dict[str, str] = field(default_factory=dict)
    gi_definition: str = "closing"


def preset_names() -> tuple[str, ...]:
    """Return the names of all presets, in alphabetical order."""
    files = resources.files("gyrify.config").joinpath("presets").iterdir()
    return tuple(sorted(f.name.removesuffix(".toml") for f in files if f.name.endswith(".toml")))


def preset_about(name: str) -> PresetAbout:
    """Return what a preset says of itself.

    Parameters
    ----------
    name : str
        One of `preset_names`.

    Returns
    -------
    PresetAbout
        Description, reference, sources and limits.
    """
    about = toml_text.parse(_text(name))[ABOUT]
    return PresetAbout(
        name,
        about["description"],
        about.get("reference", ""),
        tuple(about.get("not_claimed", ())),
        about.get("sources", {}),
        about.get("gi_definition", "closing"),
    )


def preset_data(name: object) -> dict[str, Any]:
    """Return the settings of a preset as nested tables.

    Parameters
    ----------
    name : object
        One of `preset_names`; anything else is refused with the nearest name.

    Returns
    -------
    dict
        A fresh dictionary.
    """
    data = toml_text.parse(_text(name))
    data.pop(ABOUT, None)
    return data


def _text(name: object) -> str:
    names = preset_names()
    if not isinstance(name, str) or name not in names:
        close = nearest(name, names) if isinstance(name, str) else ""
        hint = f"Did you mean {close}?" if close else "Choose one of these."
        shown = shorten(str(name))
        raise ConfigError(f'preset = "{shown}" does not exist: available are {", ".join(names)}.', hint)
    return _read(name)


@cache
def _read(name: str) -> str:
    return resources.files("gyrify.config").joinpath("presets", f"{name}.toml").read_text("utf-8")
