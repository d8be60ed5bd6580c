"""A study as data: a base configuration, a design, and what is kept of every run."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from shlex import quote
from typing import Any, Final, Literal, get_args

from gyrify.base.arguments import Pathlike, as_path, plain_tables
from gyrify.config import Config, toml_text
from gyrify.config.inputs.named_files import resolved
from gyrify.config.settings import merge, read_tables
from gyrify.config.words import shorten, show
from gyrify.errors import ConfigError
from gyrify.study.design import Design, read_design
from gyrify.study.design_checks import require_known

Keep = Literal["final", "all"]
KEEPS: Final[tuple[Keep, ...]] = get_args(Keep)
KEY_DIGITS: Final = 12


@dataclass(frozen=True)
class Point:
    """One run of a study.

    Attributes
    ----------
    parameters : dict
        Values by dotted key, of what is varied.
    config : Config
        Every number of the run.
    """

    parameters: dict[str, object]
    config: Config

    @property
    def key(self) -> str:
        """First 12 digits of the configuration's hash: the name of the run's folder."""
        return self.config.config_hash[:KEY_DIGITS]


@dataclass(frozen=True, repr=False)
class Study:
    """What to run.

    Attributes
    ----------
    base : Config
        What all runs have in common.
    design : Design
        What is varied.
    keep : {"final", "all"}
        Whether the final result of each run is kept, or its whole run folder.
    """

    base: Config
    design: Design
    keep: Keep = "final"

    def __repr__(self) -> str:
        varied = ", ".join(parameter.key for parameter in self.design.parameters) or "points written out"
        return f"Study({self.design.kind} of {varied}: {len(self.points())} points, keep {self.keep})"

    @classmethod
    def from_toml(cls, path: Pathlike) -> Study:
        """Read a study file.

        Parameters
        ----------
        path : path
            The file, in TOML.

        Raises
        ------
        ConfigError
            If it cannot be read, or a field is wrong.
        """
        file = as_path("path", path)
        name = f"The study file {shorten(str(file), toml_text.MAX_PATH)}"
        tables = toml_text.parse(toml_text.read_text(file), name)
        if _is_configuration(tables):
            raise ConfigError(
                f"The file {shorten(str(file), toml_text.MAX_PATH)} describes one run, not a study: "
                "it has no table [design].",
                f"Run it with: gyrify run {quote(str(file))}",
            )
        return cls.from_mapping(tables, file.parent)

    @classmethod
    def from_mapping(cls, tables: Mapping[str, Any], folder: Path | None = None) -> Study:
        """Check a study given as tables.

        Parameters
        ----------
        tables : mapping
            ``base``, ``design`` and ``keep``, as the study file has them.
        folder : Path, optional
            What ``base.config`` is relative to.

        Raises
        ------
        ConfigError
            If a field is wrong.
        """
        tables = plain_tables(tables)
        if _is_configuration(tables):
            raise ConfigError(
                "This describes one run, not a study: it has no table [design].",
                "Run it with `gyrify run`, or with simulate; a study has the tables [base] and [design].",
            )
        require_known(tables, ("base", "design", "keep"), "a study")
        study = cls(
            _base(tables.get("base", {}), folder or Path()),
            read_design(tables.get("design")),
            require_keep(tables.get("keep", "final")),
        )
        study.points()
        return study

    def points(self) -> tuple[Point, ...]:
        """Every run, in the order of the design.

        Raises
        ------
        ConfigError
            If a value is out of bounds, or two points are the same.
        """
        points: dict[str, Point] = {}
        for number, overrides in enumerate(self.design.combinations(), start=1):
            point = _point(self.base, overrides, number)
            if point.key in points:
                raise ConfigError(
                    f"Point {number} of the design ({_told(overrides)}) is given twice.",
                    "Give each value once; a random design draws few values more than once: use a grid.",
                )
            points[point.key] = point
        return tuple(points.values())

    def to_toml(self) -> str:
        """Write the study with every value of its base; reading it back gives equal points."""
        base = re.sub(r"^\[(\w+)\]$", r"[base.\1]", self.base.to_toml(), flags=re.MULTILINE)
        return f'keep = "{self.keep}"\n\n[base]\n{base}\n{_design_toml(self.design)}'


def _is_configuration(tables: Mapping[str, Any]) -> bool:
    """Whether tables describe one run."""
    return "design" not in tables and bool(tables.keys() & {*Config.model_fields, "preset"})


def as_study(given: Study | Mapping[str, Any] | str | os.PathLike[str]) -> Study:
    """Return the study that is meant: itself, its tables, or that of a file."""
    if isinstance(given, Study):
        return given
    if isinstance(given, Mapping):
        return Study.from_mapping(given)
    if isinstance(given, str | os.PathLike):
        return Study.from_toml(Path(given))
    raise ConfigError(
        f"A study cannot be made from an object of type {type(given).__name__}.",
        "Give a Study, a dict of its tables, or the path of a study file.",
    )


def value_of(config: Config, key: str) -> Any:
    """Value of a configuration at a dotted key."""
    found: Any = config
    for name in key.split("."):
        found = getattr(found, name)
    return found


def require_keep(keep: object) -> Keep:
    """Return what is kept of runs, or raise ConfigError."""
    for known in KEEPS:
        if keep == known:
            return known
    raise ConfigError(f'keep = {show(keep)} is not allowed: "final" or "all".', 'Try "final".')


def _base(table: object, folder: Path) -> Config:
    """The base: a configuration's own tables over a preset or over a file."""
    if not isinstance(table, Mapping):
        raise ConfigError(f"base = {show(table)} is not a table.", 'Write [base] with preset = "wang2019".')
    own = resolved(table, folder)
    source = own.pop("config", None)
    if source is None:
        return Config.from_dict(own)
    if not isinstance(source, str) or "preset" in own:
        raise ConfigError(
            "base takes either preset or config, the path of a file, and config must be text.",
            "Leave one out.",
        )
    return Config.from_dict(merge(read_tables(folder / source), own))


def _point(base: Config, overrides: Mapping[str, object], number: int) -> Point:
    try:
        config = base.with_overrides(overrides)
    except ConfigError as fault:
        told = f"Point {number} of the design ({_told(overrides)}): {fault.message}"
        raise ConfigError(told, fault.advice) from fault
    return Point({key: value_of(config, key) for key in overrides}, config)


def _told(overrides: Mapping[str, object]) -> str:
    return shorten(", ".join(f"{key} = {show(value)}" for key, value in overrides.items()), 160)


def _design_toml(design: Design) -> str:
    top: list[tuple[str, Any, str]] = [("kind", design.kind, ""), ("seed", design.seed, "")]
    top += [("n", design.n, "")] if design.n is not None else []
    blocks = ["[design]\n" + toml_text.table(top)]
    for row in design.rows:
        lines = [(f'"{key}"', value, "") for key, value in row.items()]
        blocks.append("[[design.point]]\n" + toml_text.table(lines))
    for parameter in design.parameters:
        lines = [("key", parameter.key, "")]
        lines += [("values", parameter.values, "")] if parameter.range is None else []
        lines += [] if parameter.range is None else [("range", parameter.range, "")]
        lines += [("scale", parameter.scale, "")] if parameter.scale != "linear" else []
        lines += [("n", parameter.n, "")] if parameter.n is not None else []
        blocks.append("[[design.parameter]]\n" + toml_text.table(lines))
    return "\n".join(blocks)
