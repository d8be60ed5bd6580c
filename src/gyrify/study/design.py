"""The design of a study: which combinations of parameters are run."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal, get_args

import numpy as np

from gyrify.config.faults import nearest
from gyrify.config.words import show
from gyrify.errors import ConfigError
from gyrify.study.design_checks import require_known, whole_number
from gyrify.study.parameter import Parameter, read_parameter, require_variable

Kind = Literal["grid", "zip", "list", "random", "latin_hypercube"]
KINDS: Final[tuple[Kind, ...]] = get_args(Kind)
MAX_POINTS: Final = 100_000
_KNOWN: Final = ("kind", "n", "seed", "parameter", "point")
_SAMPLED: Final = ("random", "latin_hypercube")


@dataclass(frozen=True)
class Design:
    """Combinations of parameters.

    Attributes
    ----------
    kind : {"grid", "zip", "list", "random", "latin_hypercube"}
        All combinations, values side by side, points written out, or points drawn.
    parameters : tuple of Parameter
        What is varied; empty for points written out.
    n : int or None
        Points drawn, or values in a range.
    seed : int
        Seed of what is drawn.
    rows : tuple of mapping
        Points written out, by dotted key.
    """

    kind: Kind
    parameters: tuple[Parameter, ...] = ()
    n: int | None = None
    seed: int = 0
    rows: tuple[Mapping[str, object], ...] = ()

    def combinations(self) -> list[dict[str, object]]:
        """Overrides of every point, in order; in a grid the last parameter changes fastest.

        Raises
        ------
        ConfigError
            If values do not fit together, or there are too many.
        """
        if self.rows:
            return [dict(row) for row in self.rows]
        keys = [parameter.key for parameter in self.parameters]
        points = list(itertools.islice(self._values(), MAX_POINTS + 1))
        if len(points) > MAX_POINTS:
            raise ConfigError(
                f"The design has more than {MAX_POINTS} points.", "Use fewer values, or draw n."
            )
        return [dict(zip(keys, values, strict=True)) for values in points]

    def _values(self) -> Iterator[tuple[object, ...]]:
        if self.kind in _SAMPLED:
            return (
                tuple(p.at(float(share)) for p, share in zip(self.parameters, row, strict=True))
                for row in self._shares()
            )
        columns = [parameter.spread(self.n) for parameter in self.parameters]
        return itertools.product(*columns) if self.kind == "grid" else iter(_side_by_side(columns))

    def _shares(self) -> Any:
        """(n, n_parameters) numbers in [0, 1)."""
        generator, shape = np.random.default_rng(self.seed), (self.n or 0, len(self.parameters))
        if self.kind == "random":
            return generator.random(shape)
        from scipy.stats.qmc import LatinHypercube

        return LatinHypercube(shape[1], rng=generator).random(shape[0])


def _side_by_side(columns: Sequence[tuple[object, ...]]) -> list[tuple[object, ...]]:
    lengths = [len(column) for column in columns]
    if len(set(lengths)) > 1:
        raise ConfigError(
            f'The parameters have {", ".join(map(str, lengths))} values: kind = "zip" takes one of each at a '
            "time, and needs as many of each.",
            'Give the same number of values for each, or use kind = "grid".',
        )
    return list(zip(*columns, strict=True))


def read_design(table: object) -> Design:
    """Check the ``[design]`` of a study.

    Parameters
    ----------
    table : object
        As TOML holds it.

    Returns
    -------
    Design

    Raises
    ------
    ConfigError
        If a field is wrong.
    """
    if not isinstance(table, Mapping):
        raise ConfigError(
            "A study needs a table [design].", 'Write [design] with kind = "grid" and [[design.parameter]].'
        )
    require_known(table, _KNOWN, "[design]")
    kind = _kind(table.get("kind"))
    n = whole_number(table["n"], "design.n", 1, MAX_POINTS) if "n" in table else None
    seed = whole_number(table.get("seed", 0), "design.seed", 0, 2**32 - 1)
    if kind in _SAMPLED and n is None:
        raise ConfigError(f'design.n is missing: how many points kind = "{kind}" draws.', "Try n = 20.")
    if "point" in table:
        return Design(kind, (), n, seed, _rows(table, kind))
    given = table.get("parameter", [])
    if not isinstance(given, list | tuple) or not given:
        raise ConfigError(
            "The design does not vary any parameter.", "Write a [[design.parameter]] with key and values."
        )
    parameters = tuple(read_parameter(item, f"design.parameter {i + 1}") for i, item in enumerate(given))
    _require_once([parameter.key for parameter in parameters])
    return Design(kind, parameters, n, seed)


def _kind(kind: object) -> Kind:
    for known in KINDS:
        if kind == known:
            return known
    if kind is None:
        raise ConfigError(f"design.kind is missing: one of {', '.join(KINDS)}.", 'Write kind = "grid".')
    close = nearest(kind, KINDS) if isinstance(kind, str) else ""
    raise ConfigError(
        f"design.kind = {show(kind)} is not allowed: {', '.join(KINDS)}.",
        f'Did you mean "{close}"?' if close else 'Try "grid".',
    )


def _require_once(keys: Sequence[str]) -> None:
    for key in keys:
        if keys.count(key) > 1:
            raise ConfigError(f"{key} is varied twice in the design.", "Name it once, with all its values.")


def _rows(table: Mapping[str, Any], kind: Kind) -> tuple[Mapping[str, object], ...]:
    """Points written out, their keys dotted."""
    given = table["point"]
    if kind != "list" or "parameter" in table:
        raise ConfigError(
            '[[design.point]] is used with kind = "list" alone, and without [[design.parameter]].',
            "Leave one of them out.",
        )
    if not isinstance(given, list | tuple) or not all(isinstance(row, Mapping) and row for row in given):
        raise ConfigError(
            "Each design.point must be a table with at least one key.", "Write [[design.point]]."
        )
    rows = tuple(dict(_flat(row)) for row in given)
    for number, row in enumerate(rows):
        for key in row:
            require_variable(key, f"design.point {number + 1}")
    return rows


def _flat(table: Mapping[str, object], prefix: str = "") -> Iterator[tuple[str, object]]:
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value
