"""One varied parameter of a study: its key, and the values or the range it takes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np

from gyrify.config import Config, parse_number
from gyrify.config.faults import sections
from gyrify.config.settings import NOT_HASHED, nested
from gyrify.config.words import alternatives, is_number, shorten, show
from gyrify.errors import ConfigError
from gyrify.study.design_checks import require_known, whole_number

Scale = Literal["linear", "log"]
_KNOWN: Final = ("key", "values", "range", "scale", "n")


@dataclass(frozen=True)
class Parameter:
    """A key of the configuration and what it is varied over: values, or a range.

    Attributes
    ----------
    key : str
        Dotted key, such as ``growth.ratio``.
    values : tuple
        The values; empty where there is a range.
    range : (float, float) or None
        Lowest and highest value.
    scale : {"linear", "log"}
        How values lie in the range.
    n : int or None
        Number of values in the range; None for that of the design.
    """

    key: str
    values: tuple[object, ...] = ()
    range: tuple[float, float] | None = None
    scale: Scale = "linear"
    n: int | None = None

    @property
    def is_whole(self) -> bool:
        """Whether only whole numbers are allowed."""
        return is_whole(self.key)

    def at(self, share: float) -> object:
        """Value at a share of the range, or of the list of values, in [0, 1)."""
        if self.range is None:
            return self.values[min(int(share * len(self.values)), len(self.values) - 1)]
        low, high = self.range
        if self.is_whole:
            return min(int(low + share * (high - low + 1)), int(high))
        if self.scale == "log":
            return float(low * (high / low) ** share)
        return float(low + share * (high - low))

    def spread(self, n: int | None) -> tuple[object, ...]:
        """The values; of a range ``n`` of them, with both ends.

        Raises
        ------
        ConfigError
            If there is a range and no number of values.
        """
        if self.range is None:
            return self.values
        count = self.n if self.n is not None else n
        if count is None or count < 2:
            raise ConfigError(
                f"The range of {self.key} needs a number of values, at least 2.",
                "Write n = 5 beside it or in [design], or list values.",
            )
        low, high = self.range
        between = (np.geomspace if self.scale == "log" else np.linspace)(low, high, count)[1:-1]
        values = [low, *(float(value) for value in between), high]
        return tuple(round(value) for value in values) if self.is_whole else tuple(values)


def is_whole(key: str) -> bool:
    """Whether a dotted key takes whole numbers only."""
    kinds = alternatives(_field(key))
    return int in kinds and float not in kinds


def require_variable(key: object, where: str) -> str:
    """Return a dotted key that a study may vary.

    Raises
    ------
    ConfigError
        If it is none.
    """
    if not isinstance(key, str) or not key:
        raise ConfigError(f"{where}: key = {show(key)} is not allowed.", 'Name one, such as "growth.ratio".')
    section = key.partition(".")[0]
    if key in ("schema_version", "preset") or section in NOT_HASHED:
        raise ConfigError(
            f"{where}: {shorten(key)} cannot be varied: it has no influence on a result.",
            "Set it in [base].",
        )
    nested({key: 0})
    return key


def read_parameter(table: object, where: str) -> Parameter:
    """Check one ``[[design.parameter]]``.

    Parameters
    ----------
    table : object
        As TOML holds it.
    where : str
        What to call it in messages.

    Returns
    -------
    Parameter

    Raises
    ------
    ConfigError
        If a field is wrong.
    """
    if not isinstance(table, Mapping):
        raise ConfigError(f"{where} = {show(table)} is not a table.", "Write [[design.parameter]].")
    require_known(table, _KNOWN, where)
    key = require_variable(table.get("key"), where)
    where = f"{where} ({key})"
    if ("values" in table) == ("range" in table):
        raise ConfigError(f"{where} needs either values or a range.", "Write values = [1.0, 2.0].")
    scale = table.get("scale", "linear")
    if scale not in ("linear", "log"):
        raise ConfigError(f'{where}: scale = {show(scale)} is not allowed: "linear" or "log".', 'Try "log".')
    n = whole_number(table["n"], f"{where}: n", 2, 100_000) if "n" in table else None
    if "values" in table:
        return Parameter(key, _values(table["values"], where), None, scale, n)
    return Parameter(key, (), _range(table["range"], key, scale, where), scale, n)


def _values(given: Any, where: str) -> tuple[object, ...]:
    if not isinstance(given, list | tuple) or not given:
        raise ConfigError(f"{where}: values = {show(given)} is not a list of values.", "Try [1.0, 2.0, 3.0].")
    return tuple(given)


def _range(given: Any, key: str, scale: str, where: str) -> tuple[float, float]:
    if not is_number(_field(key)):
        raise ConfigError(
            f"{where}: its values are not numbers, so that it has no range.", "List its values."
        )
    if not isinstance(given, list | tuple) or len(given) != 2:
        raise ConfigError(
            f"{where}: range = {show(given)} is not a pair.", "Write range = [lowest, highest]."
        )
    low, high = (_number(end, where) for end in given)
    if not low < high:
        raise ConfigError(f"{where}: range = {show(given)} does not increase.", "Give the lower end first.")
    if scale == "log" and low <= 0.0:
        raise ConfigError(
            f"{where}: a logarithmic range must begin above 0, but this one begins at {low:g}.", "Try 0.01."
        )
    if is_whole(key) and (low % 1 or high % 1):
        raise ConfigError(
            f"{where}: range = {show(given)} has ends that are not whole.", "Try whole numbers."
        )
    return low, high


def _number(given: object, where: str) -> float:
    try:
        if isinstance(given, bool) or not isinstance(given, int | float | str):
            raise ValueError("an end of a range is a number")
        value = parse_number(given if isinstance(given, str) else repr(given))
    except ValueError as fault:
        raise ConfigError(f"{where}: {show(given)} in range is not a number: {fault}.", "Try 1.0.") from fault
    return value


def _field(key: str) -> Any:
    section, _, name = key.rpartition(".")
    owner = sections(Config)[section] if section else Config
    return owner.model_fields[name]
