"""The whole configuration: one frozen object that states every number of a run."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from shlex import quote
from typing import Any, Final

from pydantic import model_validator

from gyrify.base.arguments import Pathlike, as_path, plain_tables
from gyrify.config import cross_checks, toml_text
from gyrify.config.base import Section, setting
from gyrify.config.body_sections import Geometry, MeshSettings
from gyrify.config.faults import raise_faults, sections, unknown_key
from gyrify.config.inputs.named_files import FILE_KEYS, kept_name, resolved
from gyrify.config.physics_sections import Boundary, Contact, Dissipation, Growth, Material
from gyrify.config.preset_files import preset_data
from gyrify.config.run_sections import Limits, Metrics, Output, SchemaVersion, Solver, Stability
from gyrify.config.words import extra, shorten, show
from gyrify.errors import ConfigError

NOT_HASHED: Final = frozenset({"output", "limits"})
# Keys that came later, with their section: at its default such a key is not hashed, so that the hashes of
# earlier configurations stay.
LATER: Final = (
    *(("geometry", key) for key in ("width", "semi_axes", *FILE_KEYS, "unit", "labels", "digest")),
    ("mesh", "edge_length"),
    ("mesh", "inversion_resistance"),
    ("growth", "profile"),
    ("growth", "transition"),
    *(("boundary", key) for key in ("clamp", "plane")),
    ("growth", "out_of_plane_exponent"),
    ("dissipation", "course"),
    ("material", "law"),
)


class Config(Section):
    """Every number of a run, checked; ``Config()`` is the standard slice.

    Overrides and files may start from a preset (``preset = "wang2019"``): its values come first, and the
    name is not kept, so that equal values are equal configurations.
    """

    schema_version: SchemaVersion = setting(1, "Version of this format.")
    seed: int = setting(0, "Seed of every random choice.", ge=0, le=2**32 - 1)
    geometry: Geometry = Geometry()
    mesh: MeshSettings = MeshSettings()
    material: Material = Material()
    growth: Growth = Growth()
    boundary: Boundary = Boundary()
    contact: Contact = Contact()
    dissipation: Dissipation = Dissipation()
    solver: Solver = Solver()
    stability: Stability = Stability()
    metrics: Metrics = Metrics()
    output: Output = Output()
    limits: Limits = Limits()

    @model_validator(mode="before")
    @classmethod
    def _start_from_preset(cls, data: Any) -> Any:
        if not isinstance(data, dict) or "preset" not in data:
            return data
        own = {key: value for key, value in data.items() if key != "preset"}
        return merge(preset_data(data["preset"]), own)

    @model_validator(mode="after")
    def _fit_to_the_body(self) -> Config:
        """Lengths of measuring that are not given scale with the body, also under later overrides."""
        self.__dict__["metrics"] = self.metrics.scaled(self.geometry.scale * self.boundary.whole)
        return self

    @model_validator(mode="after")
    def _check_together(self) -> Config:
        raise_faults(cross_checks.faults(self))
        return self

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Config:
        """Build a configuration from nested tables, as TOML or JSON hold them.

        Parameters
        ----------
        data : mapping
            Tables by section; numbers may be fractions in quotes.

        Returns
        -------
        Config
            Checked and complete.
        """
        if "design" in data:
            raise ConfigError(
                "This describes a study of many runs, not one run: it has a table [design].",
                "Run it with `gyrify study FILE`, or with run_study.",
            )
        return cls(**{str(key): value for key, value in data.items()})

    @classmethod
    def from_toml(cls, source: str | os.PathLike[str], folder: Pathlike | None = None) -> Config:
        """Read a configuration from TOML.

        Parameters
        ----------
        source : str or Path
            The text itself, or (a Path) the file.
        folder : path, optional
            What the paths of its files are relative to; the current folder without it, or that of the file.

        Returns
        -------
        Config
            Checked and complete.
        """
        if isinstance(source, os.PathLike):
            return cls.load(source)
        tables = toml_text.parse(source)
        return cls.from_dict(tables if folder is None else resolved(tables, as_path("folder", folder)))

    @classmethod
    def load(cls, path: Pathlike) -> Config:
        """Read a configuration from a TOML file.

        Parameters
        ----------
        path : str or Path
            The file.

        Returns
        -------
        Config
            Checked and complete.
        """
        return cls.from_dict(read_tables(path))

    @classmethod
    def preset(cls, name: str) -> Config:
        """Return the configuration of a preset.

        Parameters
        ----------
        name : str
            One of those that ``gyrify presets`` lists.

        Returns
        -------
        Config
            Checked and complete.
        """
        return cls.from_dict(preset_data(name))

    def with_overrides(self, overrides: Mapping[str, object]) -> Config:
        """Return a copy with some values replaced, checked anew.

        Parameters
        ----------
        overrides : mapping
            Values by dotted key, such as ``{"growth.ratio": 2.0, "seed": 3}``; numbers may be fractions
            (``"1/1.36"``).

        Returns
        -------
        Config
            The new configuration.
        """
        given = {key: _as_dict(value) for key, value in self.model_dump(exclude_unset=True).items()}
        if any(key.removeprefix("geometry.") in FILE_KEYS for key in overrides):
            given.get("geometry", {}).pop("digest", None)  # other files have another one
        return type(self).from_dict(merge(given, nested(overrides)))

    def replace(self, **overrides: object) -> Config:
        """Return a copy with some values replaced: ``config.replace(**{"growth.ratio": 2.0})``.

        Parameters
        ----------
        **overrides : object
            Values by dotted key.

        Returns
        -------
        Config
            Checked and complete.
        """
        return self.with_overrides(overrides)

    def to_dict(self) -> dict[str, Any]:
        """Return every value in nested dictionaries fit for JSON."""
        return self.model_dump(mode="json")

    def to_toml(self, *, is_stored: bool = False) -> str:
        """Write every value as TOML with its unit; reading it back gives an equal configuration.

        Parameters
        ----------
        is_stored : bool
            Whether to name the copies of its files, as seen from the folder of the run.
        """
        top = [(name, getattr(self, name), "") for name in self.top_level()]
        blocks = [toml_text.table(top)]
        for name, kind in sections(type(self)).items():
            section = getattr(self, name)
            values = {key: getattr(section, key) for key in kind.model_fields}
            if is_stored and name == "geometry":
                values |= {key: kept_name(key, values[key]) for key in FILE_KEYS if values[key]}
            lines = [(key, values[key], extra(field, "unit")) for key, field in kind.model_fields.items()]
            blocks.append(f"[{name}]\n{toml_text.table(lines)}")
        return "\n".join(blocks)

    @classmethod
    def top_level(cls) -> tuple[str, ...]:
        """Return the names of the fields outside any section."""
        return tuple(name for name in cls.model_fields if name not in sections(cls))

    @property
    def config_hash(self) -> str:
        """SHA-256 (hexadecimal) of the canonical JSON of every value outside `output` and `limits`."""
        hashed = {key: value for key, value in self.to_dict().items() if key not in NOT_HASHED}
        for name, key in LATER:
            default = sections(type(self))[name].model_fields[key].default
            if key in FILE_KEYS or getattr(getattr(self, name), key) == default:  # the digest is of files
                del hashed[name][key]
        hashed = {key: value for key, value in hashed.items() if value != {}}
        text = json.dumps(hashed, sort_keys=True, separators=(",", ":"), allow_nan=False)
        return hashlib.sha256(text.encode("ascii")).hexdigest()

    def _repr_html_(self) -> str:
        from gyrify.config.rows import html_table

        return html_table(self)


def read_tables(path: Pathlike) -> dict[str, Any]:
    """Read the tables of a TOML file without checking what they mean."""
    path = as_path("path", path)
    name = f"The configuration file {shorten(str(path), toml_text.MAX_PATH)}"
    tables = toml_text.parse(toml_text.read_text(path), name)
    if "design" in tables:
        raise ConfigError(
            f"The file {shorten(str(path), toml_text.MAX_PATH)} describes a study of many runs, not one run: "
            "it has a table [design].",
            f"Run it with: gyrify study {quote(str(path))}",
        )
    return resolved(tables, path.absolute().parent)


def merge(base: Mapping[str, Any], over: Mapping[str, Any]) -> dict[str, Any]:
    """Lay tables over others; where a table meets what is none, the latter stays, to be refused by name."""
    merged = dict(base)
    for key, value in over.items():
        below, above = merged.get(key), _as_dict(value)
        if isinstance(below, dict) and isinstance(above, dict):
            tables = {name: item for name, item in above.items() if isinstance(item, dict)}
            both = {k: {**below[k], **item} for k, item in tables.items() if isinstance(below.get(k), dict)}
            merged[key] = {**below, **above, **both}
        elif below is None or not isinstance(above, dict):
            merged[key] = above
    return merged


def nested(overrides: Mapping[str, object]) -> dict[str, Any]:
    """Turn dotted keys into nested tables, refusing keys that do not exist.

    Parameters
    ----------
    overrides : mapping
        Values by dotted key.

    Returns
    -------
    dict
        Tables by section.
    """
    tables: dict[str, Any] = {}
    faults = []
    for dotted, value in plain_tables(overrides).items():
        name, _, key = dotted.partition(".")
        section = sections(Config).get(name)
        if section is None and (name not in (*Config.top_level(), "preset") or key):
            faults.append(unknown_key(Config, Config, dotted))
        elif section is not None and not key:
            faults.append(
                f"{name} = {show(value)} is not allowed: {name} is a section. Name one of its keys."
            )
        elif section is not None and key not in section.model_fields:
            faults.append(unknown_key(Config, section, dotted))
        elif section is None:
            tables[name] = value
        else:
            tables.setdefault(name, {})[key] = value
    raise_faults(faults)
    return tables


def _as_dict(value: Any) -> Any:
    return value.model_dump(exclude_unset=True) if isinstance(value, Section) else value
